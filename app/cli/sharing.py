"""Shares the frames of a render with other processes as soon as that pays (`render -j auto`).

The command renders by itself, as with `-j 1`, and measures: how long a frame takes, how much of the processors, and how
much memory. When it has rendered two frames it computes how long the others would take in one process and in several,
of which each must start first, and starts as many as are fastest. These take frames from the end of the list, in pieces
that become shorter; this process takes them one by one from its beginning, so that all end at the same time.

Nothing is shared where a GPU renders, which processes would only divide, where a frame needs the one before, or where
all frames are in a video.
"""

from __future__ import annotations

import os
import threading
import time
from collections import deque
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from ..errors import HalationError, RenderError, rebuild_fault
from ..resources.interrupts import delay_interrupts
from ..resources.machine import available_cores, available_memory, resident_memory
from .cluster_job import describe_share
from .cluster_progress import list_written
from .helpers import join_costs
from .job_setup import find_remembering_node

if TYPE_CHECKING:
    from ..cluster.chunk import ChunkReport, FrameChunk
    from ..cluster.render_process import RenderProcess
    from ..graph import Graph, Port
    from ..renderer import Renderer
    from ..renderer.jobs.render_job import RenderJob
    from ..renderer.jobs.reports import FrameReport
    from .progress import ProgressReporter

_MEASURED = 2
"""Frames after which it is decided: the first one compiles programs and opens what others use again."""

_LEAST_GAIN = 0.05
"""The part of the time that sharing must save, by estimate, to be worth its memory: a choice."""

_MEMORY_SHARE = 0.8
"""The part of the free memory that processes may take together: a choice, the rest is for caches of files."""


class FrameCosts(Struct, frozen=True):
    """What a process was measured to take: seconds of a frame, seconds of processors for a frame and for its start, and
    bytes of memory.
    """

    seconds: float
    processor: float
    start: float
    memory: int


def count_processes(costs: FrameCosts, frames: int, cores: int, free_memory: float) -> int:
    """How many processes render so many frames soonest, including this one, which has started already.

    A process keeps some cores busy by itself. Others start first, then keep as many busy, up to all of them.
    """
    most = min(cores, frames, 1 + int(min(_MEMORY_SHARE * free_memory / max(1, costs.memory), cores)))
    busy = min(max(costs.processor, 1e-6) / max(costs.seconds, 1e-6), cores)

    def estimate_seconds(count: int) -> float:
        return (frames * costs.processor + (count - 1) * costs.start) / min(cores, count * busy)

    best = min(range(1, most + 1), key=estimate_seconds)
    return best if estimate_seconds(best) < (1.0 - _LEAST_GAIN) * estimate_seconds(1) else 1


