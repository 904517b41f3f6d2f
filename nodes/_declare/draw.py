"""What a filter can draw. The compiler implements it."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Literal, Protocol

from msgspec import Struct

from .camera import CameraModel
from .recolor import ColorChange
from .render import Render
from .scene import Motion, Scene
from .sockets import CameraSocket, Edge, Size, Socket
from .values import Plain, Uniform


class Drawn(Protocol):
    """Pixels that a draw will make. Only the compiler looks inside."""

    @property
    def size(self) -> Size: ...


Pixels = Socket | Drawn
Affine = tuple[float, float, float, float, float, float]
"""A map of pixel positions, by rows: x' = a x + b y + c, y' = d x + e y + f. Pixels have their centers at .5."""

Kernel = Literal["nearest", "triangle", "catmull-rom", "mitchell", "lanczos"]
"""How pixels between pixels are made. Catmull-Rom and Mitchell: Mitchell and Netravali 1988; Lanczos has 3 lobes."""

Argument = Socket | Drawn | Plain


class Reach(Struct, frozen=True):
    """Pixels around a place, to which `matrix` leads from the middle of the pixel that is made; the function reads no
    farther from it than `radius`, across and down."""

    matrix: Affine
    radius: tuple[int, int]

    @staticmethod
    def block(across: int, down: int, beside: int = 0) -> Reach:
        """All pixels of a block, of which each becomes one, and so many beside it."""
        matrix = (float(across), 0.0, 0.0, 0.0, float(down), 0.0)
        return Reach(matrix, (-(-across // 2) + beside, -(-down // 2) + beside))

    @staticmethod
    def within(across: int, down: int, beside: int = 0) -> Reach:
        """The one for the block that a pixel lies in, and so many beside it."""
        return Reach((1.0 / across, 0.0, 0.0, 0.0, 1.0 / down, 0.0), (1 + beside, 1 + beside))


Overlap = int | tuple[int, int] | Reach
"""Pixels to every side, or across and down; in a picture of another size, of the pixel at the same part of it."""


class ShaderStage(Struct, frozen=True):
    """One shader of a program: GLSL 4.10 without `#version`. Messages count the lines of `text`, as those of `file`."""

    head: str
    text: str
    tail: str
    file: str

    identity_exclude: ClassVar[Mapping[str, str]] = {"file": "only messages say it"}


class ShaderText(Struct, frozen=True):
    """A program of its own, which declares its uniforms and samplers.

    The fragment shader has a function `vec4 halation_pixel()`, the color at gl_FragCoord; row 0 is the top. A vertex
    shader is asked for the four corners of a strip: gl_VertexID is 0 to 3. Without one everything is covered.
    """

    fragment: ShaderStage
    vertex: ShaderStage | None = None


class Draw(Protocol):
    """Records the draws of a node. Nothing runs yet, but sizes are known.

    Functions are looked up in the node's own GLSL file. `result` is the type of what is drawn.
    """

    @property
    def size(self) -> Size:
        """The size that the node's outputs have unless drawn otherwise."""
        ...

    @property
    def frame(self) -> int:
        """The frame that is rendered."""
        ...

    @property
    def rate(self) -> float:
        """Frames per second."""
        ...

    @property
    def start(self) -> int:
        """The first frame of the graph, from which time counts."""
        ...

    def size_of(self, pixels: Pixels) -> Size:
        """The size of an input or of something drawn."""
        ...

    def is_linked(self, socket: Socket) -> bool:
        """True if something is linked to this input of the node."""
        ...

    def camera(self, socket: CameraSocket, frame: int | None = None) -> CameraModel | None:
        """The camera that is linked to this input of the node, if any is; at another of the node's `times`."""
        ...

    def at(self, socket: Socket, frame: int) -> Drawn:
        """An input at another frame, one of the node's `times`."""
        ...

    def __call__(
        self,
        function: str,
        /,
        *inputs: Socket,
        size: Size | None = None,
        edge: Edge = "clamp",
        result: Socket | None = None,
        overlap: Overlap | Mapping[str, Overlap] | None = None,
        **arguments: Argument,
    ) -> Drawn:
        """Call `function` for every pixel of `size`.

        Inputs, and keyword arguments that are pixels, are read through accessors named after the socket or
        keyword: `image_at(ivec2)`, `image_near(vec2)` (bilinear, pixel positions, centers at .5) and
        `image_size`. The other keyword arguments are the function's parameters, in order.

        `overlap` is how many pixels around its own the function reads at most, those that `near` mixes too, of all
        pictures or of those that it names. Without one, or of what is not named, it may read everything, and no
        part of a picture can be made alone.
        """
        ...

    def several(
        self,
        function: str,
        results: tuple[Socket, ...],
        /,
        *inputs: Socket,
        size: Size | None = None,
        edge: Edge = "clamp",
        overlap: Overlap | Mapping[str, Overlap] | None = None,
        **arguments: Argument,
    ) -> tuple[Drawn, ...]:
        """Draw with a `function` that has `out` parameters, last, for pictures of these types: all are made at once."""
        ...

    def point(self, function: str, /, *inputs: Socket, result: Socket | None = None, **arguments: Argument) -> Drawn:
        """Call a pointwise `function`; every argument, pixels too, is a parameter, in order. It can fuse."""
        ...

    def program(
        self,
        text: ShaderText,
        pictures: Mapping[str, Drawn],
        uniforms: Mapping[str, Uniform],
        *,
        size: Size | None = None,
        result: Socket | None = None,
    ) -> Drawn:
        """Run a complete shader program from outside over every pixel of `size`; four channels come out.

        Pictures are by the names of its samplers, which filter (bilinear) and end in their outermost pixels. What it
        does not draw stays black.
        """
        ...

    def blur(self, image: Pixels, sigma: float | tuple[float, float], edge: Edge = "clamp") -> Drawn:
        """Gaussian of `sigma` working pixels: direct where small, decimated where large."""
        ...

    def spread(self, image: Pixels, weights: tuple[float, ...], edge: Edge = "clamp") -> Drawn:
        """Correlate along both axes with an odd number of centered weights that fall off smoothly.

        Direct where they are few, decimated where they are many: then within 1e-3 of what a single pixel becomes.
        """
        ...

    def convolve(
        self, image: Pixels, weights: tuple[float, ...], axis: Literal["x", "y"], edge: Edge = "clamp"
    ) -> Drawn:
        """Correlate along one axis with an odd number of centered weights."""
        ...

    def convolve_2d(self, image: Pixels, kernel: Pixels) -> Drawn:
        """Convolve every channel with the same channel of another picture of any size; black lies outside.

        The kernel's origin is its middle, pixel `size // 2`; it is not normalized. By fast Fourier transform: exact
        but for rounding, and the cost hardly depends on what the kernel holds.
        """
        ...

    def recolor(self, image: Pixels, change: ColorChange) -> Drawn:
        """Change straight color as OpenColorIO does, exactly; alpha is kept. It can fuse, as `point` does."""
        ...

    def place(self, image: Pixels, matrix: Affine, kernel: Kernel, edge: Edge = "black") -> Drawn:
        """Move, turn and scale: `matrix` says where a pixel of the result lies in `image`.

        The kernel widens where the picture shrinks. What was itself placed with the same edge is placed anew: pixels
        are filtered once, and what left the frame in between is still there.
        """
        ...

    def raster(
        self,
        scene: Scene,
        motions: tuple[Motion, Motion, Motion],
        cameras: tuple[CameraModel, CameraModel, CameraModel],
        near: float,
    ) -> Mapping[str, Drawn]:
        """Draw the meshes of a scene as seen by a camera; motions and cameras are those of now, before and after.

        Gives `albedo` and `emission` (opaque where something is), `normal` (unit, towards the camera), `place` (world
        x, y, z and planar depth), `metal_rough`, `velocity` (pixels since the frame before and until the next, y
        down), `surface` (u, v, object, material; numbers from 1). Where nothing is, all are 0. What is nearer than
        `near` is cut off.
        """
        ...

    def reduce(self, image: Pixels, operation: Literal["sum", "max"]) -> Drawn:
        """Sum or maximum of every channel over all pixels, as 1x1; exact at any size."""
        ...

    def history(self, first: Pixels, name: str = "") -> Drawn:
        """What this node remembered of the frame before; on a first frame, `first`. For `Temporal` nodes.

        One that remembers several pictures tells them apart by `name`.
        """
        ...

    def remember(self, pixels: Drawn, name: str = "") -> None:
        """Keep these pixels for the next frame. For `Temporal` nodes."""
        ...

    def table(self, numbers: tuple[float, ...], width: int) -> Drawn:
        """Numbers as a picture of four channels, `width` pixels to a row, for functions that read them anywhere."""
        ...

    def render(self, path: str, named: Mapping[str, str] = MappingProxyType({})) -> Render:
        """What the file of a render turns out to hold; `named` are layers by the roles that they are to have.

        For `Source` nodes.
        """
        ...

    def read(self, path: str, layer: str, result: Socket, space: str = "") -> Drawn:
        """The pixels of a layer of an image file, as `result` says. Color is in that color space, "" to find out."""
        ...

    def asset(self, path: str, folder: str) -> Drawn:
        """A picture that belongs to the node itself, never fit to a size. It must lie in `folder`, links followed."""
        ...
