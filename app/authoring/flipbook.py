"""Flipbooks: one or two sequences of finished pictures, played in place of the document.

A flipbook is a session of its own, with a graph that does nothing but read them: whatever shows a document shows it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

from halation.nodes import catalogue
from msgspec import Struct

from .. import document
from ..errors import InputError
from ..graph import OUTPUTS, Graph, Output, Port
from ..graph.frames import Pattern
from ..graph.names import fresh_name, name_fault
from ..language.translation import translate
from ..media.sequences import find_sequence, suggest_pattern
from ..resources.sandbox import UNRESTRICTED, Sandbox
from .render_queue.queue import QueuedRender
from .session import Session

SIDES: tuple[Literal["A", "B"], ...] = ("A", "B")
_ENCODED = frozenset({".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".gif", ".bmp"})
"""Formats whose pictures have been through a view already."""


class FlipbookStrip(Struct, frozen=True):
    """Pictures that are played: a path with a place for the frame, or a single one; `view` shows what is in EXR files.

    `export` is the render that writes them.
    """

    path: Path
    frames: tuple[int, int]
    view: str = ""
    export: QueuedRender | None = None

    @property
    def name(self) -> str:
        """The name of the strip."""
        return self.path.name

    @staticmethod
    def from_render(export: QueuedRender) -> FlipbookStrip:
        """What a render has written so far, or will have."""
        output, path = export.destinations[0]
        outputs = export.job.graph.outputs
        graph_output = outputs.get(output or next(iter(outputs), ""))
        frames = export.job.order.frames or _list_disk_frames(path, export.job.order.sandbox) or (1,)
        return FlipbookStrip(path, (min(frames), max(frames)), graph_output.view if graph_output else "", export)

    @staticmethod
    def from_file(path: Path, sandbox: Sandbox) -> FlipbookStrip:
        """The sequence that a file on the disk belongs to, else that picture alone. Raises InputError, UsageError."""
        path = Path(suggest_pattern(str(path), sandbox=sandbox) or path)
        frames = _list_disk_frames(path, sandbox=sandbox)
        if not frames:
            raise InputError(translate("{path}: this picture does not exist", path=path))
        return FlipbookStrip(path, (frames[0], frames[-1]))


class Flipbook:
    """A flipbook that is open: `session` is what the viewer shows meanwhile."""

    def __init__(self, strips: Sequence[FlipbookStrip], rate: float, frame: int, watched: Port | None = None) -> None:
        self.strips = tuple(strips[: len(SIDES)])
        self.watched = watched
        """What the document showed: where that changes, the flipbook has had its time."""
        self.session = _make_session(self.strips, rate, frame)
        self._seen = self._state

    def follow(self, cached: Iterable[int]) -> bool:
        """Update the strips; True if files of `cached` frames have changed and must be read again."""
        states = self._state
        if states == self._seen:
            return False
        ended = any(new[1] != old[1] for new, old in zip(states, self._seen, strict=True))
        written = {frame for new, old in zip(states, self._seen, strict=True) for frame in new[0] - old[0]}
        self._seen = states
        return ended or not written.isdisjoint({self.session.time.frame, *cached})

    @property
    def _state(self) -> tuple[tuple[frozenset[int], bool], ...]:
        """For every strip, the frames that are written, and whether its render has ended."""
        return tuple(
            (_list_written_frames(strip), strip.export is None or strip.export.ended_at > 0.0) for strip in self.strips
        )


def _list_written_frames(strip: FlipbookStrip) -> frozenset[int]:
    pattern = Pattern.parse(str(strip.path)) if strip.export else None
    if pattern is None or strip.export is None:
        return frozenset()
    frames = (pattern.frame(path.name) for path in strip.export.written_files)
    return frozenset(frame for frame in frames if frame is not None)


def _make_session(strips: Sequence[FlipbookStrip], rate: float, frame: int) -> Session:
    graph = Graph()
    names: list[str] = []
    for strip in strips:
        pattern = Pattern.parse(strip.name)
        stem = (pattern.pieces[0] if pattern else strip.path.stem).strip("._- ").replace(".", "_")
        name = fresh_name("pictures" if name_fault(stem, "output") else stem, names)
        names.append(name)
        view = "none" if strip.path.suffix.lower() in _ENCODED else strip.view
        reader: Any = catalogue()["read_image"]
        node = f"flipbook: {name}"  # no node of the document has this name
        graph = graph.add(node, reader(path=str(strip.path), missing="hold"))
        graph = graph.add_output(name, Output(view=view)).connect(Port(node, "out"), Port(OUTPUTS, name))
    first, last = min(strip.frames[0] for strip in strips), max(strip.frames[1] for strip in strips)
    graph = replace(graph, settings=replace(graph.settings, frames=(first, last), rate=rate))
    session = Session(sandbox=UNRESTRICTED)
    session.files.open_text(document.dumps(graph))
    for side, name in zip(SIDES, names, strict=False):
        session.views.show(Port(OUTPUTS, name), side)
    session.time.seek(min(max(frame, first), last))
    return session


def _list_disk_frames(path: Path, sandbox: Sandbox) -> tuple[int, ...]:
    """The frames that are on the disk; a picture alone is the first."""
    sequence = find_sequence(str(path), sandbox=sandbox)
    return (1,) if sequence is None and path.is_file() else sequence.frames if sequence else ()
