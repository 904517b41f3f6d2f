"""What lowering a graph comes to, node by node, so that another graph much like it need not be lowered as a whole."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import Camera, ColorChange, ColorSettings, Missing, Render, Scene, Size
from msgspec import Struct, field

from ...graph import Port
from ...resources.color_program import ColorProgram
from ...resources.mesh import Mesh
from ...resources.picture import Picture
from ...resources.provider import FrameFile, PictureProbe, ResourceProvider
from ...resources.working_space import WorkingSpace
from ..ir import Builder, Operand, Program, Ref
from ..library import Library
from .moments import Moments

Shown = tuple[Port, int]
"""A port, so many frames after the one that is wanted."""

Place = tuple[str, int] | None
"""A node, so many frames after the one that is wanted; None stands for what outputs show."""


class Step(Struct):
    """What lowering one node at a frame came to. `first` is how many operations there were before."""

    first: int
    added: list[int]
    """The operations that it added, in order, also those that were there."""
    looked: list[int]
    """Operations of others that it did not only read: these decided what it added."""
    shown: dict[Shown, Operand] = field(default_factory=dict[Shown, Operand])
    cameras: dict[Port, Camera] = field(default_factory=dict[Port, Camera])
    memories: dict[Port, Ref] = field(default_factory=dict[Port, Ref])
    asked: bool = False
    """True if something beyond the graph decided, which may be another thing the next time."""
    timed: bool = False
    """True if the number of the frame decided."""


class Lowered(Struct, frozen=True, weakref=True):
    """A program, and how it came to be."""

    program: Program
    library: Library
    moments: Moments
    now: int
    builder: Builder
    steps: Mapping[Place, Step]
    results: Mapping[Shown, Operand]
    counts: Mapping[int, int]
    """How often each operation was added."""
    canvas: Size | None
    """None where nobody asked for it."""


class Watched:
    """The world beyond the graph; it says whether it was `asked` anything."""

    def __init__(self, outside: ResourceProvider) -> None:
        self._outside = outside
        self.asked = False

    def at(self, path: str, frame: int, missing: Missing) -> FrameFile:
        return self._seen().at(path, frame, missing)

    def probe(self, picture: Picture) -> PictureProbe:
        return self._seen().probe(picture)

    def recolor(self, change: ColorChange) -> ColorProgram:
        return self._seen().recolor(change)

    def working(self, color: ColorSettings) -> WorkingSpace | None:
        return self._seen().working(color)

    def render(self, path: str, named: Mapping[str, str]) -> Render:
        return self._seen().render(path, named)

    def mesh(self, scene: Scene) -> Mesh:
        return self._seen().mesh(scene)

    def _seen(self) -> ResourceProvider:
        self.asked = True
        return self._outside
