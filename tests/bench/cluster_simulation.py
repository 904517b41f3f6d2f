"""A job on a cluster of any size as discrete events: how long it takes, and which part of the cluster is full.

The sender makes chunks and the scheduler hands them out, one after the other; both hear of finished frames too. Storage
gives its bytes to one reader or writer after the other. A worker has the next chunk while it renders one, reads the
picture of the next frame while it renders one, and writes a frame while it renders the next. At the end of a chunk it
waits for the last file.
"""

from __future__ import annotations

import contextlib
import heapq
from collections.abc import Generator, Iterator
from dataclasses import dataclass, field
from itertools import count

from halation.cluster.assignments import AssignmentQueue
from halation.cluster.worker_task import find_report_interval


@dataclass(frozen=True)
class ClusterCosts:
    """What things take, in seconds and bytes; `tests/bench/cluster.py check` measures the first two together."""

    sender: float = 0.002
    """A chunk, on the machine that sends the job."""
    scheduler: float = 0.004
    """A chunk, in Dask's scheduler."""
    report: float = 0.0002
    """A message about finished frames, in the scheduler and again in the sender."""
    render: float = 0.5
    """A frame on a worker."""
    decode: float = 0.02
    """The picture of a frame, once its bytes are there."""
    encode: float = 0.03
    """The file of a frame."""
    bytes_read: float = 0.0
    bytes_written: float = 0.0
    bandwidth: float = 2.5e9
    """Bytes of the storage in a second, for all machines together."""


@dataclass
class Station:
    """Serves one after the other, in the order in which they come."""

    free_at: float = 0.0
    busy: float = 0.0

    def serve(self, now: float, seconds: float) -> float:
        """When somebody is done who comes now and takes so long."""
        self.free_at = max(self.free_at, now) + seconds
        self.busy += seconds
        return self.free_at


Activity = Generator[float, float, None]
"""Yields the time at which it goes on, and is told it."""


@dataclass
class SimulatedWorker:
    """Chunks that have arrived, and whether the worker stands still for want of one."""

    chunks: list[int] = field(default_factory=list[int])
    is_idle: bool = True


class ClusterSimulation:
    """One job. `frames` and `workers` are counts."""

    def __init__(self, costs: ClusterCosts, workers: int, frames: int) -> None:
        self.costs, self.frames = costs, frames
        self.sender, self.scheduler, self.storage = Station(), Station(), Station()
        self.end = 0.0
        """When the last frame is written."""
        self.chunk_count = 0
        self._queue = AssignmentQueue(range(frames), is_chain=False)
        self._slots = workers
        self._interval = find_report_interval({"": workers})
        self._numbers = count()
        self._events: list[tuple[float, int, Activity]] = []
        for _ in range(workers):
            worker = SimulatedWorker()
            for _ in range(2):  # as many as `campaign` sends for each place where one is rendered
                self._start(0.0, self._dispatch(worker))

    def run(self) -> ClusterSimulation:
        """Let all happen."""
        while self._events:
            now, _, activity = heapq.heappop(self._events)
            with contextlib.suppress(StopIteration):
                self._push(activity.send(now), activity)
        return self

    def list_shares(self) -> dict[str, float]:
        """How much of the time each part of the cluster was busy, the workers with rendering."""
        workers = self.frames * self.costs.render / self._slots
        stations = {"sender": self.sender.busy, "scheduler": self.scheduler.busy, "storage": self.storage.busy}
        return {name: busy / self.end for name, busy in {"workers": workers, **stations}.items()}

    # --- what happens ------------------------------------------------------------------------------------------------

    def _start(self, now: float, activity: Activity) -> None:
        """Have something happen from now on."""
        next(activity)
        self._push(now, activity)

    def _push(self, then: float, activity: Activity) -> None:
        heapq.heappush(self._events, (then, next(self._numbers), activity))

    def _dispatch(self, worker: SimulatedWorker) -> Activity:
        """The next chunk on its way to a worker."""
        now = yield 0.0
        assignment = self._queue.take(self._slots)
        if assignment is None or not assignment.frames:
            return
        self.chunk_count += 1
        now = yield self.sender.serve(now, self.costs.sender)
        now = yield self.scheduler.serve(now, self.costs.scheduler)
        worker.chunks.append(len(assignment.frames))
        if worker.is_idle:
            worker.is_idle = False
            self._start(now, self._render(worker))

    def _render(self, worker: SimulatedWorker) -> Activity:
        """The chunks of a worker, until it has none."""
        now = yield 0.0
        costs, reported_at = self.costs, now
        while worker.chunks:
            frames = worker.chunks.pop(0)
            picture_at, written_at = self._read(now), now
            for number in range(frames):
                now = yield max(now, picture_at)
                if number + 1 < frames:
                    picture_at = self._read(now)
                now = yield now + costs.render
                written_at = max(written_at, now) + costs.encode
                written_at = max(written_at, self.storage.serve(now, costs.bytes_written / costs.bandwidth))
                if now - reported_at > self._interval:
                    reported_at = now
                    self._start(now, self._report())
            now = yield max(now, written_at)
            self._queue.note_cost([costs.render] * frames)
            self._start(now, self._report())
            self._start(now, self._dispatch(worker))
            self.end = max(self.end, now)
        worker.is_idle = True

    def _read(self, now: float) -> float:
        """When the picture of a frame is there that is asked for now."""
        if not self.costs.bytes_read:
            return now
        return self.storage.serve(now, self.costs.bytes_read / self.costs.bandwidth) + self.costs.decode

    def _report(self) -> Activity:
        """A message about finished frames."""
        now = yield 0.0
        now = yield self.scheduler.serve(now, self.costs.report)
        yield self.sender.serve(now, self.costs.report)


def iterate_limits(costs: ClusterCosts, workers: int, chunk: float) -> Iterator[tuple[str, float]]:
    """The most frames a second that each part of a cluster can do alone, with chunks of so many frames.

    The bounds of operational analysis (Denning and Buzen 1978): no part is busy for longer than it is there.
    """
    yield "workers", workers / costs.render
    yield "sender", chunk / costs.sender
    yield "scheduler", chunk / costs.scheduler
    if moved := costs.bytes_read + costs.bytes_written:
        yield "storage", costs.bandwidth / moved
