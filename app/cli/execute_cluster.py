"""Runs a render job on the workers of a cluster (`render --cluster`)."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal
from uuid import uuid4

from msgspec import Struct
from msgspec.structs import replace

from ..errors import RenderError, UsageError
from . import parsing
from .cluster_progress import ClusterProgress
from .execute import open_job_graph
from .helpers import join_costs
from .job_setup import choose_frames, find_remembering_node, make_output_settings, make_request, print_report_notes
from .options import report_problems, resolve_inputs
from .outcome import print_json, print_note, write_count

if TYPE_CHECKING:
    from ..cluster.campaign import CampaignReport
    from ..cluster.chunk import FileMark, FrameChunk
    from ..cluster.connection import Client
    from ..cluster.file_marks import FileMarker
    from ..graph import Graph
    from ..renderer.jobs.render_job import RenderJob

_MAX_NAMED = 10
"""Frames that are named one by one where many cannot be rendered: more scroll away what matters."""


class ClusterOptions(Struct, frozen=True):
    """Where the frames of a job are rendered: an address, `--map`, and the priority of Dask."""

    address: str
    path_map: tuple[tuple[str, str], ...] = ()
    priority: int = 0
    detaches: bool = False
    """True if the command ends as soon as the job is sent."""


def execute_on_cluster(job: RenderJob, options: ClusterOptions, progress: Literal["bar", "json"], as_json: bool) -> int:
    """Render the frames of a job on a cluster, print its report, and return the exit code. Raises HalationError."""
    from ..cluster.connection import find_dashboard, open_client

    started = time.perf_counter()
    _refuse_options(job, options)
    graph = open_job_graph(job)
    report_problems(Path(job.graph), graph)
    with open_client(options.address, job) as client:
        chunk, marker, history = prepare_chunk(job, graph, options)

        def mark_files(frames: tuple[int, ...]) -> dict[str, FileMark]:
            return marker.mark_files(frames, _find_history(graph, frames, history))

        if options.detaches:
            return _send(client, chunk, mark_files, options, job.graph, as_json)
        reporter = ClusterProgress(len(chunk.job.frames), progress, find_dashboard(client))
        with reporter:
            report = _render_frames(client, chunk, mark_files, options, reporter)
    return _print_cluster_report(report, chunk, job, time.perf_counter() - started, as_json)


def prepare_chunk(job: RenderJob, graph: Graph, options: ClusterOptions) -> tuple[FrameChunk, FileMarker, int | None]:
    """What all chunks of a job share, what describes their files, and the frame where their history begins, if any.

    Raises HalationError for what can be known before anything is rendered.
    """
    from ..cluster.chunk import ChunkStage, FrameChunk
    from ..cluster.file_marks import FileMarker
    from ..cluster.versions import describe_versions
    from ..inputs.lazy_provider import LazyResourceProvider
    from ..renderer.jobs.destinations import plan_destinations
    from ..renderer.jobs.header import dump_whole_graph
    from ..renderer.jobs.shared_results import FOLDER_PREFIX

    inputs = {name: _make_absolute(file) for name, file in resolve_inputs(graph, job.inputs).items()}
    targets = parsing.find_targets(graph, job.node)
    job = replace(job, inputs=inputs, frames=job.frames or choose_frames(job, graph, inputs))
    request, settings = make_request(job, inputs, targets), make_output_settings(job, job.files)
    plan_destinations(graph, request, settings, job.frames, job.sandbox)
    node, has_stages = find_remembering_node(job, graph, targets)
    first = LazyResourceProvider(job.sandbox).find_frames(graph, inputs)[0]
    stage = None
    if job.videos:
        print_note(f"one worker renders all frames, since all are in {job.videos[0]}")
    elif has_stages and len(set(job.frames)) > 1 and max(job.frames) > first:
        print_note(f"node '{node}' needs the frame before each: one worker at a time renders what it stores")
        folder = Path(os.path.abspath(job.files[0][1])).parent / f"{FOLDER_PREFIX}{uuid4().hex[:12]}"  # noqa: PTH100
        stage = ChunkStage(folder=str(folder), frame_before=first)
    elif node:
        print_note(f"one worker renders all frames: node '{node}' needs the frame before each")
    is_chain = bool(job.videos or node) and stage is None
    history = first if is_chain or graph.settings.preroll is not None else None
    marker = FileMarker(graph, inputs, job.sandbox)
    sent_job = replace(
        job,
        graph="-",
        document=dump_whole_graph(graph),
        sets={},
        destinations=tuple((name, os.path.abspath(file)) for name, file in job.destinations),  # noqa: PTH100
        processes=1,
    )
    chunk = FrameChunk(
        sent_job,
        os.path.abspath(graph.folder),  # noqa: PTH100 - links stay
        options.path_map,
        contents=marker.read_contents(),
        versions=describe_versions(graph),
        is_chain=is_chain,
        stage=stage,
    )
    return chunk, marker, history


def _render_frames(
    client: Client,
    chunk: FrameChunk,
    mark_files: Callable[[tuple[int, ...]], Mapping[str, FileMark]],
    options: ClusterOptions,
    reporter: ClusterProgress,
) -> CampaignReport:
    """Have all frames rendered. A scheduler that goes and returns gets those that are missing."""
    from ..cluster.campaign import CampaignReport, FrameCampaign
    from ..cluster.connection import reopen_client

    report, address, frames = CampaignReport(), options.address, chunk.job.frames
    with ExitStack() as stack:
        while True:
            missing = tuple(frame for frame in frames if frame not in report.seconds and frame not in report.faults)
            rest = replace(chunk, job=replace(chunk.job, frames=missing))
            campaign = FrameCampaign(client, address, rest, mark_files, reporter, options.priority, report=report)
            try:
                return campaign.run()
            except RenderError as fault:
                if not campaign.has_lost_scheduler:
                    raise
                reporter.report_note(f"{address}: the scheduler has gone: frames are sent again when it is back")
                client = stack.enter_context(reopen_client(address, fault))


def _send(
    client: Client,
    chunk: FrameChunk,
    mark_files: Callable[[tuple[int, ...]], Mapping[str, FileMark]],
    options: ClusterOptions,
    graph: str,
    as_json: bool,
) -> int:
    """Leave the frames to the cluster, and print the name of the job."""
    from ..cluster.detached import DetachedCampaign, send_campaign

    frames = chunk.job.frames
    read_frames = {*frames, *(range(chunk.stage.frame_before, max(frames)) if chunk.stage else ())}
    marks_by_frame = {frames[0]: mark_files(frames)} if chunk.is_chain else {n: mark_files((n,)) for n in read_frames}
    chunk = replace(
        chunk,
        job=replace(chunk.job, resume=not chunk.job.videos),
        marks={path: mark for marks in marks_by_frame.values() for path, mark in marks.items()},
    )
    files = {frame: tuple(marks) for frame, marks in marks_by_frame.items()}
    name = send_campaign(client, DetachedCampaign("", chunk, files, options.priority), graph)
    if as_json:
        print_json({"job": name, "frames": len(frames)})
    else:
        print(name)
        print_note(f"halation jobs --cluster {options.address} --follow {name} shows how far it is")
    return 0


def _refuse_options(job: RenderJob, options: ClusterOptions) -> None:
    """Raise UsageError for options that a cluster does not serve."""
    if options.detaches and options.address.startswith("local"):
        raise UsageError(f"--detach: the workers of {options.address} end with the command: name a scheduler")
    if job.entries:
        raise UsageError("--cluster shares the frames of one graph: leave it out with --each, or share files by -j")
    if job.processes > 1:
        raise UsageError("--cluster and -j: give one of them; --cluster local:4 has four workers on this machine")
    if job.codec and not job.videos:
        raise UsageError(f"--codec {job.codec}: a codec needs a video: write -o NAME.mp4, .mov, .mkv or .webm")


def _make_absolute(file: str) -> str:
    """The absolute path of a file, with its layer if it names one."""
    return os.path.abspath(file)  # noqa: PTH100 - links stay


def _find_history(graph: Graph, frames: Sequence[int], first: int | None) -> range:
    """The frames before a chunk whose files are read too."""
    if first is None or frames[0] <= first:
        return range(0)
    preroll = graph.settings.preroll
    return range(first if preroll is None else max(first, frames[0] - preroll), frames[0])


def _print_cluster_report(
    report: CampaignReport, chunk: FrameChunk, job: RenderJob, seconds: float, as_json: bool
) -> int:
    """Print what was done in `seconds`, and each frame that cannot be rendered; the exit code."""
    frames = sorted(report.seconds)
    costs: dict[str, Any] = join_costs(report.costs) if report.costs else {}
    if costs:
        print_report_notes(costs)
    _print_faults(report.faults)
    slowest = sorted(report.seconds.items(), key=lambda pair: -pair[1])[:3]
    if as_json:
        facts = {
            "written": _list_written(job, frames),
            "frames": frames,
            "kept": sorted(report.kept),
            "failed": {str(frame): fault["message"] for frame, fault in sorted(report.faults.items())},
            **costs,
            "workers": len(report.workers),
            "chunks": report.chunks,
            "stages": dict(report.stages),
            "slowest": dict(slowest),
            "seconds": {**costs.get("seconds", {}), "total": round(seconds, 4)},
        }
        print_json(facts)
    else:
        kept = f", {len(report.kept)} kept as they were" if report.kept else ""
        workers = write_count(len(report.workers), "worker")
        total = len(chunk.job.frames)
        print_note(f"{len(frames)} of {write_count(total, 'frame')}{kept}, {seconds:.2f} s, {workers}")
        if len(frames) > 1:
            print_note("slowest: " + ", ".join(f"frame {frame} {cost:.2f} s" for frame, cost in slowest))
    return 1 if report.faults else 0


def _print_faults(faults: Mapping[int, Mapping[str, Any]]) -> None:
    for frame in sorted(faults)[:_MAX_NAMED]:
        print_note(f"frame {frame}: {faults[frame]['message']}")
    if len(faults) > _MAX_NAMED:
        from ..graph.frames import format_frames

        print_note(f"{len(faults)} frames cannot be rendered: {format_frames(tuple(sorted(faults)))}")


def _list_written(job: RenderJob, frames: Sequence[int]) -> list[str]:
    """The files of frames, as the user names them."""
    from ..graph.frames import Pattern

    names: list[str] = []
    for frame in frames:
        for _, path in job.destinations:
            pattern = Pattern.parse(path)
            names.append(path if pattern is None else pattern.name(frame))
    return list(dict.fromkeys(names))