class FrameSharing:
    """The frames of a job that nobody renders yet, and the processes that help to render them.

    It is what the job that renders here reports its progress to, and passes it on to `reporter`.
    """

    def __init__(self, job: RenderJob, graph: Graph, targets: Mapping[str, Port], reporter: ProgressReporter) -> None:
        self._job, self._graph, self._targets, self._reporter = job, graph, targets, reporter
        self.todo = deque(job.frames)
        """The frames that nobody has taken yet. The process here takes them from the left, others from the right."""
        self._lock = threading.Lock()
        self._marks: list[tuple[float, float]] = []
        self._done = 0
        self._is_decided = self._is_stopped = False
        self._threads: list[threading.Thread] = []
        self._reports: list[Mapping[str, Any]] = []
        self._finished: dict[int, bool] = {}
        """The frames that others have finished, and whether each was kept."""
        self._fault: HalationError | None = None
        self._renderer: Renderer | None = None

    def watch(self, renderer: Renderer) -> None:
        """Say what renders here."""
        self._renderer = renderer

    # --- what the job here reports -----------------------------------------------------------------------------------

    def report_pass(self, frame: int, passes_done: int, total: int, nodes: Sequence[str]) -> None:
        """Show a pass while no others render. Raises the error of another process."""
        self._raise_fault()
        if not self._threads:
            self._reporter.report_pass(frame, passes_done, total, nodes)

    def report_frame(self, report: FrameReport, frames_done: int, total: int) -> None:
        """Show a frame, and decide when enough is known. Raises the error of another process."""
        self._raise_fault()
        self._show(report)
        if report.is_kept or self._is_decided:
            return
        self._marks.append((time.perf_counter(), time.process_time()))
        if len(self._marks) == _MEASURED:
            self._is_decided = True
            self._start(self._choose_count())

    def join(self, report: dict[str, Any]) -> dict[str, Any]:
        """Wait for the others, and return the report of all from that of this process. Raises HalationError."""
        for thread in self._threads:
            while thread.is_alive():  # so that an interrupt is heard
                thread.join(0.1)
        self._raise_fault()
        if not self._reports:
            return report
        frames = sorted([*report["frames"], *self._finished])
        kept = [*report["kept"], *(frame for frame, is_kept in self._finished.items() if is_kept)]
        seconds = report["seconds"]
        others = [{**costs, "seconds": {**dict.fromkeys(seconds, 0.0), **costs["seconds"]}} for costs in self._reports]
        total = join_costs([report, *others])
        data = list(dict.fromkeys(name for costs in (report, *others) for name in costs["data"]))
        written = list_written(self._job.destinations, frames)
        return {**total, "written": written, "frames": frames, "kept": sorted(kept), "data": data}

    def stop(self) -> None:
        """End the others, and wait for it."""
        self._is_stopped = True
        self.todo.clear()
        for thread in self._threads:
            thread.join()

    # --- how many ----------------------------------------------------------------------------------------------------

    def _choose_count(self) -> int:
        """How many processes are to render the rest, with this one."""
        renderer, left = self._renderer, len(self.todo)
        if renderer is None or not renderer.device.target.software or self._job.videos or not left:
            return 1
        (began, used_before), (ended, used) = self._marks[0], self._marks[-1]
        frames = len(self._marks) - 1
        processor = (used - used_before) / frames
        costs = FrameCosts(
            (ended - began) / frames, processor, max(0.0, used_before - processor), resident_memory(os.getpid())
        )
        count = count_processes(costs, left, available_cores(), available_memory())
        if count > 1 and find_remembering_node(self._job, self._graph, self._targets)[0]:
            return 1
        return count

    def _start(self, count: int) -> None:
        """Start others, so that there are `count` with this one."""
        if count < 2:
            return
        from ..cluster.render_process import RenderProcess

        chunk = describe_share(self._job, self._graph)
        threads = max(1, available_cores() // count)
        with delay_interrupts():
            processes = [RenderProcess(threads) for _ in range(count - 1)]
            self._reporter.report_helpers([process.number for process in processes])
            for process in processes:
                thread = threading.Thread(target=self._run, args=(process, chunk, count), name="share", daemon=True)
                self._threads.append(thread)
                thread.start()

    # --- on the threads of the others --------------------------------------------------------------------------------

    def _run(self, process: RenderProcess, chunk: FrameChunk, count: int) -> None:
        """Have a process render until no frame is left."""
        try:
            while frames := self._take(count):
                piece = chunk.take_parts(frames)
                report = process.render(piece, self._note_frame, lambda: self._is_stopped, 0)
                self._take_in(report)
            process.finish()
        except Exception as fault:  # it must reach the user, whatever it is
            self._fail(RenderError(f"a process that renders cannot be used: {fault}"))
        finally:
            process.stop()

    def _take(self, count: int) -> tuple[int, ...]:
        """The next frames of one of `count` processes: fewer towards the end, so that all end together."""
        frames: list[int] = []
        with self._lock:
            for _ in range(max(1, len(self.todo) // (2 * count))):
                try:
                    frames.append(self.todo.pop())
                except IndexError:  # the process here has taken the last one
                    break
        return tuple(reversed(frames))

    def _note_frame(self, event: Mapping[str, Any]) -> None:
        """Show a frame that another process has finished."""
        from ..renderer.jobs.reports import FrameReport

        frame, is_kept = event["frame"], bool(event["kept"])
        self._finished[frame] = is_kept
        written = tuple(map(Path, list_written(self._job.destinations, (frame,))))
        self._show(FrameReport(frame, written, event["passes"], is_kept))

    def _take_in(self, report: ChunkReport) -> None:
        """Take in what came of a piece."""
        if report.costs:
            self._reports.append(report.costs)
        if report.death:
            self._fail(RenderError(f"a process that renders was ended ({report.death}): use --resume to go on"))
        elif report.refusal:
            self._fail(RenderError(f"a process that renders cannot go on: {report.refusal}"))
        elif report.faults:
            self._fail(rebuild_fault(dict(next(iter(report.faults.values())))))

    def _show(self, report: FrameReport) -> None:
        with self._lock:
            self._done += 1
            self._reporter.report_frame(report, self._done, len(self._job.frames))

    def _fail(self, fault: HalationError) -> None:
        """Render no more frames, because of an error. The first one counts."""
        self._fault = self._fault or fault
        self._is_stopped = True
        self.todo.clear()

    def _raise_fault(self) -> None:
        if self._fault is not None:
            raise self._fault
