"""What lowering a graph came to, node by node, so that another graph much like it need not be lowered as a whole."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import CameraModel, ColorChange, ColorSettings, Missing, Render, Scene, Size
from msgspec import Struct, field

from ...graph import Port
from ...resources.color_program import ColorProgram
from ...resources.mesh import Mesh
from ...resources.picture import Picture
from ...resources.provider import FrameFile, PictureProbe, ResourceProvider
from ...resources.working_space import WorkingSpace
from ..ir import Builder, LoweredProgram, Operand, Ref
from ..library import Library
from .moments import Moments

PortAtOffset = tuple[Port, int]
"""A port, so many frames after the one that is rendered."""

StepKey = tuple[str, int] | None
"""A node, so many frames after the one that is rendered; None stands for the outputs."""


class LoweringStep(Struct):
    """What lowering one node at a frame came to. `first` is how many operations there were before."""

    first: int
    added: list[int]
    """The operations that it added, in order, also those that were there."""
    inspected: list[int]
    """Operations of other nodes that it did not only read: these decided what it added."""
    results: dict[PortAtOffset, Operand] = field(default_factory=dict[PortAtOffset, Operand])
    cameras: dict[Port, CameraModel] = field(default_factory=dict[Port, CameraModel])
    memories: dict[Port, Ref] = field(default_factory=dict[Port, Ref])
    reads_outside: bool = False
    """True if something beyond the graph decided, which may be another thing the next time."""
    reads_frame: bool = False
    """True if the number of the frame decided."""


class LoweringRecord(Struct, frozen=True, weakref=True):
    """A program, and how it came to be."""

    program: LoweredProgram
    library: Library
    moments: Moments
    frame: int
    builder: Builder
    steps: Mapping[StepKey, LoweringStep]
    results: Mapping[PortAtOffset, Operand]
    counts: Mapping[int, int]
    """How often each operation was added."""
    canvas: Size | None
    """None where nothing depends on it."""


class WatchedProvider:
    """The resources beyond the graph; `is_read` tells whether any was asked for."""

    def __init__(self, outside: ResourceProvider) -> None:
        self._outside = outside
        self.is_read = False

    def at(self, path: str, frame: int, missing: Missing) -> FrameFile:
        return self._note_read().at(path, frame, missing)

    def probe(self, picture: Picture) -> PictureProbe:
        return self._note_read().probe(picture)

    def recolor(self, change: ColorChange) -> ColorProgram:
        return self._note_read().recolor(change)

    def working(self, color: ColorSettings) -> WorkingSpace | None:
        return self._note_read().working(color)

    def render(self, path: str, named: Mapping[str, str]) -> Render:
        return self._note_read().render(path, named)

    def mesh(self, scene: Scene) -> Mesh:
        return self._note_read().mesh(scene)

    def _note_read(self) -> ResourceProvider:
        self.is_read = True
        return self._outside
