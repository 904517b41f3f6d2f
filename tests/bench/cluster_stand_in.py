"""A cluster in one process whose workers only wait: what sender and scheduler take, and how long jobs last.

All else is real: the campaign, Dask's scheduler, messages about frames. So one machine shows what a farm would do.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from halation.cluster import assignments, campaign
from halation.cluster.campaign_report import CampaignReport
from halation.cluster.chunk import ChunkReport, FrameChunk
from halation.cluster.connection import start_cluster
from halation.cluster.worker_task import FrameReporter, find_worker
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED

if TYPE_CHECKING:
    from distributed import Client


GRAPH_BYTES = 3000
"""A graph of some twenty nodes."""


class SilentListener:
    """Shows nothing."""

    def report_progress(self, report: CampaignReport, workers: int) -> None:
        """Nothing."""

    def report_note(self, sentence: str) -> None:
        """Nothing."""


def wait_for_chunk(text: str) -> str:
    """Stands in for `render_chunk`: waits as long as the job says in place of its `scale`, for each frame."""
    worker, chunk = find_worker(), FrameChunk.from_json(text)
    reporter, seconds = FrameReporter(worker, chunk), chunk.job.scale
    for frame in chunk.job.frames:
        time.sleep(seconds)
        reporter.report_frame({"frame": frame, "seconds": seconds, "kept": False, "passes": 1})
    reporter.flush()
    return ChunkReport(worker.address, dict.fromkeys(chunk.job.frames, seconds)).to_json()


@contextmanager
def open_waiting_cluster(workers: int) -> Iterator[Client]:
    """A scheduler and so many workers on threads of this process."""
    from distributed import Client

    render_chunk = campaign.render_chunk
    campaign.render_chunk = wait_for_chunk
    try:
        with start_cluster(workers) as cluster, Client(cluster, set_as_default=False) as client:
            yield client
    finally:
        campaign.render_chunk = render_chunk


class SingleFrames(assignments.AssignmentQueue):
    """Frames that are sent one by one, whatever they cost."""

    def note_cost(self, seconds: Sequence[float], *, is_first: bool = False) -> None:
        """Learn nothing but that workers are there, which may have a frame more each."""
        self.sends_ahead = True


def run_job(client: Client, frames: int, seconds: float, *, singly: bool = False) -> tuple[float, float, int]:
    """Have frames that take so long waited for: how long that took, the seconds of processors, and the chunks."""
    numbers: dict[str, Any] = {"frames": tuple(range(1, frames + 1)), "scale": seconds}
    chunk = FrameChunk(RenderJob(sandbox=UNRESTRICTED, document="-" * GRAPH_BYTES, **numbers), "/")
    queue = campaign.AssignmentQueue
    campaign.AssignmentQueue = SingleFrames if singly else queue
    try:
        job = campaign.FrameCampaign(client, "local", chunk, lambda _: {}, SilentListener())
    finally:
        campaign.AssignmentQueue = queue
    started, used = time.perf_counter(), time.process_time()
    report = job.run()
    assert len(report.seconds) == frames, report.faults
    return time.perf_counter() - started, time.process_time() - used, report.chunks
