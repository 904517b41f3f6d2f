"""Runs a render job: in this process or in helper processes.

`render` builds the job from its options, and `worker` reads it as JSON from another process; both end here. A job goes
to helper processes in two cases: `-j` shares its frames among several, or the graph has code with loops. Such code may
run for ever, and a device that is stuck blocks its process, so only another process can end it (see watchdog.py).
Otherwise this process renders, and loads the driver and the first pictures on other threads meanwhile: on a short
render the start takes most of the time.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ..errors import UsageError
from . import parsing
from .execute_batch import check_first_entry, execute_batch
from .job_setup import (
    choose_frames,
    describe_costs,
    has_independent_frames,
    make_output_settings,
    make_request,
    open_job_renderer,
    print_report_notes,
)
from .options import open_graph, report_problems, resolve_inputs
from .outcome import print_json, print_note, write_count
from .progress import progress_reporter
from .watchdog import needs_watchdog, run_watched

if TYPE_CHECKING:
    from ..graph import Graph, Port
    from ..inputs.prefetch import Prefetcher
    from ..renderer.jobs.render_job import RenderJob
    from ..renderer.jobs.reports import JobReport


def execute(job: RenderJob, progress: Literal["bar", "json"], as_json: bool) -> int:
    """Run a render job, print its report, and return the exit code. Raises HalationError."""
    from msgspec.structs import replace

    started = time.perf_counter()
    graph = open_job_graph(job)
    if job.entries:
        check_first_entry(job, graph)
    else:
        report_problems(Path(job.graph), graph)
    if job.codec and not job.videos:
        raise UsageError(f"--codec {job.codec}: a codec needs a video: write -o NAME.mp4, .mov, .mkv or .webm")
    if job.processes > 1 and job.videos and not job.entries:
        print_note(f"one process renders all frames, since all are in {job.videos[0]}")
        job = replace(job, processes=1)
    execute_opened = execute_batch if job.entries else _execute_opened
    return run_watched(
        lambda: execute_opened(job, graph, progress, as_json, started),
        (graph,) if job.processes < 2 else (),  # what shares the frames is watched one by one
        job.timeout,
        as_json,
        memory=job.memory,
    )


def open_job_graph(job: RenderJob) -> Graph:
    """The graph of a job with the values of `--set`, and with what is written over it. Raises HalationError."""
    graph = open_graph(Path(job.graph), job.sets, job.document, sandbox=job.sandbox)
    if not job.burn_in:
        return graph
    from .burn_in import add_burn_in

    return add_burn_in(graph)


def _execute_opened(
    job: RenderJob, graph: Graph, progress: Literal["bar", "json"], as_json: bool, started: float
) -> int:
    """Run a render job whose graph is open."""
    from msgspec.structs import replace

    is_watched = needs_watchdog(graph)
    job = replace(job, inputs=resolve_inputs(graph, job.inputs))
    _note_data_bindings(graph, job.inputs)
    targets = parsing.find_targets(graph, job.node)
    prefetcher = None if is_watched or job.processes > 1 else _begin_loading(job, graph, targets)
    if not job.frames and (not is_watched or parsing.have_frame_number(job.files)):
        job = replace(job, frames=choose_frames(job, graph, job.inputs))
    if helper_jobs := _split_among_helpers(job, graph, targets, is_watched):
        from .helpers import join_reports, run_helpers

        total = max(1, len(job.frames))
        with progress_reporter(progress, total) as reporter:
            report = join_reports(run_helpers(helper_jobs, is_watched, job.timeout, reporter, total))
    else:
        report = _render_here(job, graph, targets, prefetcher, progress, started)
    _print_report(report, time.perf_counter() - started, as_json)
    return 0


def _note_data_bindings(graph: Graph, inputs: Mapping[str, str]) -> None:
    """Print a note about each layer of data that is bound to an input for color."""
    if any(":" in file for file in inputs.values()):
        from ..lint.rules.data import find_data_bindings

        for sentence in find_data_bindings(graph, inputs):
            print_note(sentence)


def _begin_loading(job: RenderJob, graph: Graph, targets: Mapping[str, Port]) -> Prefetcher | None:
    """Load the driver on another thread, and read pictures on a third, while this one imports the renderer."""
    from ..renderer.opengl.warming import warm

    if not job.deterministic:  # a pinned driver is loaded with other settings
        warm()
    from ..inputs.prefetch import Prefetcher

    reads_proxies = job.scale < 1.0  # of large files, which are then never read whole
    if job.resume or targets or job.memory or reads_proxies:
        return None
    return Prefetcher(graph, job.inputs, sandbox=job.sandbox)


def _split_among_helpers(
    job: RenderJob, graph: Graph, targets: Mapping[str, Port], is_watched: bool
) -> list[RenderJob]:
    """The jobs of the helper processes; none where this process renders. This process watches them, so they have no
    time limit of their own."""
    from msgspec.structs import replace

    if min(job.processes, len(job.frames)) > 1 and has_independent_frames(job, graph, targets):
        parts = [part for start in range(job.processes) if (part := job.frames[start :: job.processes])]
    elif is_watched:
        parts = [job.frames]
    else:
        return []
    return [replace(job, frames=part, processes=1, timeout=0.0) for part in parts]


def _render_here(
    job: RenderJob,
    graph: Graph,
    targets: Mapping[str, Port],
    prefetcher: Prefetcher | None,
    progress: Literal["bar", "json"],
    started: float,
) -> dict[str, Any]:
    """Render in this process; the report, ready for JSON."""
    from ..renderer.jobs.job import run_job

    loaded_at = time.perf_counter()
    renderer = open_job_renderer(job, graph, prefetcher)
    opened_at = time.perf_counter()
    request, output_settings = make_request(job, job.inputs, targets), make_output_settings(job, job.files)

    def describe(report: JobReport) -> dict[str, Any]:
        seconds = {"load": loaded_at - started, "open": opened_at - loaded_at, **report.seconds}
        seconds["total"] = time.perf_counter() - started
        return _report_facts(report, renderer.device.description, seconds)

    run = partial(run_job, renderer, graph, request, output_settings, job.frames, resume=job.resume)
    with progress_reporter(progress, len(job.frames)) as reporter:
        if job.processes:
            return describe(run(progress=reporter))
        from .sharing import FrameSharing

        sharing = FrameSharing(job, graph, targets, reporter)
        sharing.watch(renderer)
        try:
            return sharing.join(describe(run(progress=sharing, todo=sharing.todo)))
        finally:
            sharing.stop()


def _report_facts(report: JobReport, device: str, seconds: Mapping[str, float]) -> dict[str, Any]:
    return {
        "written": [str(path) for path in report.written],
        "frames": [item.frame for item in report.frames],
        "kept": [item.frame for item in report.frames if item.is_kept],
        **describe_costs(report, device),
        "seconds": {name: round(part, 4) for name, part in seconds.items()},
    }


def _print_report(report: Mapping[str, Any], total: float, as_json: bool) -> None:
    """Print which files were written in `total` seconds: as JSON to standard output, or as text to standard error."""
    print_report_notes(report)
    if as_json:
        print_json(report)
        return
    from ..compiler.explain import format_bytes

    peak, passes, unchanged_count = format_bytes(report["peak_bytes"]), report["passes"], len(report["kept"])
    cost = f"{total:.2f} s, {write_count(passes, 'pass', 'passes')}, {peak} of textures at the peak"
    written: Sequence[str] = report["written"]
    if len(report["frames"]) > 1:
        files = list(dict.fromkeys((written[0], written[-1])))
        unchanged = f", {unchanged_count} kept as they were" if unchanged_count else ""
        print_note(f"{' ... '.join(files)}  {len(report['frames'])} frames{unchanged}, {cost}")
        return
    for path in written:
        print_note(f"{path}  kept as it was" if unchanged_count else f"{path}  {cost}")
