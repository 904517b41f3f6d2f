"""One item of a job while its frames are planned, rendered and written: where they go, and what they read."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec import Struct
from msgspec.structs import replace

from ... import media
from ...compiler import Plan
from ...errors import HalationError, UsageError
from ...graph import Graph
from ...resources.atomic_write import remove_abandoned_files
from ..engine import Renderer, RenderRequest
from ..execution.decoding import Array
from ..frame_renderer import FrameRenderer
from .destinations import (
    Destination,
    OutputSettings,
    check_destinations,
    choose_views,
    create_folders,
    find_frames,
    plan_destinations,
    select_half_outputs,
    select_whole_outputs,
)
from .header import compute_frame_key, has_key, make_header, matches_key
from .reports import FrameReport, ItemReport
from .scanline_writers import ScanlineWriters, select_row_outputs
from .shared_results import SharedResults, StoredMemory
from .source_files import FileHashes, SourceFile, SourceFinder
from .video_writers import VideoWriters

if TYPE_CHECKING:
    from fractions import Fraction


class SharedHistory(Struct, frozen=True):
    """What other processes have rendered of an item: their results, and what `frame` has stored for the next one."""

    results: SharedResults
    frame: int = 0
    memories: tuple[StoredMemory, ...] = ()


class JobItem(Struct, frozen=True):
    """What a job renders for one name: frames of a graph, and the files that they go into."""

    name: str
    graph: Graph
    request: RenderRequest
    settings: OutputSettings
    frames: tuple[int, ...]
    creates_folders: bool = False
    """True if folders that its files go into are created."""
    graph_text: str = ""
    """The text of the graph in headers, where `graph` has paths of another machine; "" for that of `graph`."""
    history: SharedHistory | None = None
    todo: deque[int] | None = None
    """Those of the frames that nobody has begun, where others render some of them and take them from its right end."""


class FrameTask(Struct, frozen=True):
    """One frame: its files, its plan, and the files that it reads."""

    session: ItemSession
    frame: int
    files: tuple[Destination, ...]
    plan: Plan
    sources: tuple[SourceFile, ...]


class ItemSession:
    """Plans the frames of an item, and writes their files. `graph_text` is that of `dump_whole_graph`.

    `fault` is the first error; no further frame is planned after it. `unfinished_tasks` counts the frames that are
    planned and neither written nor given up. An item is stopped if frames that are planned are given up too, and
    settled when it is reported.
    """

    def __init__(self, renderer: Renderer, item: JobItem, graph_text: str, hashes: FileHashes, resume: bool) -> None:
        self._files = plan_destinations(item.graph, item.request, item.settings, item.frames, renderer.sandbox)
        first = self._files[item.frames[0]]
        by_rows = select_row_outputs(first) if renderer.device.target.memory else frozenset[str]()
        self._request = replace(
            item.request,
            halves=select_half_outputs(first, item.settings),
            by_rows=by_rows,
            whole=select_whole_outputs(item.graph, item.request, first),
        )
        self.item, self._renderer, self._graph_text, self._hashes = item, renderer, graph_text, hashes
        self.frame_renderer = self._open_frame_renderer()
        bound = renderer.pictures.bind(item.graph, self._request.bound_inputs)
        self._sources = SourceFinder(renderer.pictures, item.graph, bound)
        self._video_writers = VideoWriters(item.settings, self._find_rate, renderer.sandbox)
        self._resume = resume
        self.todo = deque(item.frames) if item.todo is None else item.todo
        self.unfinished_tasks = 0
        self.is_stopped = self.is_settled = False
        self.fault: HalationError | None = None
        self.reports: list[FrameReport] = []
        self._views: dict[str, str] = {}
        self._data_outputs = tuple(dict.fromkeys(name for file in first for name in file.data_outputs))
        self._prepare_folders()

    def plan_task(self, frame: int) -> FrameTask:
        """Compile a frame and check its files. Raises the errors of `app.errors`."""
        plan = self.frame_renderer.plan_frame(frame)
        sources = {upload.node: upload.picture for upload in plan.uploads if not upload.picture.in_memory}
        files = choose_views(self._files[frame], plan, self._renderer.pictures)
        for planned, file in zip(self._files[frame], files, strict=True):
            self._views |= dict.fromkeys(file.layers.values(), file.view) if file.view != planned.view else {}
        check_destinations(files, plan, sources, self.item.settings, sandbox=self._renderer.sandbox)
        begin = self.frame_renderer.find_history_start(frame)
        return FrameTask(self, frame, files, plan, self._sources.find_sources(plan, frame, begin))

    def plan_coming(self, task: FrameTask) -> Plan | None:
        """The plan of the frame after another one, which is not rendered here; None if it cannot be or has a history.

        What both share may stay for whoever renders it.
        """
        if task.plan.memories or self.item.history:
            return None
        try:
            return self.frame_renderer.plan_frame(task.frame + 1)
        except HalationError:  # it is told where the frame is rendered, if it ever is
            return None

    def has_files(self, frame: int) -> bool:
        """True if all files of a frame are there, whatever they hold."""
        return all(file.path.is_file() for file in self._files[frame])

    def find_kept_frame(self, task: FrameTask) -> FrameReport | None:
        """The report of a frame whose files exist and are up to date; None for a frame to be rendered."""
        if not self._resume or not all(has_key(file, self._renderer.sandbox) for file in task.files):
            return None
        request, settings = replace(self._request, frame=task.frame), self.item.settings
        for file in task.files:
            key = compute_frame_key(self._graph_text, request, task.plan, file, settings, task.sources, self._hashes)
            if not matches_key(file, key, self._renderer.sandbox):
                return None
        return FrameReport(task.frame, tuple(file.path for file in task.files), 0, is_kept=True)

    def open_row_writers(self, task: FrameTask) -> ScanlineWriters:
        """The writers of those files of a frame that are written by rows while it is rendered."""
        return ScanlineWriters(
            task.plan,
            task.files,
            self.item.settings,
            lambda file: self._make_header(task, file),
            self._renderer.sandbox,
        )

    def write_files(self, task: FrameTask, outputs: Mapping[str, Array], files_by_rows: frozenset[Path]) -> None:
        """Write the files of a frame that are not written by rows.

        Runs on a thread of the write queue. Raises OutputError.
        """
        settings = self.item.settings
        for file in task.files:
            if file.path in files_by_rows:
                continue
            header = self._make_header(task, file)
            layers = {layer: outputs[name] for layer, name in file.layers.items()}
            frames = find_frames(file, task.plan)
            if file.path in settings.videos:
                layers = {layer: media.cut_to_frame(array, frames.get(layer)) for layer, array in layers.items()}
                self._video_writers.add_frame(file, layers, task.frame, header)
                continue
            media.write_picture(
                file.path,
                layers,
                kinds=file.kinds,
                precision=settings.precision,
                compression=settings.compression,
                metadata=header,
                encoding=file.encoding,
                frame=task.frame,
                frames=frames,
                sandbox=self._renderer.sandbox,
            )

    def describe_frame(self, task: FrameTask, passes: int) -> FrameReport:
        """The report of a frame whose files are written."""
        pictures = (file.path for file in task.files if file.path not in self.item.settings.videos)
        return FrameReport(task.frame, tuple(pictures), passes)

    @property
    def is_complete(self) -> bool:
        """True if all frames are finished or given up."""
        return not self.todo and not self.unfinished_tasks

    def give_up(self, fault: HalationError) -> None:
        """Plan no more frames, because of an error. The first one counts."""
        self.fault = self.fault or fault
        self.todo.clear()

    def finish(self) -> ItemReport:
        """Complete the videos, and report."""
        videos: tuple[Path, ...] = ()
        try:
            videos = () if self.fault else self._video_writers.finish()
        except HalationError as fault:
            self.give_up(fault)
        self._video_writers.abort()
        frames = tuple(sorted(self.reports, key=lambda report: self.item.frames.index(report.frame)))
        return ItemReport(self.item.name, frames, videos, self._views, self._data_outputs, self.fault)

    def abort(self) -> None:
        """Remove incomplete videos, and release what the frames share."""
        self._video_writers.abort()
        self.frame_renderer.close()

    def _open_frame_renderer(self) -> FrameRenderer:
        history = self.item.history
        store = history.results if history else None
        frame_renderer = FrameRenderer(self._renderer, self.item.graph, self._request, store)
        if history and history.memories:
            frame_renderer.note_history(history.frame, {item.port: item.memory for item in history.memories})
        return frame_renderer

    def _prepare_folders(self) -> None:
        """Create the folders of the files, or find fault with them, before anything is rendered."""
        if self.item.creates_folders:
            create_folders(self._files, self._renderer.sandbox)
        if not self._resume:
            return
        if self.item.settings.videos:
            raise UsageError(
                f"{self.item.settings.videos[0]}: a video is written anew as a whole: leave out --resume, or render "
                "numbered pictures, which can be kept"
            )
        for folder in {file.path.parent for files in self._files.values() for file in files}:
            remove_abandoned_files(folder)

    def _make_header(self, task: FrameTask, file: Destination) -> dict[str, Any]:
        """The metadata of a file."""
        device = self._renderer.device
        metadata = make_header(
            self._graph_text,
            device.target,
            replace(self._request, frame=task.frame),
            self.frame_renderer.frames,
            self.item.settings,
            file,
            task.plan,
            task.sources,
            self._hashes,
        )
        metadata["halation:driver"] = device.driver
        return metadata

    def _find_rate(self) -> float | Fraction:
        """The frames per second of videos."""
        pictures = self._renderer.pictures
        return pictures.find_rate(self.item.graph, pictures.bind(self.item.graph, self._request.bound_inputs))
