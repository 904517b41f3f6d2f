"""All operations of a graph, and what collects them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from halation.nodes import CameraModel, Size
from msgspec import Struct, field
from msgspec.structs import replace

from ...graph import Port
from ..areas import Region
from .operation import Op
from .operations import Convolve, Gather, Read
from .values import PictureShape, Ref


class Builder:
    """Collects operations; adding an equal one again returns the first.

    `added` and `inspected` are the operations that were added, and looked into, since they were last emptied.
    """

    def __init__(self) -> None:
        self.ops: list[Op] = []
        self.numbers: dict[Op, int] = {}
        """Operations by value, and where they are in `ops`."""
        self.added: list[int] = []
        self.inspected: list[int] = []

    def add(self, op: Op) -> Ref:
        """The first output of `op`."""
        op = self._with_common_edge(op)
        number = self.numbers.setdefault(op, len(self.ops))
        if number == len(self.ops):
            self.ops.append(op)
        self.added.append(number)
        return Ref(number)

    def _with_common_edge(self, op: Op) -> Op:
        """Pictures of one pixel go on alike beyond their edges, unless what follows is black."""
        if not isinstance(op, Convolve | Gather) or op.edge == "black":
            return op
        is_one_pixel = all(self.shape(ref).size == (1, 1) for ref in op.reads())
        return replace(op, edge="clamp") if is_one_pixel else op

    def inspect(self, ref: Ref) -> Op:
        """The operation behind an output, for a caller that has to know more than its shape."""
        self.inspected.append(ref.op)
        return self.ops[ref.op]

    def shape(self, ref: Ref) -> PictureShape:
        """The size and channels of an output of an operation."""
        return self.ops[ref.op].shapes[ref.output]


class LoweredProgram(Struct, frozen=True):
    """All operations, each after those whose outputs it reads, and the pictures that are asked for by name."""

    ops: tuple[Op, ...]
    outputs: Mapping[str, Ref]
    memories: Mapping[Port, Ref]
    """What to remember for the next frame, by node and name."""
    results: Mapping[Port, Ref]
    """What outputs of nodes and groups, and inputs of graphs, stand for, in the order in which they were lowered."""
    cameras: Mapping[Port, CameraModel]
    """The cameras that inputs of nodes were given."""
    scale: float
    frame: int
    data_windows: Mapping[Ref, Region] = field(default_factory=lambda: MappingProxyType({}))
    """The pixels that there are of pictures that go on beyond their frame: see `data_windows`."""
    extents: Mapping[Ref, Region] = field(default_factory=lambda: MappingProxyType({}))
    """The pixels of them that are made, where they are more than the frame."""
    windows: Mapping[Ref, Region] = field(default_factory=lambda: MappingProxyType({}))
    """The parts of pictures that are made or read, of those that are not whole on the device."""

    def find_first_convolution(self, op: Convolve) -> Convolve:
        """The first of the convolutions by the same stride that follow each other and end in this one. All of them run
        the program that is compiled for the first.
        """
        before = self.ops[op.image.op]
        if isinstance(before, Convolve) and before.stride == op.stride:
            return self.find_first_convolution(before)
        return op

    def has_no_holes(self, reader: Op, picture: Ref, by_image: bool) -> bool:
        """Whether a picture is known to have no hole for an operation that reads it anywhere: neither NaN nor infinity,
        nor, for one that averages, a number that is too large. What is known of files counts only where they are read
        as images.

        Convolutions test all other pictures, also where it is not needed: else there were more programs to compile.
        """
        if not isinstance(reader, Convolve | Gather):
            return False
        made_by = self.ops[(self.find_first_convolution(reader).image if isinstance(reader, Convolve) else picture).op]
        if isinstance(made_by, Read):
            return by_image and made_by.finite and (made_by.half or not reader.averages)
        return isinstance(reader, Gather) and isinstance(made_by, Convolve | Gather) and made_by.averages

    @property
    def kept_refs(self) -> tuple[Ref, ...]:
        """The pictures that must be there at the end: outputs, and what the next frame reads."""
        return (*self.outputs.values(), *self.memories.values())

    def data_window(self, ref: Ref) -> Region:
        """The pixels that there are of a picture, at least its frame."""
        return self.data_windows.get(ref) or Region.whole(self.shape(ref).size)

    def end_alike(self, first: int, second: int) -> bool:
        """True if the pictures of two operations of one size have the same data window."""
        return not self.data_windows or self.data_windows.get(Ref(first)) == self.data_windows.get(Ref(second))

    def extent(self, ref: Ref) -> Region:
        """The pixels that are made of a picture if all outputs are, at least its frame."""
        return self.extents.get(ref) or Region.whole(self.shape(ref).size)

    def window(self, ref: Ref) -> Region | None:
        """The pixels of a picture that are on the device; None for its frame."""
        return self.windows.get(ref) or self.extents.get(ref)

    def size_on_device(self, ref: Ref) -> Size:
        """How many pixels of a picture are on the device."""
        window = self.window(ref)
        return window.size if window else self.shape(ref).size

    def shape(self, ref: Ref) -> PictureShape:
        """The size and channels of an output of an operation."""
        return self.ops[ref.op].shapes[ref.output]
