"""Runs a render job on the workers of a cluster (`render --cluster`)."""

from __future__ import annotations

import time
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from msgspec import Struct
from msgspec.structs import replace

from ..errors import RenderError, UsageError
from .cluster_job import MarkFiles, PathPairs, prepare_chunk, prepare_entries
from .cluster_progress import ClusterProgress, EntryListener, list_written
from .execute import open_job_graph
from .execute_batch import check_first_entry
from .helpers import join_chunk_costs
from .job_setup import print_report_notes
from .options import report_problems
from .outcome import print_json, print_note, write_count

if TYPE_CHECKING:
    from ..cluster.campaign_report import CampaignListener, CampaignReport
    from ..cluster.chunk import FrameChunk
    from ..cluster.connection import Client
    from ..renderer.jobs.render_job import RenderJob

_MAX_NAMED = 10
"""Frames that are named one by one where many cannot be rendered: more scroll away what matters."""


class ClusterOptions(Struct, frozen=True):
    """Where the frames of a job are rendered: an address, `--map`, and the priority of Dask."""

    address: str
    path_map: PathPairs = ()
    priority: int = 0
    detaches: bool = False
    """True if the command ends as soon as the job is sent."""


def execute_on_cluster(job: RenderJob, options: ClusterOptions, progress: Literal["bar", "json"], as_json: bool) -> int:
    """Render the frames of a job on a cluster, print its report, and return the exit code. Raises HalationError."""
    from ..cluster.connection import find_dashboard, open_client

    started = time.perf_counter()
    _refuse_options(job, options)
    graph = open_job_graph(job)
    if job.entries:
        check_first_entry(job, graph)
    else:
        report_problems(Path(job.graph), graph)
    with open_client(options.address, job) as client:
        chunk, mark_files = (prepare_entries if job.entries else prepare_chunk)(job, graph, options.path_map)
        if options.detaches:
            return _send(client, chunk, mark_files, options, job.graph, as_json)
        with ClusterProgress(job, len(chunk.parts), progress, find_dashboard(client)) as reporter:
            listener = EntryListener(job, reporter, as_json) if job.entries else reporter
            report = _render_parts(client, chunk, mark_files, options, listener)
    seconds = time.perf_counter() - started
    if isinstance(listener, EntryListener):
        return listener.print_report(report, seconds)
    return _print_cluster_report(report, chunk, job, seconds, as_json)


def _render_parts(
    client: Client, chunk: FrameChunk, mark_files: MarkFiles, options: ClusterOptions, listener: CampaignListener
) -> CampaignReport:
    """Have all frames or files rendered. A scheduler that goes and returns gets those that are missing."""
    from ..cluster.campaign import FrameCampaign
    from ..cluster.campaign_report import CampaignReport
    from ..cluster.connection import reopen_client

    report, address = CampaignReport(), options.address
    with ExitStack() as stack:
        while True:
            rest = chunk.take_parts(report.list_missing(chunk.parts))
            campaign = FrameCampaign(client, address, rest, mark_files, listener, options.priority, report=report)
            try:
                return campaign.run()
            except RenderError as fault:
                if not campaign.has_lost_scheduler:
                    raise
                if chunk.is_chain and chunk.job.videos:  # all frames are in one file, or none
                    report.seconds.clear()
                listener.report_note(f"{address}: the scheduler has gone: frames are sent again when it is back")
                client = stack.enter_context(reopen_client(address, fault))


def _send(
    client: Client, chunk: FrameChunk, mark_files: MarkFiles, options: ClusterOptions, graph: str, as_json: bool
) -> int:
    """Leave the job to the cluster, and print its name."""
    from ..cluster.detached import DetachedCampaign, send_campaign

    parts = chunk.parts
    read_parts = {*parts, *(range(chunk.stage.frame_before, max(parts)) if chunk.stage else ())}
    marks_by_part = {parts[0]: mark_files(parts)} if chunk.is_chain else {n: mark_files((n,)) for n in read_parts}
    chunk = replace(
        chunk,
        job=replace(chunk.job, resume=not chunk.job.videos),
        marks={path: mark for marks in marks_by_part.values() for path, mark in marks.items()},
    )
    files = {part: tuple(marks) for part, marks in marks_by_part.items()}
    name = send_campaign(client, DetachedCampaign("", chunk, files, options.priority), graph)
    if as_json:
        print_json({"job": name, "files" if chunk.numbers else "frames": len(parts)})
    else:
        print(name)
        print_note(f"halation jobs --cluster {options.address} --follow {name} shows how far it is")
    return 0


def _refuse_options(job: RenderJob, options: ClusterOptions) -> None:
    """Raise UsageError for options that a cluster does not serve."""
    if options.detaches and options.address.startswith("local"):
        raise UsageError(f"--detach: the workers of {options.address} end with the command: name a scheduler")
    if job.processes != 1:
        raise UsageError("--cluster and -j: give one of them; --cluster local:4 has four workers on this machine")
    if job.codec and not job.videos:
        raise UsageError(f"--codec {job.codec}: a codec needs a video: write -o NAME.mp4, .mov, .mkv or .webm")


def _print_cluster_report(
    report: CampaignReport, chunk: FrameChunk, job: RenderJob, seconds: float, as_json: bool
) -> int:
    """Print what was done in `seconds`, and each frame that cannot be rendered; the exit code."""
    frames = sorted(report.seconds)
    costs: dict[str, Any] = join_chunk_costs(report.costs) if report.costs else {}
    if costs:
        print_report_notes(costs)
    _print_faults(report.faults)
    slowest = sorted(report.seconds.items(), key=lambda pair: -pair[1])[:3]
    if as_json:
        facts = {
            "written": list_written(job.destinations, frames),
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
