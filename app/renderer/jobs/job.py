"""Renders a graph into files: what `halation render` does after its arguments are parsed.

While a frame is rendered, the pictures of the next one are decoded and the results of the frames before are written,
within bounded memory: a few pictures ahead, two frames behind. What two frames have in common stays on the device.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from msgspec import Struct, field
from msgspec.structs import replace

from ... import media
from ...compiler import Plan
from ...errors import HalationError, UsageError
from ...graph import Graph
from ...resources.atomic_write import remove_abandoned_files
from ..engine import Renderer, RenderRequest
from ..execution.decoding import Array
from ..execution.texture_pool import TextureLease
from ..frame_renderer import FrameRenderer
from .destinations import (
    Destination,
    OutputSettings,
    check_destinations,
    choose_views,
    plan_destinations,
    select_half_outputs,
)
from .header import compute_frame_key, dump_whole_graph, has_key, make_header, matches_key
from .scanline_writers import ScanlineWriters, select_row_outputs
from .source_files import FileHashes, SourceFile, SourceFinder
from .video_writers import VideoWriters
from .write_queue import WriteQueue

if TYPE_CHECKING:
    from fractions import Fraction
from functools import cached_property

__all__ = ["FrameReport", "JobProgress", "JobReport", "OutputSettings", "run_job"]


class FrameReport(Struct, frozen=True):
    """The result of a frame. `passes` were executed for it; none if its files were up to date and are kept.

    A video is not among the files `written`: it is complete when all frames are.
    """

    frame: int
    written: tuple[Path, ...]
    passes: int
    is_kept: bool = False


class JobProgress(Protocol):
    """Is told how far a job is."""

    def report_pass(self, frame: int, passes_done: int, total: int, nodes: Sequence[str]) -> None:
        """A pass of a frame, or of a frame of its history, is finished; it computed these nodes."""
        ...

    def report_frame(self, report: FrameReport, frames_done: int, total: int) -> None:
        """The files of a frame are written; `frames_done` of `total` frames are finished."""
        ...


class JobReport(Struct, frozen=True):
    """What a job did. `seconds` are by stage; stages of different frames overlap."""

    frames: tuple[FrameReport, ...]
    passes: int
    programs: int
    peak_bytes: int
    repaired: Mapping[str, int]
    videos: tuple[Path, ...] = ()
    seconds: Mapping[str, float] = field(default_factory=dict[str, float])
    warnings: Mapping[str, str] = field(default_factory=dict[str, str])
    views: Mapping[str, str] = field(default_factory=dict[str, str])
    """The views that were chosen for outputs because nobody named one and their pictures are made for a screen."""
    data_outputs: tuple[str, ...] = ()
    """The outputs that are data and whose numbers were written without a view into a format for a screen."""

    @property
    def written(self) -> tuple[Path, ...]:
        """All files, in the order of the frames, then the videos, which hold all of them."""
        return (*(path for frame in self.frames for path in frame.written), *self.videos)


def run_job(
    renderer: Renderer,
    graph: Graph,
    request: RenderRequest,
    settings: OutputSettings,
    frames: Sequence[int] | None = None,
    *,
    resume: bool = False,
    progress: JobProgress | None = None,
) -> JobReport:
    """Render frames, by default that of `request`, and write them.

    Destinations are checked before anything is rendered. With `resume`, files that are up to date are kept. Raises the
    errors of `app.errors`; the files of finished frames stay, and no incomplete file and no video is left behind.
    """
    counters, programs = renderer.runner.counters.passes, renderer.runner.programs.compiled
    job = _Job(renderer, graph, request, settings, resume, progress, tuple(frames or (request.frame,)))
    try:
        reports = job.run()
    finally:
        job.close()
    return JobReport(
        tuple(reports),
        renderer.runner.counters.passes - counters,
        renderer.runner.programs.compiled - programs,
        renderer.runner.textures.peak,
        dict(renderer.pictures.repaired_pixels),
        job.videos,
        job.seconds,
        dict(renderer.pictures.warnings),
        job.views,
        job.data_outputs,
    )


class _Task(Struct, frozen=True):
    """One frame: its files, its plan, and the files that it reads."""

    frame: int
    files: tuple[Destination, ...]
    plan: Plan
    sources: tuple[SourceFile, ...]


class _Job:
    def __init__(
        self,
        renderer: Renderer,
        graph: Graph,
        request: RenderRequest,
        settings: OutputSettings,
        resume: bool,
        progress: JobProgress | None,
        frames: tuple[int, ...],
    ) -> None:
        self._files = plan_destinations(graph, request, settings, frames, renderer.sandbox)
        first = self._files[frames[0]]
        by_rows = select_row_outputs(first) if renderer.device.target.memory else frozenset[str]()
        request = replace(request, halves=select_half_outputs(first, settings), by_rows=by_rows)
        self._renderer, self._graph, self._request, self._settings = renderer, graph, request, settings
        self._resume, self._progress, self._frames = resume, progress, frames
        self._frame_renderer = FrameRenderer(renderer, graph, request)
        self._hashes = FileHashes(sandbox=self._renderer.sandbox)
        self._sources = SourceFinder(renderer.pictures, graph, renderer.pictures.bind(graph, request.bound_inputs))
        self._write_queue = WriteQueue[FrameReport]()
        self._fault: HalationError | None = None
        self._reports: list[FrameReport] = []
        self._video_writers = VideoWriters(settings, self._find_rate, renderer.sandbox)
        self._row_writers: ScanlineWriters | None = None
        self.videos: tuple[Path, ...] = ()
        self.data_outputs = tuple(dict.fromkeys(name for file in first for name in file.data_outputs))
        self.views: dict[str, str] = {}
        self.seconds = {"compile": 0.0, "render": 0.0, "write": 0.0}

    def run(self) -> list[FrameReport]:
        """Render all frames. While the device renders one, the pictures of the next one are decoded and the frame after
        that is planned; writing lags behind, in threads of its own.
        """
        if self._resume and self._settings.videos:
            raise UsageError(
                f"{self._settings.videos[0]}: a video is written anew as a whole: leave out --resume, or render "
                "numbered pictures, which can be kept"
            )
        if self._resume:
            for folder in {file.path.parent for files in self._files.values() for file in files}:
                remove_abandoned_files(folder)
        todo = deque(self._frames)
        task = self._plan_next(todo)
        if task is not None:
            self._renderer.runner.start_decoding(task.plan)
        following = self._plan_next(todo)
        while task is not None:
            lease, passes = self._render_frame(task, following)
            task_after = self._plan_next(todo)  # while the device is busy
            self._write_frame(task, self._download(task, lease), passes)
            task, following = following, task_after
        for report in self._write_queue.collect_all():
            self._report_frame(report)
        if self._fault is not None:
            raise self._fault
        started = time.perf_counter()
        self.videos = self._video_writers.finish()
        self.seconds["write"] += time.perf_counter() - started
        return sorted(self._reports, key=lambda report: self._frames.index(report.frame))

    def close(self) -> None:
        """Finish the file that is being written, and remove incomplete ones."""
        self._write_queue.close()
        self._video_writers.abort()
        if self._row_writers is not None:
            self._row_writers.abort()
        self._hashes.close()
        self._frame_renderer.close()

    @cached_property
    def _graph_text(self) -> str:
        """The text of the graph for headers."""
        return dump_whole_graph(self._graph)

    # --- one frame ---------------------------------------------------------------------------------------------------

    def _plan_next(self, todo: deque[int]) -> _Task | None:
        """The next frame that must be rendered; None at the end, or at a frame with an error, which ends the job later.

        So the frames before the faulty one are still finished.
        """
        try:
            return self._find_unfinished(todo)
        except HalationError as error:
            self._fault = error
            todo.clear()
            return None

    def _find_unfinished(self, todo: deque[int]) -> _Task | None:
        while todo:
            frame, started = todo.popleft(), time.perf_counter()
            plan = self._frame_renderer.plan_frame(frame)
            sources = {item.node: item.picture for item in plan.uploads if not item.picture.in_memory}
            files = choose_views(self._files[frame], plan, self._renderer.pictures)
            for planned, file in zip(self._files[frame], files, strict=True):
                self.views |= dict.fromkeys(file.layers.values(), file.view) if file.view != planned.view else {}
            check_destinations(files, plan, sources, self._settings, sandbox=self._renderer.sandbox)
            task = _Task(
                frame,
                files,
                plan,
                self._sources.find_sources(plan, frame, self._frame_renderer.find_history_start(frame)),
            )
            self.seconds["compile"] += time.perf_counter() - started
            if self._resume and self._is_done(task):
                self._report_frame(FrameReport(frame, tuple(file.path for file in files), 0, is_kept=True))
                continue
            return task
        return None

    def _is_done(self, task: _Task) -> bool:
        """True if the files of a frame exist and are up to date."""
        if not all(has_key(file, self._renderer.sandbox) for file in task.files):
            return False
        request = replace(self._request, frame=task.frame)
        keys = (
            compute_frame_key(self._graph_text, request, task.plan, file, self._settings, task.sources, self._hashes)
            for file in task.files
        )
        return all(matches_key(file, key, self._renderer.sandbox) for file, key in zip(task.files, keys, strict=True))

    def _render_frame(self, task: _Task, following: _Task | None) -> tuple[TextureLease, int]:
        """Send the passes of a frame to the device; a lease of its outputs, and the number of passes."""
        started, passes = time.perf_counter(), 0
        self._hashes.start(task.sources)
        lease = self._renderer.runner.create_lease()
        self._row_writers = ScanlineWriters(
            task.plan, task.files, self._settings, lambda file: self._make_header(task, file), self._renderer.sandbox
        )
        for run in self._frame_renderer.start_runs(task.frame, lease, following=following.frame if following else None):
            run.receive_rows = self._row_writers.write_rows
            with run:
                if following is not None:
                    self._renderer.runner.start_decoding(
                        following.plan, {surface.key for surface in task.plan.surfaces}
                    )
                for passes_done, render_pass in enumerate(run, 1):
                    passes += 1
                    if self._progress is not None:
                        self._progress.report_pass(task.frame, passes_done, run.total, render_pass.nodes)
        self.seconds["render"] += time.perf_counter() - started
        return lease, passes

    def _download(self, task: _Task, lease: TextureLease) -> dict[str, Array]:
        """Wait for the outputs of a frame."""
        started = time.perf_counter()
        outputs = self._renderer.runner.download(task.plan, self._write_queue.arrays)
        lease.close()
        self.seconds["render"] += time.perf_counter() - started
        return outputs

    def _make_header(self, task: _Task, file: Destination) -> dict[str, Any]:
        """The metadata of a file."""
        request, device = replace(self._request, frame=task.frame), self._renderer.device
        metadata = make_header(
            self._graph_text,
            device.target,
            request,
            self._frame_renderer.frames,
            self._settings,
            file,
            task.plan,
            task.sources,
            self._hashes,
        )
        metadata["halation:driver"] = device.driver
        return metadata

    def _write_frame(self, task: _Task, outputs: Mapping[str, Array], passes: int) -> None:
        """Hand the outputs of a frame to the write queue: `write` runs in its thread, later."""
        files_by_rows = self._row_writers.finish() if self._row_writers else frozenset[Path]()

        def write(outputs: Mapping[str, Array]) -> FrameReport:
            started = time.perf_counter()
            for file in task.files:
                if file.path in files_by_rows:
                    continue
                header = self._make_header(task, file)
                layers = {layer: outputs[name] for layer, name in file.layers.items()}
                if file.path in self._settings.videos:
                    self._video_writers.add_frame(file, layers, task.frame, header)
                    continue
                media.write_picture(
                    file.path,
                    layers,
                    kinds=file.kinds,
                    precision=self._settings.precision,
                    compression=self._settings.compression,
                    metadata=header,
                    encoding=file.encoding,
                    frame=task.frame,
                    sandbox=self._renderer.sandbox,
                )
            self.seconds["write"] += time.perf_counter() - started
            pictures = (file.path for file in task.files if file.path not in self._settings.videos)
            return FrameReport(task.frame, tuple(pictures), passes)

        self._write_queue.submit(write, outputs)
        for report in self._write_queue.collect_finished():
            self._report_frame(report)

    def _find_rate(self) -> float | Fraction:
        """The frames per second of videos."""
        pictures = self._renderer.pictures
        return pictures.find_rate(self._graph, pictures.bind(self._graph, self._request.bound_inputs))

    def _report_frame(self, report: FrameReport) -> None:
        self._reports.append(report)
        if self._progress is not None:
            self._progress.report_frame(report, len(self._reports), len(self._frames))
