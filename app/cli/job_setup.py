"""What a render job needs in the process that renders it: a renderer, a request and settings of its files."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..errors import HalationError
from . import parsing
from .outcome import print_note

if TYPE_CHECKING:
    from pathlib import Path

    from ..compiler import Memory, Plan
    from ..graph import Graph, Port
    from ..inputs.prefetch import Prefetcher
    from ..renderer import Device, Renderer, RenderRequest
    from ..renderer.jobs.job import JobReport, OutputSettings
    from ..renderer.jobs.render_job import RenderJob


def open_job_renderer(job: RenderJob, graph: Graph, prefetcher: Prefetcher | None = None) -> Renderer:
    """Open the device of a job and print its description. Raises DeviceError."""
    renderer = open_renderer(job, graph, prefetcher)
    print_note(renderer.device.description)
    return renderer


def open_renderer(job: RenderJob, graph: Graph, prefetcher: Prefetcher | None = None) -> Renderer:
    """Open the device of a job. Raises DeviceError."""
    from ..renderer import Renderer

    budget = choose_budget(job, graph) if len(job.frames) != 1 else 0
    return Renderer(open_job_device(job), budget=budget, prefetcher=prefetcher, sandbox=job.sandbox)


def open_job_device(job: RenderJob) -> Device:
    """The device that a job asks for. Raises DeviceError."""
    from ..renderer import open_device, open_pinned

    if job.deterministic:
        return open_pinned(job.memory, sandbox=job.sandbox)
    return open_device(job.form, job.memory, sandbox=job.sandbox)


def choose_budget(job: RenderJob, graph: Graph) -> int:
    """The bytes of results that stay on the device from frame to frame.

    With pre-roll a frame needs several before it. Without, it needs one at most, which its run hands on.
    """
    from ..renderer import DEFAULT_BUDGET

    return DEFAULT_BUDGET if graph.settings.preroll is not None and not job.memory else 0


def make_request(job: RenderJob, inputs: Mapping[str, str], targets: Mapping[str, Port]) -> RenderRequest:
    """What is rendered of the graph of a job."""
    from ..renderer import RenderRequest

    precision = "float" if job.deterministic else job.precision
    return RenderRequest(inputs, targets, job.size, job.scale, precision=precision)


def make_output_settings(job: RenderJob, files: tuple[tuple[str, Path], ...]) -> OutputSettings:
    """How the files of a job are written."""
    from ..renderer.jobs.job import OutputSettings

    return OutputSettings(
        files,
        job.view,
        job.compression,
        job.precision or "half",
        job.display,
        job.look,
        job.colorspace,
        job.codec,
        job.dither,
    )


def choose_frames(job: RenderJob, graph: Graph, inputs: Mapping[str, str]) -> tuple[int, ...]:
    """The frames of a job that names none: all of the graph if its files can hold them, else the first."""
    from ..graph.frames import list_range
    from ..inputs.lazy_provider import LazyResourceProvider

    provider = LazyResourceProvider(job.sandbox)
    first, last = provider.find_frames(graph, inputs)
    return list_range(first, last) if parsing.have_frame_number(job.files) else (first,)


def has_independent_frames(job: RenderJob, graph: Graph, targets: Mapping[str, Port]) -> bool:
    """True if each frame can be rendered without the frames before it. Raises HalationError."""
    if graph.settings.preroll is not None:
        return True
    plan = _plan_frame(job, graph, targets, job.frames[0], {})
    for node in plan.remembering:
        print_note(f"one process renders all frames: node '{node}' needs the frame before each")
        break
    return not plan.memories


def find_remembering_node(job: RenderJob, graph: Graph, targets: Mapping[str, Port]) -> tuple[str, bool]:
    """The first node that needs the frame before each, "" for none, and whether other parts of a frame do not.

    Raises HalationError.
    """
    plan = _plan_frame(job, graph, targets, job.frames[0], {})
    if not plan.memories or graph.settings.preroll is not None:
        return "", False
    frames = sorted(set(job.frames))
    chosen = dict.fromkeys((job.frames[0], frames[len(frames) // 2], frames[-1]))
    return plan.remembering[0], any(_has_stages(job, graph, targets, frame, plan.memories) for frame in chosen)


def _has_stages(
    job: RenderJob, graph: Graph, targets: Mapping[str, Port], frame: int, memories: Mapping[Port, Memory]
) -> bool:
    """True if parts of a frame do not need the frame before. An effect that begins at 0 has no passes at first."""
    from ..renderer.jobs.shared_results import has_stages

    try:
        return has_stages(_plan_frame(job, graph, targets, frame, memories))
    except HalationError:  # who renders the frame says so
        return False


def _plan_frame(
    job: RenderJob, graph: Graph, targets: Mapping[str, Port], frame: int, memories: Mapping[Port, Memory]
) -> Plan:
    """The plan of a frame of a job, where the frame before has stored some `memories`."""
    from ..compiler import Request, compile_graph
    from ..inputs.lazy_provider import LazyResourceProvider

    provider = LazyResourceProvider(job.sandbox)
    bindings = provider.bind(graph, job.inputs)
    return compile_graph(graph, Request(targets, bindings, frame=frame, memories=memories), provider)


def describe_costs(report: JobReport, device: str) -> dict[str, Any]:
    """What every report of a job has, ready for JSON."""
    return {
        "device": device,
        "passes": report.passes,
        "programs": report.programs,
        "peak_bytes": report.peak_bytes,
        "repaired": dict(report.repaired),
        "warnings": dict(report.warnings),
        "views": dict(report.views),
        "data": list(report.data_outputs),
    }


def print_report_notes(report: Mapping[str, Any]) -> None:
    """Print what a report says of pictures that were repaired, and of how they were encoded."""
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
