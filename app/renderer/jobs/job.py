"""Renderings from graph to files: what `halation render` does once its arguments are understood.

While a frame is computed the next one's pictures are decoded and the last one's results are written, all in bounded
memory: a few pictures ahead, two frames behind. What two frames have in common stays on the device in between.
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
from ..execution.texture_pool import Lease
from ..frame_renderer import FrameRenderer
from .destinations import Destination, OutputSettings, check_destinations, plan_destinations, select_half_outputs
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
    """What became of a frame. `passes` were executed for it; none where its files were `kept` as they were.

    A video is not among the files `written`: it is there when all frames are.
    """

    frame: int
    written: tuple[Path, ...]
    passes: int
    kept: bool = False


class JobProgress(Protocol):
    """Hears how far a job is."""

    def report_pass(self, frame: int, done: int, total: int, nodes: Sequence[str]) -> None:
        """A pass of a frame, or of one that leads up to it, is done; it computed these nodes."""
        ...

    def report_frame(self, report: FrameReport, done: int, total: int) -> None:
        """The files of a frame are there; so many of all frames are done."""
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

    @property
    def written(self) -> tuple[Path, ...]:
        """All files, in the order of the frames, then the videos, which hold all of them."""
        return (*(path for frame in self.frames for path in frame.written), *self.videos)


def run_job(
    renderer: Renderer,
    graph: Graph,
    wanted: RenderRequest,
    writing: OutputSettings,
    frames: Sequence[int] | None = None,
    *,
    resume: bool = False,
    progress: JobProgress | None = None,
) -> JobReport:
    """Render frames, by default that of `wanted`, and write them.

    Whatever can be known to be wrong with a destination is known before anything is rendered. With `resume`, frames
    whose files are there and would come out the same are kept. Raises the errors of `app.errors`; the frames that were
    finished stay, no partial file and no video is left behind.
    """
    counters, programs = renderer.runner.counters.passes, renderer.runner.programs.compiled
    job = _Job(renderer, graph, wanted, writing, resume, progress, tuple(frames or (wanted.frame,)))
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
    )


class _Task(Struct, frozen=True):
    """One frame: its files, how it is made, and of what."""

    frame: int
    files: tuple[Destination, ...]
    plan: Plan
    sources: tuple[SourceFile, ...]


class _Job:
    def __init__(
        self,
        renderer: Renderer,
        graph: Graph,
        wanted: RenderRequest,
        writing: OutputSettings,
        resume: bool,
        progress: JobProgress | None,
        frames: tuple[int, ...],
    ) -> None:
        self._files = plan_destinations(graph, wanted, writing, frames, renderer.sandbox)
        first = self._files[frames[0]]
        by_rows = select_row_outputs(first) if renderer.device.target.memory else frozenset[str]()
        wanted = replace(wanted, halves=select_half_outputs(first, writing), by_rows=by_rows)
        self._renderer, self._graph, self._wanted, self._writing = renderer, graph, wanted, writing
        self._resume, self._progress, self._frames = resume, progress, frames
        self._reel = FrameRenderer(renderer, graph, wanted)
        self._hashes = FileHashes(sandbox=self._renderer.sandbox)
        self._sources = SourceFinder(renderer.pictures, graph, renderer.pictures.bind(graph, wanted.bound))
        self._behind = WriteQueue[FrameReport]()
        self._fault: HalationError | None = None
        self._reports: list[FrameReport] = []
        self._films = VideoWriters(writing, self._rate, renderer.sandbox)
        self._strips: ScanlineWriters | None = None
        self.videos: tuple[Path, ...] = ()
        self.seconds = {"compile": 0.0, "render": 0.0, "write": 0.0}

    def run(self) -> list[FrameReport]:
        if self._resume and self._writing.videos:
            raise UsageError(
                f"{self._writing.videos[0]}: a video is written anew as a whole: leave out --resume, or render "
                "numbered pictures, which can be kept"
            )
        if self._resume:
            for folder in {file.path.parent for files in self._files.values() for file in files}:
                remove_abandoned_files(folder)
        todo = deque(self._frames)
        task = self._plan_next(todo)
        if task is not None:
            self._renderer.runner.prepare(task.plan)
        following = self._plan_next(todo)
        while task is not None:
            kept, passes = self._render_frame(task, following)
            later = self._plan_next(todo)  # while the device is busy
            self._write(task, self._download(task, kept), passes)
            task, following = following, later
        for report in self._behind.collect_all():
            self._report_frame(report)
        if self._fault is not None:
            raise self._fault
        started = time.perf_counter()
        self.videos = self._films.finish()
        self.seconds["write"] += time.perf_counter() - started
        return sorted(self._reports, key=lambda report: self._frames.index(report.frame))

    def close(self) -> None:
        """Let what is being written come to its end."""
        self._behind.close()
        self._films.abort()
        if self._strips is not None:
            self._strips.abort()
        self._hashes.close()
        self._reel.close()

    @cached_property
    def _text(self) -> str:
        """The graph as files say it."""
        return dump_whole_graph(self._graph)

    # --- one frame ---------------------------------------------------------------------------------------------------

    def _plan_next(self, todo: deque[int]) -> _Task | None:
        """The next frame that must be rendered. One that cannot be made is the end: the ones before it can."""
        try:
            return self._find_unfinished(todo)
        except HalationError as error:
            self._fault = error
            todo.clear()
            return None

    def _find_unfinished(self, todo: deque[int]) -> _Task | None:
        while todo:
            frame, started = todo.popleft(), time.perf_counter()
            plan, files = self._reel.plan(frame), self._files[frame]
            reading = {item.node: item.picture for item in plan.uploads if not item.picture.in_memory}
            check_destinations(files, plan, reading, self._writing, sandbox=self._renderer.sandbox)
            task = _Task(frame, files, plan, self._sources.find(plan, frame, self._reel.history_start(frame)))
            self.seconds["compile"] += time.perf_counter() - started
            if self._resume and self._is_done(task):
                self._report_frame(FrameReport(frame, tuple(file.path for file in files), 0, kept=True))
                continue
            return task
        return None

    def _is_done(self, task: _Task) -> bool:
        """True if the files of a frame are there and would come out the same."""
        if not all(has_key(file, self._renderer.sandbox) for file in task.files):
            return False
        wanted = replace(self._wanted, frame=task.frame)
        keys = (
            compute_frame_key(self._text, wanted, task.plan, file, self._writing, task.sources, self._hashes)
            for file in task.files
        )
        return all(matches_key(file, key, self._renderer.sandbox) for file, key in zip(task.files, keys, strict=True))

    def _render_frame(self, task: _Task, following: _Task | None) -> tuple[Lease, int]:
        """Send a frame's passes to the device: what will hold the outputs, and how many passes they were."""
        started, passes = time.perf_counter(), 0
        self._hashes.begin(task.sources)
        kept = self._renderer.runner.lease()
        self._strips = ScanlineWriters(
            task.plan, task.files, self._writing, lambda file: self._make_header(task, file), self._renderer.sandbox
        )
        for run in self._reel.steps(task.frame, kept, following=following.frame if following else None):
            run.rows = self._strips.take
            with run:
                if following is not None:
                    self._renderer.runner.prepare(following.plan, {surface.key for surface in task.plan.surfaces})
                for done, one in enumerate(run, 1):
                    passes += 1
                    if self._progress is not None:
                        self._progress.report_pass(task.frame, done, run.total, one.nodes)
        self.seconds["render"] += time.perf_counter() - started
        return kept, passes

    def _download(self, task: _Task, kept: Lease) -> dict[str, Array]:
        """Wait for the outputs of a frame."""
        started = time.perf_counter()
        outputs = self._renderer.runner.download(task.plan, self._behind.arrays)
        kept.close()
        self.seconds["render"] += time.perf_counter() - started
        return outputs

    def _make_header(self, task: _Task, file: Destination) -> dict[str, Any]:
        """What a file says of itself."""
        wanted, device = replace(self._wanted, frame=task.frame), self._renderer.device
        said = make_header(
            self._text,
            device.target,
            wanted,
            self._reel.frames,
            self._writing,
            file,
            task.plan,
            task.sources,
            self._hashes,
        )
        said["halation:driver"] = device.driver
        return said

    def _write(self, task: _Task, outputs: Mapping[str, Array], passes: int) -> None:
        finished = self._strips.finish() if self._strips else frozenset[Path]()

        def write(outputs: Mapping[str, Array]) -> FrameReport:
            started = time.perf_counter()
            for file in task.files:
                if file.path in finished:
                    continue
                said = self._make_header(task, file)
                layers = {layer: outputs[name] for layer, name in file.layers.items()}
                if file.path in self._writing.videos:
                    self._films.add(file, layers, said)
                    continue
                media.write_picture(
                    file.path,
                    layers,
                    kinds=file.kinds,
                    precision=self._writing.precision,
                    compression=self._writing.compression,
                    metadata=said,
                    encoding=file.encoding,
                    sandbox=self._renderer.sandbox,
                )
            self.seconds["write"] += time.perf_counter() - started
            pictures = (file.path for file in task.files if file.path not in self._writing.videos)
            return FrameReport(task.frame, tuple(pictures), passes)

        self._behind.submit(write, outputs)
        for report in self._behind.collect_finished():
            self._report_frame(report)

    def _rate(self) -> float | Fraction:
        """Frames per second of what is written."""
        pictures = self._renderer.pictures
        return pictures.find_rate(self._graph, pictures.bind(self._graph, self._wanted.bound))

    def _report_frame(self, report: FrameReport) -> None:
        self._reports.append(report)
        if self._progress is not None:
            self._progress.report_frame(report, len(self._reports), len(self._frames))
