"""Texts about renders to files."""

from __future__ import annotations

from pathlib import Path

from ...authoring.render_queue.queue import QueuedRender
from ...language.translation import translate
from .form import RenderTargets


def title(export: QueuedRender) -> str:
    """The title of a render: its files."""
    first = export.destinations[0][1].name
    more = len(export.destinations) - 1
    return translate("{first} and {count} more", first=first, count=more) if more else first


def progress_text(export: QueuedRender) -> str:
    """The progress of a running render."""
    computed, total = export.passes
    if export.has_many_files:
        return _count_files(export) if export.done else translate("starting")
    if export.total > 1:
        if not (export.done or total):
            return translate("starting")
        return translate("{done} of {total} frames", done=export.done, total=export.total)
    if not total:
        return translate("writing") if export.done else translate("starting")
    if computed == total:
        return translate("writing")
    return translate("{done} of {total} passes", done=computed, total=total)


def under_way(export: QueuedRender) -> str:
    """What a render computes now, and the remaining time."""
    parts: list[str] = []
    if export.job.cluster:
        parts.append(_name_workers(export))
    elif export.total > 1 and export.job.order.processes > 1 and not export.node:
        parts.append(translate("{count} processes", count=export.job.order.processes))
    elif export.node:
        frame = translate("frame {frame}: {node}", frame=export.frame, node=export.node)
        parts.append(frame if export.total > 1 else export.node)
    left = export.seconds_left
    if left is not None:
        parts.append(translate("{time} left", time=time_text(left)))
    return "   ".join(parts) or translate("reading the graph")


def state_text(export: QueuedRender, position: int = 0) -> str:
    """How a render ended, or its position in the queue."""
    if export.state == "waiting":
        return translate("next") if position == 0 else translate("{turn} before this one", turn=position)
    many = export.total > 1
    if export.has_many_files:
        count = _count_files(export)
    elif export.done >= export.total:
        count = translate("{count} frames", count=export.total)
    else:
        count = translate("{done} of {total} frames", done=export.done, total=export.total)
    if export.state == "done":
        took = time_text(export.seconds)
        if not many:
            if export.reused:
                return translate("up to date, checked in {took}", took=took)
            return translate("done in {took}", took=took)
        number = translate("all") if export.reused == export.total else f"{export.reused}"
        return (
            translate("{count} in {took}, {number} already up to date", count=count, took=took, number=number)
            if export.reused
            else translate("{count} in {took}", count=count, took=took)
        )
    state = translate(export.state, "state of a render")
    return translate("{state} after {count}", state=state, count=count) if many and export.done else state


def _name_workers(export: QueuedRender) -> str:
    """Which workers of a cluster render; before the first frame is finished only where they are."""
    address = export.job.cluster
    if export.workers == 1:
        return translate("1 worker on {address}", address=address)
    return (
        translate("{count} workers on {address}", count=export.workers, address=address) if export.workers else address
    )


def _count_files(export: QueuedRender) -> str:
    """How many of many files are done."""
    if export.done >= export.total:
        return translate("{count} files", count=export.total)
    return translate("{done} of {total} files", done=export.done, total=export.total)


def time_text(seconds: float) -> str:
    """A length of time: `0.4 s`, `12 s`, `3:05`, `1:02:30`."""
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    minutes, rest = divmod(whole, 60)
    if not minutes:
        return f"{rest} s"
    return f"{minutes}:{rest:02d}" if minutes < 60 else f"{minutes // 60}:{minutes % 60:02d}:{rest:02d}"


def aim_text(aim: RenderTargets) -> str:
    """The files that a render would write, as text."""
    if aim.files == 1:
        return translate("Writes {first}", first=Path(aim.first).name)
    return translate(
        "Writes {files:,} files: {first} … {last}",
        files=aim.files,
        first=Path(aim.first).name,
        last=Path(aim.last).name,
    )


def exist_text(aim: RenderTargets, resume: bool) -> str:
    """What happens to files that exist already."""
    if aim.files == 1:
        return (
            translate("It exists. It is kept if it is up to date.")
            if resume
            else translate("It exists and will be replaced.")
        )
    if aim.exist == aim.files:
        return (
            translate("All of them exist. Those up to date are kept.")
            if resume
            else translate("All of them exist and will be replaced.")
        )
    return (
        translate("{count:,} of them exist. Those up to date are kept.", count=aim.exist)
        if resume
        else translate("{count:,} of them exist and will be replaced.", count=aim.exist)
    )
