"""The state of the render form, and the render that it describes. Draws nothing."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from halation.nodes import Kind
from msgspec import Struct, field
from msgspec.structs import replace

from ...authoring.render_queue.queue import QueuedFiles, QueuedRender, RenderJob
from ...authoring.render_queue.queued_files import list_entries
from ...errors import HalationError, UsageError
from ...graph import Graph
from ...graph.frames import (
    MOST_FRAMES,
    Pattern,
    add_frame_number,
    check_numbered,
    format_frames,
    is_video,
    parse_frames,
    remove_frame_number,
)
from ...language.translation import mark, translate
from ...media import PICTURE_ENDINGS
from ...media.sequences import find_sequence
from ...media.video.codecs import WRITABLE as VIDEO_ENDINGS
from ...media.video.library import load_pyav
from ...resources.render_choices import Dither
from ...resources.sandbox import Sandbox
from ...resources.user_folders import first_folder

if TYPE_CHECKING:
    from .context import RendersContext

Sizing = Literal["full size", "scale", "size"]
Extent = Literal["this frame", "all frames", "playback range", "listed frames", "many files"]
Depth = Literal["", "half", "float"]

DITHERS: tuple[tuple[Dither, str], ...] = (("blue", mark("blue noise")), ("none", mark("none: bands in dark ramps")))
DEPTHS: tuple[tuple[Depth, str], ...] = (
    ("", mark("default of the format")),
    ("half", mark("16 bit")),
    ("float", mark("32 bit (16 in PNG and TIFF)")),
)
_OTHER_ENDINGS = (".jpeg", ".tiff", ".m4v")
"""Second names of formats, which need not be offered."""

FILE_STEM = "{stem}"
"""The place for the name of a file without its ending, in the name of what is written for it."""

_FRESH = 1.0
"""Seconds for which the last look at the disk is reused."""


class RenderTargets(Struct, frozen=True):
    """The files that a render would write, how many of them `exist`, or why it is impossible."""

    files: int = 0
    first: str = ""
    last: str = ""
    exist: int = 0
    fault: str = ""


class RenderForm(Struct):
    """The choices of the form. `files` are the typed paths by output; "" takes the suggestion."""

    context: RendersContext
    chosen: dict[str, bool] = field(default_factory=dict[str, bool])
    files: dict[str, str] = field(default_factory=dict[str, str])
    format: str = ".exr"
    sizing: Sizing = "full size"
    scale: float = 0.5
    size: tuple[int, int] = (1920, 1080)
    precision: Depth = ""
    view: str = ""
    dither: Dither = "blue"
    extent: Extent | None = None
    """The chosen frames; None for all frames if there are several."""
    listed: str = ""
    """The typed frames."""
    many: QueuedFiles = field(default_factory=lambda: QueuedFiles(""))
    """The typed files that the graph is rendered for, one after the other, and the input that they fill."""
    jobs: int = 1
    cluster: str = ""
    """The typed address of a cluster."""
    resume: bool = False
    _seen: tuple[object, float, RenderTargets] = (None, 0.0, RenderTargets())

    # --- frames ------------------------------------------------------------------------------------------------------

    def extents(self) -> dict[Extent, tuple[int, ...]]:
        """The choices of frames. Listed frames are empty while the text is invalid; many files have their own."""
        session = self.context.session
        first, last = session.time.frames
        extents: dict[Extent, tuple[int, ...]] = {"this frame": (session.time.frame,)}
        if first < last < first + MOST_FRAMES:
            extents["all frames"] = tuple(range(first, last + 1))
            low, high = self.context.timeline.span(session)
            if (low, high) != (first, last):
                extents["playback range"] = tuple(range(low, high + 1))
        extents["listed frames"] = _parse_listed(self.listed)[0]
        if self.list_file_inputs():
            extents["many files"] = ()
        return extents

    def list_file_inputs(self) -> tuple[str, ...]:
        """The inputs of the graph that many files can fill: those of pictures."""
        inputs = self.context.session.root.inputs
        return tuple(name for name, end in inputs.items() if not end.kind.is_single)

    def extent_of(self) -> Extent:
        """The chosen one of the `extents`."""
        offered = self.extents()
        usual: Extent = "all frames" if "all frames" in offered else "this frame"
        return self.extent if self.extent in offered else usual

    def frames(self) -> tuple[int, ...]:
        """The frames to render; none while the typed text is invalid."""
        return self.extents()[self.extent_of()]

    def extend(self, extent: Extent) -> None:
        """Choose other frames. Typed file names get a frame number if they need one."""
        if extent == "listed frames" and not self.listed:
            self.listed = format_frames(self.frames())
        if self.has_many_files != (extent == "many files"):
            self.files.clear()
        self.extent = extent
        if extent not in ("this frame", "many files"):
            self.files = {name: _add_number(path) if path else "" for name, path in self.files.items()}

    @property
    def list_fault(self) -> str:
        """Why the typed frames are invalid, "" if they are valid."""
        return _parse_listed(self.listed)[1]

    @property
    def has_many_files(self) -> bool:
        """True if the graph is rendered once for each of many files."""
        return self.extent_of() == "many files"

    # --- files -------------------------------------------------------------------------------------------------------

    def suggest_file(self, output: str) -> Path:
        """The suggested file of an output."""
        last = self.context.store.folder("export")
        session = self.context.session
        folder = Path(last) if last else session.path.absolute().parent if session.path else first_folder()
        if self.has_many_files:
            return folder / (
                f"{FILE_STEM}{self.format}" if len(session.root.outputs) == 1 else f"{FILE_STEM}_{output}{self.format}"
            )
        name = session.name if len(session.root.outputs) == 1 else f"{session.name}_{output}"
        plain = f"{name}{self.format}"
        return folder / (plain if self.extent_of() == "this frame" else _add_number(plain))

    def file(self, output: str) -> Path:
        """The file of an output."""
        typed = self.files.get(output, "")
        return Path(typed).expanduser() if typed else self.suggest_file(output)

    def list_chosen_outputs(self) -> tuple[str, ...]:
        """The chosen outputs; at first all that are pictures."""
        kinds = {name: output.kind for name, output in self.context.session.root.outputs.items()}
        return tuple(name for name, kind in kinds.items() if self.chosen.get(name, kind in (Kind.IMAGE, Kind.FIELD)))

    def reform(self, format: str) -> None:
        """Set the format of all files; the name of a video has no frame number."""
        self.format = format
        named = {name: str(Path(path).with_suffix(format)) for name, path in self.files.items() if path}
        self.files = {name: remove_frame_number(path) if is_video(path) else path for name, path in named.items()}

    def number(self) -> None:
        """Add a frame number to the names of all files."""
        self.files = {name: _add_number(str(self.file(name))) for name in self.list_chosen_outputs()}

    # --- all together ------------------------------------------------------------------------------------------------

    def targets(self, time_now: float) -> RenderTargets:
        """The files that would be written; the disk is read again after a second, or when the choices change."""
        if self.has_many_files:
            return self._find_many_targets(time_now)
        frames = self.frames()
        paths = tuple(dict.fromkeys(str(self.file(name)) for name in self.list_chosen_outputs()))
        key = paths, frames, self.list_fault if not frames else ""
        if self._seen[0] != key or time_now - self._seen[1] > _FRESH:
            self._seen = (key, time_now, find_targets(paths, frames, key[2], self.context.session.sandbox))
        return self._seen[2]

    def _find_many_targets(self, time_now: float) -> RenderTargets:
        session = self.context.session
        destinations = self._list_destinations()
        bindings = {name: str(item) for name, item in session.bindings.items()}
        key = destinations, self.many, session.root, tuple(bindings.items())
        if self._seen[0] != key or time_now - self._seen[1] > _FRESH:
            targets = find_many_targets(session.root, self.many, destinations, bindings, session.sandbox)
            self._seen = (key, time_now, targets)
        return self._seen[2]

    def _list_destinations(self) -> tuple[tuple[str, Path], ...]:
        return tuple((name, self.file(name)) for name in self.list_chosen_outputs())

    def options(self) -> RenderJob:
        """The choices as options of the render."""
        frames = self.frames()
        job = RenderJob(
            sandbox=self.context.session.sandbox,
            frames=frames,
            precision=self.precision or None,
            view=self.view,
            dither=self.dither,
            resume=self.resume and not any(is_video(str(self.file(name))) for name in self.list_chosen_outputs()),
            processes=self.jobs if (len(frames) > 1 or self.has_many_files) and not self.cluster else 1,
        )
        if self.sizing == "scale":
            return replace(job, scale=self.scale)
        return replace(job, size=self.size) if self.sizing == "size" else job

    def start(self) -> QueuedRender:
        """Add the render to the queue. Raises UsageError or GraphError."""
        files = self._list_destinations()
        if not self.frames() and not self.has_many_files:
            raise UsageError(self.list_fault)
        render = self.context.exports.start(
            self.context.session.root,
            files,
            dict(self.context.session.bindings),
            self.options(),
            files=self.many if self.has_many_files else None,
            cluster=self.cluster,
        )
        if files and "{" not in str(files[0][1].parent):
            self.context.store.note_folder("export", files[0][1])
        self._seen = (None, 0.0, RenderTargets())
        return render


def formats() -> tuple[str, ...]:
    """The formats to choose from; those of videos only if PyAV is installed."""
    endings = (*PICTURE_ENDINGS, *VIDEO_ENDINGS) if load_pyav() is not None else PICTURE_ENDINGS
    return tuple(ending for ending in endings if ending not in _OTHER_ENDINGS)


@lru_cache(maxsize=8)
def _parse_listed(text: str) -> tuple[tuple[int, ...], str]:
    """The frames in a text, and why it is invalid."""
    try:
        return parse_frames(text), ""
    except UsageError as fault:
        return (), str(fault)


def _add_number(path: str) -> str:
    """The path with a frame number, unless it has one or needs none."""
    try:
        return path if is_video(path) or Pattern.parse(path) else add_frame_number(path)
    except UsageError:
        return path


def find_targets(paths: tuple[str, ...], frames: tuple[int, ...], fault: str, sandbox: Sandbox) -> RenderTargets:
    """The files that a render would write, and how many of them exist."""
    if fault or not paths:
        return RenderTargets(fault=fault or translate("Choose an output to render."))
    try:
        for path in paths:
            check_numbered(path, frames)
        names = [_at(path, frame) for path, frame in ((paths[0], frames[0]), (paths[-1], frames[-1]))]
        exist = sum(_count_existing(path, frames, sandbox) for path in paths)
    except HalationError as error:
        return RenderTargets(fault=str(error))
    count = sum(1 if is_video(path) else len(frames) for path in paths)
    return RenderTargets(count, names[0], names[1], exist)


def find_many_targets(
    graph: Graph,
    many: QueuedFiles,
    destinations: tuple[tuple[str, Path], ...],
    bindings: Mapping[str, str],
    sandbox: Sandbox,
) -> RenderTargets:
    """The files that a render of many files would write. The frames of sequences are not counted."""
    if not destinations:
        return RenderTargets(fault=translate("Choose an output to render."))
    try:
        entries = list_entries(graph, many, destinations, bindings, sandbox)
    except HalationError as error:
        return RenderTargets(fault=str(error))
    paths = [path for entry in entries for _, path in entry.destinations]
    exist = sum(os.path.isfile(path) for path in paths)  # noqa: PTH113 - False for a path that no system allows
    return RenderTargets(len(paths), paths[0], paths[-1], exist)


def _at(path: str, frame: int) -> str:
    pattern = Pattern.parse(path)
    return pattern.name(frame) if pattern else path


def _count_existing(path: str, frames: tuple[int, ...], sandbox: Sandbox) -> int:
    """The number of files that exist."""
    if Pattern.parse(path) is None or len(frames) == 1:
        return int(os.path.isfile(_at(path, frames[0])))  # noqa: PTH113 - False for a path that no system allows
    sequence = find_sequence(path, sandbox=sandbox)
    return len(sequence.names.keys() & set(frames)) if sequence else 0
