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
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ..errors import UsageError
from . import parsing
from .options import open_graph, report_problems, resolve_inputs
from .outcome import print_json, print_note, write_count
from .progress import progress_reporter
from .watchdog import can_fork, needs_watchdog, run_forked

if TYPE_CHECKING:
    from ..graph import Graph, Port
    from ..inputs.prefetch import Prefetcher
    from ..renderer.jobs.job import JobReport
    from ..renderer.jobs.render_job import RenderJob


def execute(job: RenderJob, progress: Literal["bar", "json"], as_json: bool) -> int:
    """Run a render job, print its report, and return the exit code. Raises HalationError."""
    from msgspec.structs import replace

    started = time.perf_counter()
    graph = open_graph(Path(job.graph), job.sets, job.document, sandbox=job.sandbox)
    report_problems(Path(job.graph), graph)
    if job.codec and not job.videos:
        raise UsageError(f"--codec {job.codec}: a codec needs a video: write -o NAME.mp4, .mov, .mkv or .webm")
    if job.processes > 1 and job.videos:
        print_note(f"one process renders all frames, since all are in {job.videos[0]}")
        job = replace(job, processes=1)
    if job.processes == 1 and needs_watchdog(graph) and can_fork():
        return run_forked(
            lambda: _execute_opened(job, graph, progress, as_json, started), job.timeout, job.memory, as_json
        )
    return _execute_opened(job, graph, progress, as_json, started)


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
        job = replace(job, frames=_choose_frames(job, graph))
    if helper_jobs := _split_among_helpers(job, graph, targets, is_watched):
        from .helpers import run_helpers

        total = max(1, len(job.frames))
        with progress_reporter(progress, total) as reporter:
            report = run_helpers(helper_jobs, is_watched, job.timeout, reporter, total)
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

    return None if job.resume or targets or job.memory else Prefetcher(graph, job.inputs, sandbox=job.sandbox)


def _choose_frames(job: RenderJob, graph: Graph) -> tuple[int, ...]:
    """The frames of a job that names none: all of the graph if its files can hold them, else the first."""
    from ..graph.frames import list_range
    from ..inputs.lazy_provider import LazyResourceProvider

    provider = LazyResourceProvider(job.sandbox)
    first, last = provider.find_frames(graph, job.inputs)
    return list_range(first, last) if parsing.have_frame_number(job.files) else (first,)


def _split_among_helpers(
    job: RenderJob, graph: Graph, targets: Mapping[str, Port], is_watched: bool
) -> list[RenderJob]:
    """The jobs of the helper processes; none where this process renders. This process watches them, so they have no
    time limit of their own."""
    from msgspec.structs import replace

    if min(job.processes, len(job.frames)) > 1 and _is_independent(job, graph, targets):
        parts = [part for start in range(job.processes) if (part := job.frames[start :: job.processes])]
    elif is_watched:
        parts = [job.frames]
    else:
        return []
    return [replace(job, frames=part, processes=1, timeout=0.0) for part in parts]


def _is_independent(job: RenderJob, graph: Graph, targets: Mapping[str, Port]) -> bool:
    """True if each frame can be rendered without the frames before it. Raises HalationError."""
    from ..compiler import Request, compile_graph
    from ..inputs.lazy_provider import LazyResourceProvider

    if graph.settings.preroll is not None:
        return True
    provider = LazyResourceProvider(job.sandbox)
    plan = compile_graph(graph, Request(targets, provider.bind(graph, job.inputs), frame=job.frames[0]), provider)
    for node in plan.remembering:
        print_note(f"one process renders all frames: node '{node}' needs the frame before each")
        break
    return not plan.memories


def _render_here(
    job: RenderJob,
    graph: Graph,
    targets: Mapping[str, Port],
    prefetcher: Prefetcher | None,
    progress: Literal["bar", "json"],
    started: float,
) -> dict[str, Any]:
    """Render in this process; the report, ready for JSON."""
    from ..renderer import DEFAULT_BUDGET, Renderer, RenderRequest, open_device, open_pinned
    from ..renderer.jobs.job import OutputSettings, run_job

    loaded_at = time.perf_counter()
    device = (
        open_pinned(job.memory, sandbox=job.sandbox)
        if job.deterministic
        else open_device(job.form, job.memory, sandbox=job.sandbox)
    )
    # Without pre-roll a frame needs the one before it at most; with pre-roll it needs more, so results are kept.
    leads_up = len(job.frames) > 1 and graph.settings.preroll is not None
    renderer = Renderer(
        device, budget=DEFAULT_BUDGET if leads_up and not job.memory else 0, prefetcher=prefetcher, sandbox=job.sandbox
    )
    print_note(renderer.device.description)
    opened_at = time.perf_counter()
    precision = "float" if job.deterministic else job.precision
    request = RenderRequest(job.inputs, targets, job.size, job.scale, precision=precision)
    output_settings = OutputSettings(
        job.files,
        job.view,
        job.compression,
        job.precision or "half",
        job.display,
        job.look,
        job.colorspace,
        job.codec,
        job.dither,
    )
    with progress_reporter(progress, len(job.frames)) as reporter:
        report = run_job(renderer, graph, request, output_settings, job.frames, resume=job.resume, progress=reporter)
    seconds = {"load": loaded_at - started, "open": opened_at - loaded_at, **report.seconds}
    seconds["total"] = time.perf_counter() - started
    return _report_facts(report, renderer.device.description, seconds)


def _report_facts(report: JobReport, device: str, seconds: Mapping[str, float]) -> dict[str, Any]:
    return {
        "written": [str(path) for path in report.written],
        "frames": [item.frame for item in report.frames],
        "kept": [item.frame for item in report.frames if item.is_kept],
        "device": device,
        "passes": report.passes,
        "programs": report.programs,
        "peak_bytes": report.peak_bytes,
        "repaired": dict(report.repaired),
        "warnings": dict(report.warnings),
        "views": dict(report.views),
        "data": list(report.data_outputs),
        "seconds": {name: round(part, 4) for name, part in seconds.items()},
    }


def _print_report(report: Mapping[str, Any], total: float, as_json: bool) -> None:
    """Print which files were written in `total` seconds: as JSON to standard output, or as text to standard error."""
    for path, warning in report["warnings"].items():
        print_note(f"{path}: {warning}")
    for path, count in report["repaired"].items():
        print_note(f"{path}: {count} pixels that are not finite were filled from their neighbors")
    for output in report["data"]:
        print_note(f"output '{output}' is data: its numbers are written, and no view changes them")
    for output, view in report["views"].items():
        screen = " of video (BT.1886)" if view == "bt1886" else ""
        reason = f"its pictures are made for a screen{screen} already (--view)"
        print_note(f"output '{output}' is encoded without a view: {reason}")
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
