"""Texts about renders to files."""

from __future__ import annotations

from pathlib import Path

from ...authoring.render_queue.queue import QueuedRender
from .form import RenderTargets


def title(export: QueuedRender) -> str:
    """The title of a render: its files."""
    first = export.destinations[0][1].name
    more = len(export.destinations) - 1
    return f"{first} and {more} more" if more else first


def progress_text(export: QueuedRender) -> str:
    """The progress of a running render."""
    computed, total = export.passes
    if export.total > 1:
        return f"{export.done} of {export.total} frames" if export.done or total else "starting"
    if not total:
        return "writing" if export.done else "starting"
    return f"{computed} of {total} passes" if computed < total else "writing"


def under_way(export: QueuedRender) -> str:
    """What a render computes now, and the remaining time."""
    parts: list[str] = []
    if export.total > 1 and export.job.order.processes > 1 and not export.node:
        parts.append(f"{export.job.order.processes} processes")
    elif export.node:
        parts.append(f"frame {export.frame}: {export.node}" if export.total > 1 else export.node)
    left = export.seconds_left
    if left is not None:
        parts.append(f"{time_text(left)} left")
    return "   ".join(parts) or "reading the graph"


def state_text(export: QueuedRender, turn: int = 0) -> str:
    """How a render ended, or its position in the queue."""
    if export.state == "waiting":
        return "next" if turn == 0 else f"{turn} before this one"
    many = export.total > 1
    count = f"{export.done} of {export.total} frames" if export.done < export.total else f"{export.total} frames"
    if export.state == "done":
        took = time_text(export.seconds)
        if not many:
            return f"{'up to date, checked' if export.reused else 'done'} in {took}"
        number = "all" if export.reused == export.total else f"{export.reused}"
        return f"{count} in {took}, {number} already up to date" if export.reused else f"{count} in {took}"
    return f"{export.state} after {count}" if many and export.done else export.state


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
        return f"Writes {Path(aim.first).name}"
    return f"Writes {aim.files:,} files: {Path(aim.first).name} \u2026 {Path(aim.last).name}"


def exist_text(aim: RenderTargets, resume: bool) -> str:
    """What happens to files that exist already."""
    if aim.files == 1:
        return "It exists. It is kept if it is up to date." if resume else "It exists and will be replaced."
    which = "All of them" if aim.exist == aim.files else f"{aim.exist:,} of them"
    return f"{which} exist. Those up to date are kept." if resume else f"{which} exist and will be replaced."
