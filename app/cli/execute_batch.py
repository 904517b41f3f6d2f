"""Runs a render job that has many files (`render --each`): in this process, or shared among helper processes.

A file that fails ends nothing else: it is reported like the others and named again at the end, and the exit code is 1.
With `--json`, standard output has one line of JSON for each file as soon as it is finished, and one for all at the end.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol

from . import parsing
from .job_setup import (
    choose_frames,
    describe_costs,
    make_output_settings,
    make_request,
    open_job_renderer,
    print_report_notes,
)
from .options import override_value, report_problems, resolve_inputs
from .outcome import describe_fault, print_note
from .progress import progress_reporter
from .watchdog import needs_watchdog

if TYPE_CHECKING:
    from ..graph import Graph, Port
    from ..renderer.jobs.item_session import JobItem
    from ..renderer.jobs.render_entry import RenderEntry
    from ..renderer.jobs.render_job import RenderJob
    from ..renderer.jobs.reports import ItemReport

FAILED = 1
"""The exit code where a file has failed: that of rendering and writing, whatever the reason of each file."""

_MAX_WRITERS = 4
"""Threads that encode files. A PNG of 2 MP takes 1.5 s of one core and 0.2 s of rendering on four, measured with noisy
photos; more threads only take more memory."""


class EntryProgress(Protocol):
    """Shows files that are finished or have failed."""

    def report_entry(self, facts: Mapping[str, Any], done_count: int, total: int) -> None:
        """One more file is done, `done_count` of `total`."""
        ...


class BatchReporter:
    """Passes the report of every file on to a bar or to JSON lines, prints it with `--json`, and counts."""

    def __init__(self, progress: EntryProgress, total: int, as_json: bool) -> None:
        self._progress, self._total, self._as_json = progress, total, as_json
        self.faults: list[tuple[str, str]] = []
        """The files that failed, and why."""
        self.kept_count = self.done_count = 0

    def report_entry(self, facts: Mapping[str, Any]) -> None:
        """Count and show a file that is finished or has failed."""
        self.done_count += 1
        self.kept_count += bool(facts["kept"])
        if error := facts.get("error"):
            self.faults.append((facts["file"], error["message"]))
        self._progress.report_entry(facts, self.done_count, self._total)
        if self._as_json:
            print(json.dumps(facts, ensure_ascii=False), flush=True)


def execute_batch(job: RenderJob, graph: Graph, progress: Literal["bar", "json"], as_json: bool, started: float) -> int:
    """Run a job whose graph is open, print its report, and return the exit code. Raises HalationError."""
    is_watched = needs_watchdog(graph)
    with progress_reporter(progress, len(job.entries), "files") as reporter:
        batch_reporter = BatchReporter(reporter, len(job.entries), as_json)
        if parts := _split_entries(job, is_watched):
            from .helpers import run_helpers

            reports = run_helpers(
                parts, is_watched, job.timeout, reporter, len(job.entries), batch_reporter.report_entry
            )
        else:
            reports = [render_entries(job, graph, batch_reporter.report_entry)]
    print_batch_report(_join_batch_reports(reports), batch_reporter, time.perf_counter() - started, as_json)
    return FAILED if batch_reporter.faults else 0


def render_entries(job: RenderJob, graph: Graph, report_entry: Callable[[Mapping[str, Any]], None]) -> dict[str, Any]:
    """Render all files of a job in this process, report each, and return the report of all, ready for JSON."""
    from ..renderer.jobs.job import run_batch
    from ..renderer.opengl.warming import warm

    if not job.deterministic:
        warm()
    started, targets = time.perf_counter(), parsing.find_targets(graph, job.node)
    renderer = open_job_renderer(job, graph)
    opened_at = time.perf_counter()
    items = ((entry.file, partial(_open_entry, job, graph, entry, targets)) for entry in job.entries)
    writers = 1 if job.videos else min(_MAX_WRITERS, os.cpu_count() or 1)
    report = run_batch(
        renderer,
        items,
        lambda item_report: report_entry(_describe_entry(item_report)),
        resume=job.resume,
        writers=writers,
    )
    seconds = {"open": opened_at - started, **report.seconds}
    return {
        **describe_costs(report, renderer.device.description),
        "seconds": {name: round(part, 4) for name, part in seconds.items()},
    }


def check_first_entry(job: RenderJob, graph: Graph) -> None:
    """Print the warnings of the graph with the values of the first file. Raises HalationError, as for one file."""
    entry = job.entries[0]
    report_problems(Path(job.graph), _set_values(graph, entry))
    resolve_inputs(graph, entry.inputs)


def _open_entry(job: RenderJob, graph: Graph, entry: RenderEntry, targets: Mapping[str, Port]) -> JobItem:
    return make_entry_item(job, open_entry_graph(graph, entry), entry, targets)


def open_entry_graph(graph: Graph, entry: RenderEntry) -> Graph:
    """The graph of a job with the values of one file. Raises HalationError."""
    if entry.sets:
        graph = _set_values(graph, entry)
        _refuse_problems(graph)
    return graph


def make_entry_item(job: RenderJob, graph: Graph, entry: RenderEntry, targets: Mapping[str, Port]) -> JobItem:
    """What is rendered for one file with its own graph. Raises HalationError."""
    from msgspec.structs import replace

    from ..renderer.jobs.item_session import JobItem

    inputs = resolve_inputs(graph, entry.inputs)
    job = replace(job, destinations=entry.destinations)
    frames = job.frames or choose_frames(job, graph, inputs)
    request, settings = make_request(job, inputs, targets), make_output_settings(job, job.files)
    return JobItem(entry.file, graph, request, settings, frames, creates_folders=True)


def _set_values(graph: Graph, entry: RenderEntry) -> Graph:
    for name, text in entry.sets.items():
        graph = override_value(graph, name, text)
    return graph


def _refuse_problems(graph: Graph) -> None:
    """Raise GraphError for values that make the graph of one file invalid."""
    from ..errors import GraphError
    from ..graph import problems

    for problem in problems(graph):
        if problem.severity == "error":
            raise GraphError(problem.sentence)


def _describe_entry(report: ItemReport) -> dict[str, Any]:
    """The report of a file, ready for JSON."""
    facts = {
        "file": report.name,
        "written": [str(path) for path in report.written],
        "frames": [frame.frame for frame in report.frames],
        "kept": bool(report.frames) and all(frame.is_kept for frame in report.frames) and report.fault is None,
        "passes": sum(frame.passes for frame in report.frames),
    }
    return facts if report.fault is None else {**facts, "error": describe_fault(report.fault)}


def _split_entries(job: RenderJob, is_watched: bool) -> list[RenderJob]:
    """The jobs of the helper processes; none where this process renders.

    `-j auto` is one process: it decodes and encodes files on threads, so that it keeps the cores busy by itself.
    """
    from msgspec.structs import replace

    count = min(max(1, job.processes), len(job.entries))
    if count < 2 and not is_watched:
        return []
    return [replace(job, entries=job.entries[start::count], processes=1, timeout=0.0) for start in range(count)]


def _join_batch_reports(reports: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """One report from those of several processes. Each has textures of its own, so their bytes are added."""
    from .helpers import join_costs

    return {**join_costs(reports), "data": list(dict.fromkeys(name for report in reports for name in report["data"]))}


def print_batch_report(report: Mapping[str, Any], counts: BatchReporter, seconds: float, as_json: bool) -> None:
    """Print what was done in `seconds`, and every file that failed: as JSON, or as text to standard error."""
    print_report_notes(report)
    for file, sentence in counts.faults:
        print_note(sentence if file in sentence else f"{file}: {sentence}")
    if as_json:
        facts = {"files": counts.done_count, "failed": len(counts.faults), "kept": counts.kept_count, **report}
        facts["seconds"] = {**report["seconds"], "total": round(seconds, 4)}
        print(json.dumps(facts, ensure_ascii=False))
        return
    print_note(", ".join(_list_counts(counts, seconds)))


def _list_counts(counts: BatchReporter, seconds: float) -> Iterator[str]:
    total = counts.done_count
    yield f"{total - len(counts.faults)} of {total} files in {seconds:.2f} s"
    if counts.kept_count:
        yield f"{counts.kept_count} kept as they were"
    if counts.faults:
        yield f"{len(counts.faults)} failed, named above"
