"""The operations that a graph is lowered to: static single assignment, one entry per thing to compute.

Operations are values: two that are equal compute the same pixels, so adding one twice gives the first again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import ClassVar

from halation.nodes import Camera, Edge, ShaderText, Size
from msgspec import Struct, field
from msgspec.structs import force_setattr

from ..custom_nodes import unprefixed
from ..graph import Port
from ..resources.color_program import ColorProgram, LookupTable
from ..resources.mesh import Mesh
from ..resources.picture import Picture
from ..resources.record import Record
from .areas import Around, Region


class Shape(Struct, frozen=True, gc=False):
    """What a picture in the making looks like. `data` (depth, ids, measurements) always keeps 32 bits."""

    size: Size
    channels: int
    data: bool


class Memory(Struct, frozen=True):
    """What a node remembered of the frame before, and whether in half floats."""

    key: str
    shape: Shape
    half: bool


class Ref(Struct, frozen=True):
    """One output of one operation."""

    op: int
    output: int = 0


class Constant(Struct, frozen=True):
    """A number or vector that becomes a uniform: it never changes the shader's text."""

    value: float | int | bool | tuple[float, ...]

    def __post_init__(self) -> None:
        # Operations that are equal must compute the same: -0.0 == 0.0, but not to a shader. Adding 0 leaves one zero.
        plain = self.value
        force_setattr(self, "value", tuple(part + 0 for part in plain) if isinstance(plain, tuple) else plain + 0)

    @property
    def channels(self) -> int:
        return len(self.value) if isinstance(self.value, tuple) else 1


class Choice(Struct, frozen=True):
    """An index that is part of the shader's text: another choice is another program."""

    index: int


Operand = Ref | Constant


class Parameter(Struct, frozen=True, gc=False):
    """One argument of a GLSL function. A wired value is clamped to its hard range, then brought to working units."""

    glsl: str
    operand: Ref | Constant | Choice
    factor: float = 1.0
    low: float = float("-inf")
    high: float = float("inf")


class Accessor(Struct, frozen=True, gc=False):
    """A picture that a function reads anywhere, or only `around` a place, through `<name>_at` and `<name>_near`."""

    name: str
    glsl: str
    operand: Ref | Constant
    around: Around | None = None


class Op(Record, frozen=True):
    """One operation. `owner` is the node it came from, as a path through groups."""

    shapes: tuple[Shape, ...]
    owner: str

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"owner"})

    def reads(self) -> Iterator[Ref]:
        """Every picture it reads, in order."""
        return iter(())

    @property
    def size(self) -> Size:
        return self.shapes[0].size

    @property
    def owners(self) -> tuple[str, ...]:
        """All nodes whose work it does."""
        return (self.owner,)

    @property
    def label(self) -> str:
        """What it does, in a word or two."""
        return type(self).__name__.lower()


class Read(Op, frozen=True):
    """Pixels uploaded from outside."""

    picture: Picture
    fingerprint: str
    half: bool


class History(Op, frozen=True):
    """Pixels that a node remembered of the frame before, known by their key."""

    key: str
    half: bool


class Held(Op, frozen=True):
    """What an operation made before: by output, the pixels (None where nobody needs them) and their key."""

    pictures: tuple[Picture | None, ...]
    halves: tuple[bool, ...]
    keys: tuple[str, ...]


class Call(Op, frozen=True):
    """A pointwise GLSL function. Several shapes are several `out` parameters. `choices` become macros for its file.

    With a `program` the function stands there and not in the library.
    """

    shader: str
    function: str
    parameters: tuple[Parameter, ...]
    choices: tuple[tuple[str, tuple[str, ...]], ...] = ()
    program: ColorProgram | None = None

    @property
    def label(self) -> str:
        return "recolor" if self.program else unprefixed(self.function)

    @property
    def tables(self) -> tuple[LookupTable, ...]:
        """What its function reads through samplers of its own."""
        return self.program.tables if self.program else ()

    def reads(self) -> Iterator[Ref]:
        return (item.operand for item in self.parameters if isinstance(item.operand, Ref))


