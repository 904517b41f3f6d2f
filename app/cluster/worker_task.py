"""What Dask runs on a worker: one fixed function, whose argument and result are texts."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from msgspec.structs import replace

from ..errors import UsageError
from ..renderer.jobs.shared_results import remove_shared_folder
from ..resources.machine import machine_memory
from .chunk import ChunkReport, FrameChunk
from .path_map import PathMap
from .render_process import RenderProcessPool, find_kind, share_cores

if TYPE_CHECKING:
    from distributed import Worker

_REPORT_INTERVAL = 0.25
"""Seconds between two messages about finished frames: a bar needs no more."""

_REPORTS_PER_SECOND = 200
"""Such messages from all workers together: each takes the scheduler and the sender some tenths of a millisecond, by
estimate. A thousand workers would send four thousand."""

_OWN_MEMORY = 512 << 20
"""Bytes that Python, driver and decoders take besides the pictures: about 400 MB, measured with Mesa 22.3."""


def render_chunk(text: str) -> str:
    """Render a `FrameChunk` in a warm process beside this worker; a `ChunkReport`. Both are JSON."""
    worker = find_worker()
    try:
        chunk = FrameChunk.from_json(text)
    except UsageError as fault:
        return ChunkReport(worker.address, refusal=f"it has another version of Halation: {fault}").to_json()
    limit = read_memory_limit(worker)
    chunk = replace(chunk, job=replace(chunk.job, memory=choose_memory(chunk.job.memory, limit)))
    reporter = FrameReporter(worker, chunk)
    with open_pool().lend_process(find_kind(chunk.job), share_cores(chunk.slots, worker.address)) as process:
        report = process.render(chunk, reporter.report_frame, make_cancel_check(worker), limit)
    reporter.flush()
    return replace(report, worker=worker.address).to_json()


def remove_results(text: str) -> None:
    """Remove the shared results of a job; the JSON has the folder, and how paths are mapped."""
    folder, pairs = json.loads(text)
    remove_shared_folder(Path(PathMap(pairs).locate(folder)))


def find_worker() -> Worker:
    """The worker whose task runs on this thread."""
    from distributed import get_worker

    return get_worker()


def read_version() -> str:
    """The version of Halation on a worker."""
    from ..version import VERSION

    return VERSION


def read_memory_limit(worker: Worker) -> int:
    """The bytes that a worker may take, 0 for as many as the machine has."""
    limit = int(getattr(getattr(worker, "memory_manager", None), "memory_limit", 0) or 0)
    return limit if limit < machine_memory() else 0


def choose_memory(memory: int, limit: int) -> int:
    """The bytes that a frame may take on a worker with a limit; 0 for any number."""
    if not limit:
        return memory
    share = max(limit - _OWN_MEMORY, limit // 4)
    return min(memory or share, share)


@cache
def open_pool() -> RenderProcessPool:
    """The warm processes of this process, which may hold several workers."""
    return RenderProcessPool()


def make_cancel_check(worker: Worker) -> Callable[[], bool]:
    """What tells whether the task that runs on this thread is still needed."""
    key = worker.get_current_task()

    def is_cancelled() -> bool:
        task = worker.state.tasks.get(key)
        return task is None or task.state in ("cancelled", "resumed") or worker.status.name not in ("running", "paused")

    return is_cancelled


def find_report_interval(slots: Mapping[str, int]) -> float:
    """Seconds between two messages of a worker about finished frames; `slots` as in `FrameChunk`."""
    return max(_REPORT_INTERVAL, sum(slots.values()) / _REPORTS_PER_SECOND)


class FrameReporter:
    """Tells the sender of a chunk which frames are finished, some at a time."""

    def __init__(self, worker: Worker, chunk: FrameChunk) -> None:
        self._worker, self._topic, self._interval = worker, chunk.topic, find_report_interval(chunk.slots)
        self._frames: list[dict[str, Any]] = []
        self._sent_at = time.monotonic()

    def report_frame(self, event: dict[str, Any]) -> None:
        """Note a finished frame, and send what has gathered from time to time."""
        self._frames.append(event)
        if time.monotonic() - self._sent_at > self._interval:
            self.flush()

    def flush(self) -> None:
        """Send what has gathered."""
        if self._topic and self._frames:
            cast("Any", self._worker).log_event(self._topic, {"worker": self._worker.address, "frames": self._frames})
        self._frames, self._sent_at = [], time.monotonic()
