"""The result of compiling: frozen data that says everything the renderer does, and nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

from halation.nodes import CameraModel, HostProgram, Size, Uniform
from msgspec import Struct, field

from ..graph import Port
from ..resources.color_program import LookupTable
from ..resources.mesh import Mesh
from ..resources.picture import Picture
from ..resources.record import Record
from .areas import Region
from .ir import Memory
from .target import Form, Target
from .tiling.tiles import Tiling

Depth = Literal["f2", "f4"]
"""The type of a channel, half float or float. As in numpy, the digit says how many bytes it takes."""

FIRST_TABLE = 16
"""The first texture unit for tables. Pictures use the units below: OpenGL 4.1 guarantees 16 for each shader stage."""

LINES_PER_FILE = 10_000
"""Line n of file f of a program is line f * LINES_PER_FILE + n, because not all drivers report file numbers. No file
has as many lines."""


def texture_format(channels: int, half: bool) -> str:
    """The format of a texture with at least this many channels, as GLSL image layouts spell it."""
    return ("r", "rg", "rgba", "rgba")[channels - 1] + ("16f" if half else "32f")


def texture_bytes(size: Size, texel: str) -> int:
    """The bytes of a texture of this size and format."""
    letters, bits = texel[:-3], int(texel[-3:-1])
    return size[0] * size[1] * len(letters) * bits // 8


class Surface(Struct, frozen=True):
    """A picture on the device. Equal `key`s mean equal pixels; `slot` is the number of its texture.

    Three channels are stored as four, because not every device can render to three. `first` and `last` are the passes
    that make it and that read it last; `last` is beyond all passes for a picture that is kept.
    """

    key: str
    label: str
    size: Size
    channels: int
    depth: Depth
    slot: int
    first: int
    last: int
    window: Region | None = None
    """The part of its picture that it holds; None for all of it."""
    is_data: bool = False
    """True for numbers that are no light: depth, ids, measurements."""
    frame: Size | None = None
    """The size of its picture's frame; None if it holds just that."""
    pixel_aspect: float = 1.0
    """The width of a pixel over its height, as the picture is to be shown."""

    @property
    def frame_size(self) -> Size:
        """The size of its picture's frame, whatever it holds of it and around it."""
        return self.frame or self.size

    @property
    def components(self) -> int:
        return 4 if self.channels == 3 else self.channels

    @property
    def nbytes(self) -> int:
        """The bytes of its texture."""
        return self.size[0] * self.size[1] * self.components * int(self.depth[1])

    @property
    def texel(self) -> str:
        """The format, as GLSL image layouts spell it."""
        return texture_format(self.channels, self.depth == "f2")


class Shader(Struct, frozen=True):
    """A whole GLSL program, made of `files`. `reads_images`: its textures are bound to image units."""

    source: str
    form: Form
    files: tuple[str, ...]
    reads_images: bool
    vertex: str = ""
    """The vertex shader of a pass that draws meshes, or a strip of its own; others cover the whole picture."""
    foreign: bool = False
    """True for a program of another format: it names its own samplers and reads them interpolated."""

    def locate(self, line: int) -> tuple[str, int]:
        """The file and line that a driver reports as `line`."""
        number, row = divmod(line, LINES_PER_FILE)
        return (self.files[number], row) if number < len(self.files) else (self.files[0], line)


class Upload(Struct, frozen=True):
    """A picture whose pixels are uploaded into a surface."""

    surface: int
    picture: Picture
    node: str
    whole: Region
    """All pixels of the picture, of which the surface may hold a part."""


class HostTask(Struct, frozen=True):
    """A program on the processor, and which of its pass's textures are its pictures, by name."""

    program: HostProgram
    pictures: tuple[tuple[str, int], ...]


class Pass(Record, frozen=True):
    """One draw or dispatch. Textures are bound in order as t0, t1, ...; targets as o0, o1, ...

    `groups` are work groups of a compute pass. `weights` fill its uniform block, if any. `tables` are bound from unit
    `FIRST_TABLE` on. With a `mesh` its triangles are drawn.
    """

    nodes: tuple[str, ...]
    functions: tuple[str, ...]
    shader: Shader
    textures: tuple[int, ...]
    targets: tuple[int, ...]
    uniforms: tuple[tuple[str, Uniform], ...]
    weights: tuple[float, ...]
    groups: tuple[int, int, int]
    tables: tuple[LookupTable, ...] = ()
    mesh: Mesh | None = None
    writers: Mapping[str, str] = field(default_factory=dict[str, str])
    """The node behind each file of code that users wrote."""

    host: HostTask | None = None
    """What runs on the processor, in place of the shader."""

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"writers"})


class Plan(Struct, frozen=True):
    """All that a renderer does for one frame: uploads, passes in order, and outputs by name."""

    target: Target
    surfaces: tuple[Surface, ...]
    uploads: tuple[Upload, ...]
    passes: tuple[Pass, ...]
    outputs: Mapping[str, int]
    results: Mapping[Port, int]
    """The surface of every output of a node or group, and input of a graph, whose pixels the plan makes.

    Nodes are paths such as `glow/bloom`; the inputs of a group are `glow/inputs`. Pictures that are never stored,
    because their operation shares a pass with its reader, are missing.
    """
    cameras: Mapping[Port, CameraModel]
    """The cameras that reach inputs of nodes."""
    memories: Mapping[Port, Memory]
    """What temporal nodes store of this frame for the next one, by node and name."""
    slots: tuple[int, ...]
    """Bytes of each texture that the plan needs at the same time."""
    tiling: Tiling | None = None
    """The stages and tiles of a plan that does not fit. Its surfaces and passes then only describe what is computed."""

    @property
    def remembering(self) -> tuple[str, ...]:
        """The paths of temporal nodes that store something."""
        return tuple(dict.fromkeys(port.node for port in self.memories))

    @property
    def remembered(self) -> tuple[int, ...]:
        """The surfaces that the next frame may read."""
        keys = {memory.key for memory in self.memories.values()}
        return tuple(number for number, surface in enumerate(self.surfaces) if surface.key in keys)

    @property
    def peak_bytes(self) -> int:
        """Texture memory needed at once."""
        return sum(self.slots)

    @property
    def held_bytes(self) -> int:
        """Bytes that a frame takes at once: textures, and the pictures that are read and made."""
        outside = {*(upload.surface for upload in self.uploads), *self.outputs.values()}
        return self.peak_bytes + sum(self.surfaces[number].nbytes for number in outside)
