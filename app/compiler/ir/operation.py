"""The base of all operations: the questions that the later stages ask of one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import ClassVar

from halation.nodes import Size

from ...resources.color_program import ColorProgram, LookupTable
from ...resources.mesh import Mesh
from ...resources.picture import Picture
from ...resources.record import Record
from ..areas import Region
from ..library import Library
from .identity import describe
from .values import PictureShape, Ref


class Op(Record, frozen=True):
    """One operation. `owner` is the node it came from, as a path through groups.

    The class attributes and methods below are all that fusion, scheduling and tiling know of a kind of operation. A new
    kind answers them, and has a writer in `codegen`. A source is made by no pass. A pointwise operation makes each
    pixel of what its inputs are at the same pixel.
    """

    shapes: tuple[PictureShape, ...]
    owner: str

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"owner"})
    identity_exclude: ClassVar[Mapping[str, str]] = {}
    """Fields on which no pixel depends, and why. All others are part of the identity: see `identity`."""
    is_source: ClassVar[bool] = False
    is_pointwise: ClassVar[bool] = False
    is_memory: ClassVar[bool] = False
    """True if its pixels stay on the device from the frame before: they are whole, and there from the first pass on."""
    takes_producers: ClassVar[bool] = False
    """True if it reads every pixel of a picture exactly once, so that its pass can compute that picture on the way."""
    is_fragment_only: ClassVar[bool] = False
    """True if its program is a vertex and a fragment shader on every device."""
    rounds_halves: ClassVar[bool] = True
    """False if the driver rounds what it stores as half floats, where others round in their program."""

    # --- identity ------------------------------------------------------------------------------------------------

    @property
    def identity(self) -> object:
        """All of it that can change a pixel, except which pictures it reads and the texts of `files`."""
        return describe(self)

    @property
    def files(self) -> tuple[str, ...]:
        """The shader files of the library whose text decides its pixels."""
        return ()

    def find_uniforms(self, library: Library) -> frozenset[str]:
        """Which of the uniforms that all passes can have it reads: `frame`, `proxy`."""
        return frozenset()

    def without_numbers(self) -> Op:
        """The same operation with all blank that is a uniform, or names pixels from outside.

        Operations that are equal without their numbers need the same passes.
        """
        return self

    # --- what it reads -------------------------------------------------------------------------------------------

    def reads(self) -> Iterator[Ref]:
        """Every picture it reads, in order."""
        return iter(())

    def reads_whole(self, ref: Ref, size: Size) -> bool:
        """True if it may read a picture, of this size, anywhere, whatever region of its own pixels is made."""
        return False

    def footprint(self, ref: Ref, size: Size, region: Region, window: Region) -> Region:
        """The region of a picture that it reads to make a `region` of its own pixels.

        `size` is that of the picture's frame, and `window` all of the picture, which may be larger.
        """
        if size == (1, 1) or self.reads_whole(ref, size):
            return window
        return self._find_footprint(ref, size, region, window)

    def _find_footprint(self, ref: Ref, size: Size, region: Region, window: Region) -> Region:
        return window

    def find_producer_size(self, ops: Sequence[Op]) -> Size:
        """The size of pictures that its pass can compute, if it takes producers."""
        return self.size

    @property
    def color_programs(self) -> tuple[ColorProgram, ...]:
        """Color math of a color library that it calls."""
        return ()

    @property
    def tables(self) -> tuple[LookupTable, ...]:
        """The tables that it reads through samplers of their own."""
        return ()

    @property
    def mesh_drawn(self) -> Mesh | None:
        """The triangles that it draws."""
        return None

    # --- what it makes -------------------------------------------------------------------------------------------

    @property
    def size(self) -> Size:
        return self.shapes[0].size

    @property
    def outputs(self) -> int:
        """How many pictures it makes."""
        return len(self.shapes)

    @property
    def is_inlinable(self) -> bool:
        """True if the pass of a pointwise operation that reads it can compute it on the way."""
        return self.is_pointwise

    @property
    def is_indivisible(self) -> bool:
        """True if it is always made as a whole: its program cannot make a part, or its outputs differ in size."""
        return len({shape.size for shape in self.shapes}) > 1

    @property
    def is_made_first(self) -> bool:
        """True if tiling makes its pictures whole, before anything reads them."""
        return self.is_indivisible

    @property
    def uniform_floats(self) -> int:
        """Floats of uniforms that it takes at most."""
        return 0

    def is_straight(self, library: Library) -> bool:
        """True if its code has no loops."""
        return False

    def is_cheap(self, library: Library) -> bool:
        """True if computing it again costs less than to store and read it."""
        return False

    # --- pixels from outside -------------------------------------------------------------------------------------

    def find_upload(self, output: int) -> Picture | None:
        """The picture whose pixels are uploaded for an output; None for what a pass makes."""
        return None

    def with_pictures(self, fill: Callable[[Picture], Picture]) -> Op:
        """The same operation with every picture from outside replaced by what `fill` makes of it."""
        return self

    # --- names ---------------------------------------------------------------------------------------------------

    @property
    def owners(self) -> tuple[str, ...]:
        """All nodes whose work it does."""
        return (self.owner,)

    @property
    def label(self) -> str:
        """What it does, in a word or two."""
        return type(self).__name__.lower()

    def find_user_files(self, library: Library) -> tuple[str, ...]:
        """The files of code written by users that it runs, as messages call them."""
        return ()


class SourceOp(Op, frozen=True):
    """Pixels that no pass makes: they are uploaded, or on the device already."""

    is_source: ClassVar[bool] = True

    def key(self, output: int) -> object:
        """What the key of an output is made of, or, as a string, the key itself."""
        return (self.identity, output)

    def is_half(self, output: int) -> bool:
        """True if the pixels are half floats."""
        raise NotImplementedError