class Gather(Op, frozen=True):
    """A GLSL function that reads its pictures anywhere."""

    shader: str
    function: str
    accessors: tuple[Accessor, ...]
    parameters: tuple[Parameter, ...]
    edge: Edge = "clamp"
    choices: tuple[tuple[str, tuple[str, ...]], ...] = ()
    light: bool = False
    """Cheap enough to be computed within the pass that reads it: see `Library.light`."""

    @property
    def label(self) -> str:
        return unprefixed(self.function)

    def reads(self) -> Iterator[Ref]:
        return (item.operand for item in self.accessors if isinstance(item.operand, Ref))


MAX_WEIGHTS = 4096
"""Floats in the uniform block of a convolution: GL promises 16 KB."""

MAX_TAPS = MAX_WEIGHTS - 15
"""Weights of a convolution: an odd number that leaves room for zeros past the last one, where eight pixels slide."""


class Convolve(Op, frozen=True):
    """out[i] = sum over j of weights[j] * image[i * stride + origin + j], along one axis (0 is x)."""

    image: Ref
    axis: int
    weights: tuple[float, ...]
    stride: int
    origin: int
    edge: Edge

    @property
    def label(self) -> str:
        return f"{'decimate' if self.stride > 1 else 'convolve'} {'xy'[self.axis]}"

    def reads(self) -> Iterator[Ref]:
        return iter((self.image,))


class Reduce(Op, frozen=True):
    """Sum or maximum over blocks of `BLOCK` x `BLOCK` pixels."""

    image: Ref
    operation: str

    def reads(self) -> Iterator[Ref]:
        return iter((self.image,))


class ExternalProgram(Op, frozen=True):
    """A program that is no function of ours: its pictures by sampler, its uniforms by name."""

    text: ShaderText
    pictures: tuple[tuple[str, Ref], ...]
    uniforms: tuple[tuple[str, Constant], ...]

    @property
    def label(self) -> str:
        return self.text.fragment.file.rpartition("/")[2]

    def reads(self) -> Iterator[Ref]:
        return (ref for _, ref in self.pictures)


class Raster(Op, frozen=True):
    """Meshes, drawn into the channels of `CHANNELS`. `cameras` and `motions` are rows: now, before, after."""

    mesh: Mesh
    cameras: tuple[float, ...]
    motions: tuple[float, ...]
    near: float


BLOCK = 16


class Builder:
    """Collects operations; adding an equal one again returns the first.

    `added` and `looked` are which ones were added, and looked into, since they were last emptied.
    """

    def __init__(self) -> None:
        self.ops: list[Op] = []
        self.known: dict[Op, int] = {}
        self.added: list[int] = []
        self.looked: list[int] = []

    def add(self, op: Op) -> Ref:
        """The first output of `op`."""
        known = self.known.get(op)
        if known is None:
            known = self.known[op] = len(self.ops)
            self.ops.append(op)
        self.added.append(known)
        return Ref(known)

    def op(self, ref: Ref) -> Op:
        """The operation behind an output, for who has to know more than its shape."""
        self.looked.append(ref.op)
        return self.ops[ref.op]

    def shape(self, ref: Ref) -> Shape:
        """What an output of an operation looks like."""
        return self.ops[ref.op].shapes[ref.output]


class Program(Struct, frozen=True):
    """All operations in an order in which each comes after what it reads, and the pictures wanted by name."""

    ops: tuple[Op, ...]
    outputs: Mapping[str, Ref]
    memories: Mapping[Port, Ref]
    """What to remember for the next frame, by node and name."""
    results: Mapping[Port, Ref]
    """What outputs of nodes and groups, and inputs of graphs, stand for, in the order in which they were lowered."""
    cameras: Mapping[Port, Camera]
    """What inputs of nodes that take a camera were given."""
    scale: float
    frame: int
    windows: Mapping[Ref, Region] = field(default_factory=lambda: MappingProxyType({}))
    """The parts of pictures that are made or read, of those that are not whole on the device."""

    def held(self, ref: Ref) -> Size:
        """How many pixels of it are on the device."""
        return self.windows[ref].size if ref in self.windows else self.shape(ref).size

    def shape(self, ref: Ref) -> Shape:
        """What an output of an operation looks like."""
        return self.ops[ref.op].shapes[ref.output]
