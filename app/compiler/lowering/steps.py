"""Records of lowering, node by node, from which an edited graph is lowered without starting again."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import CameraModel, ColorChange, ColorSettings, Missing, Render, Scene, Size, TextBlock, TypesetText
from msgspec import Struct, field

from ...graph import Port
from ...resources.color_program import ColorProgram
from ...resources.mesh import Mesh
from ...resources.picture import Picture
from ...resources.provider import FrameFile, PictureProbe, ResourceProvider
from ...resources.working_space import WorkingSpace
from ..ir import Builder, LoweredProgram, Operand, Ref
from ..library import Library
from .graph_at_frames import GraphAtFrames

PortAtOffset = tuple[Port, int]
"""A port, and how many frames after the rendered one it is read."""

StepKey = tuple[str, int] | None
"""The path of a node, and how many frames after the rendered one it is lowered; None stands for the outputs."""


_AS_FIELD = " as Field"


def field_port(port: Port) -> Port:
    """The key of the Field that an output has besides its Image, since it follows an input that is fed a Field.

    No socket can have this name.
    """
    return Port(port.node, f"{port.socket}{_AS_FIELD}")


def is_field_port(port: Port) -> bool:
    """True for a key that `field_port` made."""
    return port.socket.endswith(_AS_FIELD)


class LoweringStep(Struct):
    """What lowering one node at a frame added. `first` is how many operations there were before."""

    first: int
    added: list[int]
    """The operations that it added, in order, including equal ones that were there already."""
    inspected: list[int]
    """Operations of other nodes whose content, not only their shape, decided what it added."""
    results: dict[PortAtOffset, Operand] = field(default_factory=dict[PortAtOffset, Operand])
    cameras: dict[Port, CameraModel] = field(default_factory=dict[Port, CameraModel])
    memories: dict[Port, Ref] = field(default_factory=dict[Port, Ref])
    reads_resources: bool = False
    """True if a file or a memory of an earlier frame decided what it added: these may differ the next time."""
    reads_frame: bool = False
    """True if the number of the frame decided what it added."""
    reads_other_times: bool = False
    """True if values of the node at other times than the frame decided what it added."""
    length_height: float = 0.0
    """The height that lengths of the node are fractions of, in pixels."""
    whole_height: float = 0.0
    """The height of the picture that the result was cut out of, in pixels of the result; 0 if it is whole."""


class LoweringRecord(Struct, frozen=True, weakref=True):
    """A program, and the steps that lowered it."""

    program: LoweredProgram
    library: Library
    frames: GraphAtFrames
    frame: int
    builder: Builder
    steps: Mapping[StepKey, LoweringStep]
    results: Mapping[PortAtOffset, Operand]
    counts: Mapping[int, int]
    """How often each operation was added."""
    canvas: Size | None
    """The size of generated pictures; None if no operation depends on it."""


class WatchedProvider:
    """A provider that notes in `is_read` whether anything was asked of it."""

    def __init__(self, provider: ResourceProvider) -> None:
        self._provider = provider
        self.is_read = False

    def find_frame_file(self, path: str, frame: int, missing: Missing) -> FrameFile:
        return self._note_read().find_frame_file(path, frame, missing)

    def probe_picture(self, picture: Picture) -> PictureProbe:
        return self._note_read().probe_picture(picture)

    def write_color_program(self, change: ColorChange) -> ColorProgram:
        return self._note_read().write_color_program(change)

    def find_working_space(self, color: ColorSettings) -> WorkingSpace | None:
        return self._note_read().find_working_space(color)

    def describe_render(self, path: str, named: Mapping[str, str]) -> Render:
        return self._note_read().describe_render(path, named)

    def load_mesh(self, scene: Scene) -> Mesh:
        return self._note_read().load_mesh(scene)

    def typeset(self, block: TextBlock) -> TypesetText:
        return self._note_read().typeset(block)

    def read_attributes(self, path: str) -> Mapping[str, str]:
        return self._note_read().read_attributes(path)

    def _note_read(self) -> ResourceProvider:
        self.is_read = True
        return self._provider
