"""The three stages that all frames of a job go through: decode, render, write.

Items come one after the other, and the frames of one item after those of the item before, without a gap: while the
last frame of an item is rendered, the pictures of the next item are decoded. So many files with one frame each are as
fast as one sequence. An error ends the item that it happens in, and no other.

Two rules keep memory flat. At most two frames are planned ahead of the one on the device, and an item is opened only
when its first frame is planned.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import nullcontext

from ...errors import HalationError
from ...graph import Graph
from ...resources.large_arrays import create_array, reuse_pages
from ..engine import Renderer
from ..execution.decoding import Array
from ..execution.texture_pool import TextureLease
from .header import dump_whole_graph
from .item_session import FrameTask, ItemSession, JobItem
from .reports import FrameReport, ItemReport, JobProgress
from .scanline_writers import ScanlineWriters
from .source_files import FileHashes
from .write_queue import WriteQueue

ItemOpener = Callable[[], JobItem]
"""Makes an item when it is its turn. May raise the errors of `app.errors`, which end this item only."""


class KeptResults:
    """The results that a pipeline leaves on the device for a later one: what its last frame shares with the next."""

    def __init__(self) -> None:
        self._lease: TextureLease | None = None

    def replace(self, lease: TextureLease | None) -> None:
        """Keep what this lease holds instead of what was kept; nothing for None."""
        if self._lease is not None:
            self._lease.close()
        self._lease = lease


class FramePipeline:
    """Renders the frames of items into files; `report_item` is called when an item is finished or has failed.

    `kept` has what an earlier pipeline has left on the device, and takes what this one leaves.
    """

    def __init__(
        self,
        renderer: Renderer,
        items: Iterable[tuple[str, ItemOpener]],
        report_item: Callable[[ItemReport], None],
        *,
        resume: bool = False,
        progress: JobProgress | None = None,
        writers: int = 1,
        hashes: FileHashes | None = None,
        kept: KeptResults | None = None,
    ) -> None:
        self._kept = kept
        self._renderer, self._items, self._report_item = renderer, items, report_item
        self._resume, self._progress = resume, progress
        self._owns_hashes = hashes is None
        self._hashes = hashes or FileHashes(sandbox=renderer.sandbox)
        self._write_queue = WriteQueue[tuple[FrameTask, FrameReport | HalationError, float]](writers)
        self._row_writers: ScanlineWriters | None = None
        self._sessions: list[ItemSession] = []
        self._last_text: tuple[Graph, str] | None = None
        self.seconds = {"compile": 0.0, "render": 0.0, "write": 0.0}

    def run(self) -> None:
        """Render all items. While the device renders a frame, the pictures of the next one are decoded and the frame
        after that is planned; writing lags behind, in threads of its own.
        """
        tasks = self._plan_tasks()
        task = next(tasks, None)
        if task is not None:
            self._renderer.runner.start_decoding(task.plan)
        following = next(tasks, None)
        with reuse_pages() if following else nullcontext():
            while task is not None:
                passes = self._try_render(task, following)
                task_after = next(tasks, None)  # while the device is busy
                if passes is not None:
                    self._try_write(task, *passes, is_last=following is None)
                self._close_sessions_before(task.session)
                task, following = following, task_after
        for written_frame in self._write_queue.collect_all():
            self._finish_write(*written_frame)

    def close(self) -> None:
        """Finish the file that is being written, and remove incomplete ones."""
        self._write_queue.close()
        if self._row_writers is not None:
            self._row_writers.abort()
        for session in self._sessions:
            session.abort()
        if self._owns_hashes:
            self._hashes.close()

    # --- items -------------------------------------------------------------------------------------------------------

    def _plan_tasks(self) -> Iterator[FrameTask]:
        """The frames of all items that must be rendered, each planned when it is asked for."""
        for name, open_item in self._items:
            try:
                item = open_item()
                graph_text = item.graph_text or self._dump_graph(item.graph)
                session = ItemSession(self._renderer, item, graph_text, self._hashes, self._resume)
            except HalationError as fault:
                self._report_item(ItemReport(name, (), fault=fault))
                continue
            self._sessions.append(session)
            while session.todo:
                if task := self._plan_task(session):
                    yield task
            self._settle(session)

    def _plan_task(self, session: ItemSession) -> FrameTask | None:
        """The next frame of an item; None if its files are kept, or for an error, which ends the item.

        The frames before the faulty one are still finished.
        """
        started = time.perf_counter()
        try:
            frame = session.todo.popleft()
        except IndexError:  # another process has taken the last one just now
            return None
        try:
            task = session.plan_task(frame)
            self.seconds["compile"] += time.perf_counter() - started
            kept = session.find_kept_frame(task)
        except HalationError as fault:
            session.give_up(fault)
            return None
        if kept is not None:
            self._report_frame(session, kept)
            return None
        session.unfinished_tasks += 1
        return task

    def _finish_task(self, task: FrameTask, report: FrameReport | HalationError) -> None:
        """Note what became of a frame."""
        task.session.unfinished_tasks -= 1
        if isinstance(report, HalationError):
            task.session.give_up(report)
            task.session.is_stopped = True
        else:
            self._report_frame(task.session, report)
        self._settle(task.session)

    def _report_frame(self, session: ItemSession, report: FrameReport) -> None:
        session.reports.append(report)
        if self._progress is not None:
            self._progress.report_frame(report, len(session.reports), len(session.item.frames))

    def _settle(self, session: ItemSession) -> None:
        """Report an item whose last frame is finished or given up."""
        if session.is_complete and not session.is_settled:
            session.is_settled, started = True, time.perf_counter()
            report = session.finish()
            self.seconds["write"] += time.perf_counter() - started
            self._report_item(report)

    def _close_sessions_before(self, session: ItemSession) -> None:
        """Release what earlier items left on the device: the item that is rendered now has taken what it shares."""
        index = self._sessions.index(session)
        for earlier in self._sessions[:index]:
            earlier.frame_renderer.close()
        self._sessions = [other for place, other in enumerate(self._sessions) if place >= index or not other.is_settled]

    def _dump_graph(self, graph: Graph) -> str:
        """The text of a graph for headers; items mostly have the same graph."""
        if self._last_text is None or self._last_text[0] is not graph:
            self._last_text = graph, dump_whole_graph(graph)
        return self._last_text[1]

    # --- one frame ---------------------------------------------------------------------------------------------------

    def _try_render(self, task: FrameTask, following: FrameTask | None) -> tuple[TextureLease, int] | None:
        """Send the passes of a frame to the device; None if its item has failed, or fails now."""
        if task.session.fault is not None and task.session.is_stopped:
            self._finish_task(task, task.session.fault)
            return None
        lease = self._renderer.runner.create_lease()
        try:
            return lease, self._render_frame(task, lease, following)
        except HalationError as fault:
            self._drop_frame(task, lease, fault)
            return None
        except BaseException:  # an interrupt, or a caller that no longer wants the frame
            lease.close()
            raise

    def _drop_frame(self, task: FrameTask, lease: TextureLease, fault: HalationError) -> None:
        """Give up a frame and its item, and remove the files that it began."""
        lease.close()
        if self._row_writers is not None:
            self._row_writers.abort()
        self._finish_task(task, fault)

    def _render_frame(self, task: FrameTask, lease: TextureLease, following: FrameTask | None) -> int:
        """Send the passes of a frame to the device; the number of passes."""
        started, passes = time.perf_counter(), 0
        self._hashes.start(task.sources)
        self._row_writers = task.session.open_row_writers(task)
        following_plan = following.plan if following else None
        coming_plan = task.session.plan_coming(task) if self._kept and following is None else following_plan
        for run in task.session.frame_renderer.start_runs(task.frame, lease, following=coming_plan):
            run.receive_rows = self._row_writers.write_rows
            with run:
                if following_plan is not None:
                    coming_keys = {surface.key for surface in task.plan.surfaces}
                    self._renderer.runner.start_decoding(following_plan, coming_keys)
                for passes_done, render_pass in enumerate(run, 1):
                    passes += 1
                    if self._progress is not None:
                        self._progress.report_pass(task.frame, passes_done, run.total, render_pass.nodes)
        if self._kept and following is None:
            self._kept.replace(task.session.frame_renderer.take_carried())
        self.seconds["render"] += time.perf_counter() - started
        return passes

    def _try_write(self, task: FrameTask, lease: TextureLease, passes: int, *, is_last: bool) -> None:
        """Wait for the outputs of a frame, and hand them to the write queue."""
        try:
            outputs = self._download(task, lease, is_last=is_last)
            files_by_rows = self._row_writers.finish() if self._row_writers else frozenset()
        except HalationError as fault:
            self._drop_frame(task, lease, fault)
            return

        def write(outputs: Mapping[str, Array]) -> tuple[FrameTask, FrameReport | HalationError, float]:
            started = time.perf_counter()
            try:
                task.session.write_files(task, outputs, files_by_rows)
            except HalationError as fault:
                return task, fault, time.perf_counter() - started
            return task, task.session.describe_frame(task, passes), time.perf_counter() - started

        self._write_queue.submit(write, outputs)
        for written_frame in self._write_queue.collect_finished():
            self._finish_write(*written_frame)

    def _finish_write(self, task: FrameTask, report: FrameReport | HalationError, seconds: float) -> None:
        self.seconds["write"] += seconds
        self._finish_task(task, report)

    def _download(self, task: FrameTask, lease: TextureLease, *, is_last: bool) -> dict[str, Array]:
        """Wait for the outputs of a frame. Textures that no frame will use make room for them."""
        started = time.perf_counter()
        if is_last:
            self._renderer.runner.release_unused()
        outputs = self._renderer.runner.download(task.plan, create_array)
        lease.close()
        self.seconds["render"] += time.perf_counter() - started
        return outputs
