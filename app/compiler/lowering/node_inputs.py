"""A node with all that it reads, and what it may ask for beyond the graph."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from halation.nodes import ColorChange, Node, Render, Scene, Size
from msgspec import Struct, field

from ...resources.color_program import ColorProgram
from ...resources.mesh import Mesh
from ...resources.picture import Picture
from ..ir import Operand, PictureShape, Ref


class NodeInputs(Struct, frozen=True):
    """A node at a frame, and what it reads: inputs and wired values by name, and inputs at the frames it looks at."""

    path: str
    frame: int
    node: Node
    inputs: dict[str, Operand] = field(default_factory=dict[str, Operand])
    wires: dict[str, Operand] = field(default_factory=dict[str, Operand])
    at_frames: dict[tuple[str, int], Operand] = field(default_factory=dict[tuple[str, int], Operand])
    linked: set[str] = field(default_factory=set[str])


class NodeResources(Struct, frozen=True):
    """What a node names beyond the graph: pixels, changes of color, triangles, and what a render holds."""

    read: Callable[[Picture], Ref]
    recolor: Callable[[ColorChange], ColorProgram]
    mesh: Callable[[Scene], Mesh]
    render: Callable[[str, Mapping[str, str]], Render]
    asset: Callable[[Picture], Ref]


class DrawnPicture(Struct, frozen=True):
    """A draw's result: the `Drawn` that a node sees."""

    ref: Ref
    shape: PictureShape

    @property
    def size(self) -> Size:
        return self.shape.size
