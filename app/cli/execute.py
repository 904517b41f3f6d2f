"""Running a render job: in this process, or in helpers where frames are shared or code must be watched."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ..errors import UsageError
from . import parsing
from .options import open_graph, report_problems, resolve_inputs
from .outcome import note, print_json
from .progress import progress_reporter
from .watchdog import needs_watchdog

if TYPE_CHECKING:
    from ..graph import Graph, Port
    from ..inputs.prefetch import Prefetcher
    from ..renderer.jobs.job import JobReport
    from ..renderer.jobs.render_job import RenderJob


def execute(job: RenderJob, progress: Literal["bar", "json"], as_json: bool) -> int:
    """Render what a job says and report it; the exit code. Raises the errors of `app.errors`."""
    from msgspec.structs import replace

    started = time.perf_counter()
    graph = open_graph(Path(job.graph), job.sets, job.document)
    report_problems(Path(job.graph), graph)
    if job.codec and not job.videos:
        raise UsageError(f"--codec {job.codec}: that is for videos: write -o NAME.mp4, .mov, .mkv or .webm")
    if job.processes > 1 and job.videos:
        note(f"one process renders all frames, since all are in {job.videos[0]}")
        job = replace(job, processes=1)
    watch = needs_watchdog(graph, job.timeout)
    job = replace(job, inputs=resolve_inputs(graph, job.inputs))
    targets = parsing.targets(graph, job.node)
    ahead = None if watch or job.processes > 1 else _begin_loading(job, graph, targets)
    if not job.frames and (not watch or parsing.holds_frames(job.files)):
        job = replace(job, frames=_default_frames(job, graph))
    if helper_jobs := _split(job, graph, targets, watch):
        from .helpers import run_helpers

        total = max(1, len(job.frames))
        with progress_reporter(progress, total) as reporter:
            report = run_helpers(helper_jobs, job.timeout if watch else 0.0, reporter, total)
    else:
        report = _render(job, graph, targets, ahead, progress, started)
    _print_report(report, time.perf_counter() - started, as_json)
    return 0


def _begin_loading(job: RenderJob, graph: Graph, targets: Mapping[str, Port]) -> Prefetcher | None:
    """Load the driver on another thread, and read pictures on a third, while this one imports the renderer."""
    from ..renderer.opengl.warming import warm

    if not job.deterministic:  # a pinned driver is loaded with other settings
        warm()
    from ..inputs.prefetch import Prefetcher

    return None if job.resume or targets or job.memory else Prefetcher(graph, job.inputs)


def _default_frames(job: RenderJob, graph: Graph) -> tuple[int, ...]:
    """The frames of a job that names none."""
    from ..inputs.lazy_provider import LazyResourceProvider

    provider = LazyResourceProvider()
    first, last = provider.find_frames(graph, job.inputs)
    return tuple(range(first, last + 1)) if parsing.holds_frames(job.files) else (first,)


def _split(job: RenderJob, graph: Graph, targets: Mapping[str, Port], watch: bool) -> list[RenderJob]:
    """The jobs of helpers; none where this process renders. What watches over their code is here, not in them."""
    from msgspec.structs import replace

    if min(job.processes, len(job.frames)) > 1 and _is_independent(job, graph, targets):
        parts = [part for start in range(job.processes) if (part := job.frames[start :: job.processes])]
    elif watch:
        parts = [job.frames]
    else:
        return []
    return [replace(job, frames=part, processes=1, timeout=0.0) for part in parts]


def _is_independent(job: RenderJob, graph: Graph, targets: Mapping[str, Port]) -> bool:
    """True if every frame can be made without the ones before it. Raises the errors of `app.errors`."""
    from ..compiler import Request, compile_graph
    from ..inputs.lazy_provider import LazyResourceProvider

    if graph.settings.preroll is not None:
        return True
    provider = LazyResourceProvider()
    plan = compile_graph(graph, Request(targets, provider.bind(graph, job.inputs), frame=job.frames[0]), provider)
    for node in plan.remembering:
        note(f"one process renders all frames: node '{node}' makes each of the one before")
        break
    return not plan.memories


def _render(
    job: RenderJob,
    graph: Graph,
    targets: Mapping[str, Port],
    ahead: Prefetcher | None,
    progress: Literal["bar", "json"],
    started: float,
) -> dict[str, Any]:
    """Render in this process: the report as JSON has it."""
    from ..renderer import DEFAULT_BUDGET, Renderer, RenderRequest, open_device, open_pinned
    from ..renderer.jobs.job import OutputSettings, run_job

    loaded = time.perf_counter()
    device = open_pinned(job.memory) if job.deterministic else open_device(job.form, job.memory)
    # A job keeps what the next frame wants; where each frame is led up to, it wants more than that of the one before.
    led = len(job.frames) > 1 and graph.settings.preroll is not None
    renderer = Renderer(device, budget=DEFAULT_BUDGET if led and not job.memory else 0, ahead=ahead)
    note(renderer.device.description)
    ready = time.perf_counter()
    precision = "float" if job.deterministic else job.precision
    request = RenderRequest(job.inputs, targets, job.size, job.scale, precision=precision)
    writing = OutputSettings(
        job.files,
        job.view,
        job.compression,
        job.precision or "half",
        job.display,
        job.look,
        job.colorspace,
        job.codec,
    )
    with progress_reporter(progress, len(job.frames)) as reporter:
        report = run_job(renderer, graph, request, writing, job.frames, resume=job.resume, progress=reporter)
    seconds = {"load": loaded - started, "open": ready - loaded, **report.seconds}
    seconds["total"] = time.perf_counter() - started
    return _as_json(report, renderer.device.description, seconds)


def _as_json(report: JobReport, device: str, seconds: Mapping[str, float]) -> dict[str, Any]:
    return {
        "written": [str(path) for path in report.written],
        "frames": [item.frame for item in report.frames],
        "kept": [item.frame for item in report.frames if item.kept],
        "device": device,
        "passes": report.passes,
        "programs": report.programs,
        "peak_bytes": report.peak_bytes,
        "repaired": dict(report.repaired),
        "seconds": {name: round(part, 4) for name, part in seconds.items()},
    }


def _print_report(report: Mapping[str, Any], total: float, as_json: bool) -> None:
    """What was written, in `total` seconds: JSON on standard output, or a line for the user on standard error."""
    for path, count in report["repaired"].items():
        note(f"{path}: {count} pixels that are not numbers were filled from their neighbors")
    if as_json:
        print_json(report)
        return
    from ..compiler.explain import format_bytes

    peak, passes, kept = format_bytes(report["peak_bytes"]), report["passes"], len(report["kept"])
    spent = f"{total:.2f} s, {passes} passes, {peak} of textures at the peak"
    written: Sequence[str] = report["written"]
    if len(report["frames"]) > 1:
        files = list(dict.fromkeys((written[0], written[-1])))
        unchanged = f", {kept} kept as they were" if kept else ""
        note(f"{' ... '.join(files)}  {len(report['frames'])} frames{unchanged}, {spent}")
        return
    for path in written:
        note(f"{path}  kept as it was" if kept else f"{path}  {spent}")
