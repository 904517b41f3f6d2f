"""What one node reads while it is lowered: its inputs, and the files that it names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from halation.nodes import CameraModel, ColorChange, Kind, Node, Render, Scene, Size, Socket, TextBlock, TypesetText
from msgspec import Struct, field

from ...graph import Port
from ...resources.color_program import ColorProgram
from ...resources.mesh import Mesh
from ...resources.picture import Picture
from ..ir import Operand, PictureShape, PlannedObject, Ref

if TYPE_CHECKING:
    from .text_tokens import TextClock


class NodeInputs(Struct, frozen=True):
    """A node at a frame, and what it reads: inputs and wired values by name, and inputs at the frames it looks at.

    `linked` are the inputs that something is linked to, in the order in which the node declares them. Operations are
    added in that order, so it must not be a set: the order of a set of strings is another one in every process.
    `narrow` is the Image input that is fed a Field and keeps its one channel; "" if there is none.
    """

    path: str
    frame: int
    node: Node
    inputs: dict[str, Operand] = field(default_factory=dict[str, Operand])
    wires: dict[str, Operand] = field(default_factory=dict[str, Operand])
    at_frames: dict[tuple[str, int], Operand] = field(default_factory=dict[tuple[str, int], Operand])
    linked: list[str] = field(default_factory=list[str])
    narrow: str = ""


class NodeResources(Struct, frozen=True):
    """What a node can read from files: pixels, color programs, meshes, the contents of a render, and text in a font;
    and in its own animation: its values at another time."""

    read_picture: Callable[[Picture], Ref]
    write_color_program: Callable[[ColorChange], ColorProgram]
    load_mesh: Callable[[Scene], Mesh]
    describe_render: Callable[[str, Mapping[str, str]], Render]
    read_asset: Callable[[Picture], Ref]
    typeset: Callable[[TextBlock], TypesetText]
    expand_text: Callable[[TextClock, str, Socket], str]
    find_settings: Callable[[float], Mapping[str, Any]]


class DrawnPicture(Struct, frozen=True):
    """A draw's result: the `Drawn` that a node sees. `is_narrow` if it stands for a picture, but has one channel."""

    ref: Ref
    shape: PictureShape
    is_narrow: bool = False

    @property
    def size(self) -> Size:
        return self.shape.size


def takes_field(socket: Socket) -> bool:
    """True for a socket that reads the Field of an output that carries both an Image and a Field."""
    return socket.kind in (Kind.FIELD, Kind.VECTOR)


def find_cameras(inputs: NodeInputs) -> dict[Port, CameraModel]:
    """The cameras that are linked to the inputs of a node."""
    return {
        Port(inputs.path, name): operand.content
        for name in inputs.linked
        if isinstance(operand := inputs.inputs[name], PlannedObject) and isinstance(operand.content, CameraModel)
    }
