"""The operations that a graph is lowered to.

Operations are values: two that are equal compute the same pixels, so adding one twice gives the first again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import ClassVar

from halation.nodes import Affine, Edge, Size
from msgspec.structs import replace

from ...custom_nodes import strip_prefix
from ...resources.color_program import ColorProgram, LookupTable
from ...resources.mesh import Mesh
from ...resources.picture import Picture
from ..areas import Region, Span, clip_region
from ..library import Library
from .operation import Op, SourceOp
from .values import Accessor, Parameter, Ref, UniformConstant

EDGES = "primitive/edges"
"""The shader file that all passes include which read neighbors."""

BLOCK = 16
"""Pixels along each side of the blocks that a reduction folds. A picture of 3840x2160 needs three passes with 16. With
larger blocks, the last passes have too few invocations; smaller ones need more passes. Chosen by judgement."""

MAX_WEIGHTS = 4096
"""Floats in the uniform block of a convolution: OpenGL guarantees 16 KiB (MAX_UNIFORM_BLOCK_SIZE)."""

MAX_TAPS = MAX_WEIGHTS - 15
"""Weights of a convolution: an odd number that leaves room for the zeros after the last one, which strips of eight
pixels read."""


class Read(SourceOp, frozen=True):
    """Pixels uploaded from outside."""

    picture: Picture
    fingerprint: str
    half: bool
    data_window: Region | None = None
    """The pixels that the file has, where they are more than the frame."""
    pixel_aspect: float = 1.0
    """The width of a pixel over its height, as the file is to be shown."""
    finite: bool = False
    """True if no pixel is NaN or infinite."""

    def find_upload(self, output: int) -> Picture:
        return self.picture

    def with_pictures(self, fill: Callable[[Picture], Picture]) -> Read:
        return replace(self, picture=fill(self.picture))

    def is_half(self, output: int) -> bool:
        return self.half

    def without_numbers(self) -> Read:
        picture = replace(self.picture, path="", layer="", frame=1, space="", within="")
        return replace(self, picture=picture, fingerprint="")


class HistoryRead(SourceOp, frozen=True):
    """Pixels that a node remembered of the frame before, known by their key."""

    memory_key: str
    half: bool
    data_window: Region | None = None
    """The pixels that were remembered, where they are more than the frame."""

    is_memory: ClassVar[bool] = True
    identity_exclude: ClassVar[Mapping[str, str]] = {
        "shapes": "the key of the remembered pixels says it",
        "half": "the key of the remembered pixels says it",
        "data_window": "the key of the remembered pixels says it",
    }

    def key(self, output: int) -> object:
        return self.memory_key

    def is_half(self, output: int) -> bool:
        return self.half

    def without_numbers(self) -> HistoryRead:
        return replace(self, memory_key="")


class StoredResult(SourceOp, frozen=True):
    """What an operation made before, by output: the pixels (None where nothing reads them), and their key."""

    pictures: tuple[Picture | None, ...]
    halves: tuple[bool, ...]
    keys: tuple[str, ...]

    identity_exclude: ClassVar[Mapping[str, str]] = {
        "shapes": "the keys of the pixels say it",
        "pictures": "the keys of the pixels say it",
        "halves": "the keys of the pixels say it",
    }

    def find_upload(self, output: int) -> Picture | None:
        return self.pictures[output]

    def key(self, output: int) -> object:
        return ("stored", self.keys[output])

    def is_half(self, output: int) -> bool:
        return self.halves[output]


class FunctionOp(Op, frozen=True):
    """A GLSL function of the library. Several shapes are several `out` parameters.

    `choices` become macros for its file.
    """

    shader: str
    function: str
    parameters: tuple[Parameter, ...]
    choices: tuple[tuple[str, tuple[str, ...]], ...] = ()

    @property
    def label(self) -> str:
        return strip_prefix(self.function)

    @property
    def files(self) -> tuple[str, ...]:
        return (self.shader,)

    def find_uniforms(self, library: Library) -> frozenset[str]:
        return library.find_uniforms(self.shader, self.function, self.owner)

    @property
    def uniform_floats(self) -> int:
        """Each constant is rounded up to four floats, and every output has a seam."""
        floats = 4 * len(self.shapes)
        for parameter in self.parameters:
            if isinstance(parameter.operand, UniformConstant):
                floats += _count_padded_floats(parameter.operand)
            if parameter.factor != 1.0:
                floats += 4
        return floats

    def without_numbers(self) -> FunctionOp:
        return replace(self, parameters=_blank_parameters(self.parameters))

    def find_user_files(self, library: Library) -> tuple[str, ...]:
        return (library.file_name(self.shader),) if self.shader.startswith("written/") else ()


class Call(FunctionOp, frozen=True):
    """A pointwise GLSL function."""

    is_pointwise: ClassVar[bool] = True
    takes_producers: ClassVar[bool] = True

    def reads(self) -> Iterator[Ref]:
        return (item.operand for item in self.parameters if isinstance(item.operand, Ref))

    def reads_whole(self, ref: Ref, size: Size) -> bool:
        return size != self.size

    def _find_footprint(self, ref: Ref, size: Size, region: Region, window: Region) -> Region:
        return clip_region(region.across, region.down, size, "clamp", window)

    def is_straight(self, library: Library) -> bool:
        return library.is_straight(self.shader, self.function, self.owner)

    def is_cheap(self, library: Library) -> bool:
        return library.is_cheap(self.shader, self.function, self.owner)


class ColorCall(Call, frozen=True, kw_only=True):
    """A pointwise function that a color library wrote: its text is in `program`, not in a file."""

    program: ColorProgram

    @property
    def label(self) -> str:
        return "recolor"

    @property
    def files(self) -> tuple[str, ...]:
        return ()

    @property
    def color_programs(self) -> tuple[ColorProgram, ...]:
        return (self.program,)

    @property
    def tables(self) -> tuple[LookupTable, ...]:
        return self.program.tables

    def find_uniforms(self, library: Library) -> frozenset[str]:
        return frozenset()

    def is_straight(self, library: Library) -> bool:
        return False

    def is_cheap(self, library: Library) -> bool:
        return False


class Gather(FunctionOp, frozen=True, kw_only=True):
    """A GLSL function that reads its pictures anywhere."""

    accessors: tuple[Accessor, ...]
    edge: Edge = "clamp"
    light: bool = False
    """Cheap enough to be computed within the pass that reads it: see `Library.light`."""
    warps: bool = False
    """Shows pixels of its picture at other places, which are known for the frame alone."""
    stretches: bool = False
    """Shows all of its picture in another number of pixels."""
    averages: bool = False
    """Whether its pixels are weighted means of those that it reads, as those of a convolution that averages."""
    ends_as: tuple[Ref, int] | None = None
    """A picture, and the axis along which this one ends where that does: what is read has pixels that an edge made."""

    identity_exclude: ClassVar[Mapping[str, str]] = {
        "light": "it decides in which pass pixels are made, not which",
        "warps": "it decides where a picture ends, which the key of its pass says",
        "ends_as": "it decides where a picture ends, which the key of its pass says",
        "stretches": "it decides the shape in which pixels are shown, not what is in them",
    }

    @property
    def files(self) -> tuple[str, ...]:
        return (EDGES, self.shader)

    @property
    def is_inlinable(self) -> bool:
        return self.light

    @property
    def uniform_floats(self) -> int:
        """As for all functions, and the size of each picture."""
        return super().uniform_floats + 4 * len(self.accessors)

    def reads(self) -> Iterator[Ref]:
        return (item.operand for item in self.accessors if isinstance(item.operand, Ref))

    def reads_whole(self, ref: Ref, size: Size) -> bool:
        return any(item.operand == ref and item.around is None for item in self.accessors)

    def _find_footprint(self, ref: Ref, size: Size, region: Region, window: Region) -> Region:
        if self.warps and not Region.whole(self.size).contains(region):
            return window
        footprint: Region | None = None
        for item in self.accessors:
            if item.operand == ref and item.around is not None:
                across, down = item.around.find_spans(region)
                part = clip_region(across, down, size, self.edge, window)
                footprint = footprint.union(part) if footprint else part
        return footprint or window

    def is_straight(self, library: Library) -> bool:
        return self.light

    def without_numbers(self) -> Gather:
        accessors = tuple(Accessor(item.name, item.glsl, _blank(item.operand)) for item in self.accessors)
        return replace(self, accessors=accessors, parameters=_blank_parameters(self.parameters))


class Placement(Gather, frozen=True, kw_only=True):
    """A picture moved, turned and scaled. `matrix` says where its pixels lie in the one that it reads."""

    matrix: Affine = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    chain: tuple[str, ...] = ()
    """The nodes whose matrices were multiplied, the first one first."""

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"owner", "chain"})

    @property
    def owners(self) -> tuple[str, ...]:
        return self.chain

    @property
    def label(self) -> str:
        return f"{self.function} x {len(self.chain)}" if len(self.chain) > 1 else self.function

    def without_numbers(self) -> Gather:
        return replace(super().without_numbers(), matrix=(0.0,) * 6)


class Convolve(Op, frozen=True):
    """out[i] = sum over j of weights[j] * image[i * stride + origin + j], along one axis (0 is x)."""

    image: Ref
    axis: int
    weights: tuple[float, ...]
    stride: int
    origin: int
    edge: Edge
    averages: bool = False
    """Whether its weights are positive and add up to 1. It leaves out what is not finite or too large to be added up,
    so that all it makes is finite."""

    @property
    def label(self) -> str:
        return f"{'decimate' if self.stride > 1 else 'convolve'} {'xy'[self.axis]}"

    @property
    def files(self) -> tuple[str, ...]:
        return (EDGES,)

    def reads(self) -> Iterator[Ref]:
        return iter((self.image,))

    def _find_footprint(self, ref: Ref, size: Size, region: Region, window: Region) -> Region:
        spans = [region.across, region.down]
        first, end = spans[self.axis]
        spans[self.axis] = (
            first * self.stride + self.origin,
            (end - 1) * self.stride + self.origin + len(self.weights),
        )
        return clip_region(spans[0], spans[1], size, self.edge, window)

    def without_numbers(self) -> Convolve:
        return replace(self, weights=(), origin=0)


class Reduce(Op, frozen=True):
    """Sum or maximum over blocks of `BLOCK` x `BLOCK` pixels."""

    image: Ref
    operation: str

    takes_producers: ClassVar[bool] = True

    def reads(self) -> Iterator[Ref]:
        return iter((self.image,))

    @property
    def is_made_first(self) -> bool:
        return True

    def find_producer_size(self, ops: Sequence[Op]) -> Size:
        return ops[self.image.op].shapes[self.image.output].size

    def _find_footprint(self, ref: Ref, size: Size, region: Region, window: Region) -> Region:
        return Region.of(_find_blocks(region.across, size[0]), _find_blocks(region.down, size[1]))


class Raster(Op, frozen=True):
    """Meshes, drawn into the channels of `CHANNELS`. `cameras` and `motions` are rows: now, before, after."""

    mesh: Mesh
    cameras: tuple[float, ...]
    motions: tuple[float, ...]
    near: float

    is_fragment_only: ClassVar[bool] = True
    rounds_halves: ClassVar[bool] = False

    @property
    def files(self) -> tuple[str, ...]:
        return ("primitive/raster",)

    @property
    def is_indivisible(self) -> bool:
        return True

    @property
    def mesh_drawn(self) -> Mesh:
        return self.mesh

    def find_uniforms(self, library: Library) -> frozenset[str]:
        return frozenset({"proxy"})

    def without_numbers(self) -> Raster:
        return replace(self, cameras=(), motions=(), near=0.0)


def _find_blocks(span: Span, length: int) -> Span:
    return span[0] * BLOCK, min(span[1] * BLOCK, length)


def _count_padded_floats(item: UniformConstant) -> int:
    """Floats with the padding of std140, where each column of a mat3 takes four."""
    channels = item.channels
    return 4 if channels <= 4 else 12 if channels == 9 else -(-channels // 4) * 4


def _blank_parameters(parameters: tuple[Parameter, ...]) -> tuple[Parameter, ...]:
    return tuple(
        replace(item, operand=item.operand.blank) if isinstance(item.operand, UniformConstant) else item
        for item in parameters
    )


def _blank(operand: Ref | UniformConstant) -> Ref | UniformConstant:
    return operand.blank if isinstance(operand, UniformConstant) else operand
