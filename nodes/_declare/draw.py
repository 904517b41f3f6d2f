"""`Draw`: what the passes of a filter can draw. The compiler implements it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Literal, Protocol

from msgspec import Struct

from .camera import CameraModel
from .host import HostProgram
from .lettering import TextBlock, TypesetText
from .outlines import OutlineFill
from .recolor import ColorChange
from .render import Render
from .scene import Motion, Scene
from .sockets import CameraSocket, Edge, Size, Socket
from .values import Doc, Scalar, Uniform


class Drawn(Protocol):
    """A picture that a draw will make, to draw with or to return from `passes`."""

    @property
    def size(self) -> Size: ...


Pixels = Socket | Drawn
"""A picture: an input of the node, or one that was drawn."""

Affine = tuple[float, float, float, float, float, float]
"""A map of pixel positions, by rows: x' = a x + b y + c, y' = d x + e y + f. Pixel centers lie at .5."""

Kernel = Literal["nearest", "triangle", "catmull-rom", "mitchell", "lanczos"]
"""The filter for places between pixels. Catmull-Rom and Mitchell: Mitchell and Netravali 1988; Lanczos has 3 lobes."""

Resampling = Annotated[
    Kernel,
    Doc(
        "Nearest keeps data as it is. Triangle is bilinear. Catmull-Rom and Lanczos (3 lobes) are sharp and may ring"
        " around lights. Mitchell is in between."
    ),
]
"""The filter of a node that reads its picture between pixels, as a value."""

Argument = Socket | Drawn | Scalar
"""What a GLSL function is called with: a picture or a value."""


class Reach(Struct, frozen=True):
    """The pixels that a function reads: at most `radius` across and down around a place, which is `matrix` times the
    center of the pixel that is made."""

    matrix: Affine
    radius: tuple[int, int]
    shows: bool = False
    """The picture that is made shows this one there, and goes on beyond its frame as far as that reaches."""

    @staticmethod
    def block(across: int, down: int, beside: int = 0) -> Reach:
        """For a function that makes one pixel of a block, and reads `beside` more pixels on each side."""
        matrix = (float(across), 0.0, 0.0, 0.0, float(down), 0.0)
        return Reach(matrix, (-(-across // 2) + beside, -(-down // 2) + beside))

    @staticmethod
    def within(across: int, down: int, beside: int = 0) -> Reach:
        """For a function that reads the pixel of a smaller picture that stands for its block, and `beside` more."""
        return Reach((1.0 / across, 0.0, 0.0, 0.0, 1.0 / down, 0.0), (1 + beside, 1 + beside))


Overlap = int | tuple[int, int] | Reach
"""How many pixels a function reads around its own: on all sides, or across and down. In a picture of another size they
count from the pixel at the same relative place."""


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

    Functions are those of the node's own GLSL file and of the libraries that it includes. `result` is the type of the
    picture that is drawn; Image by default.
    """

    @property
    def size(self) -> Size:
        """The size of the node's outputs, unless a draw names another one."""
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

    @property
    def overscan(self) -> int:
        """How many pixels beyond its frame a picture may be drawn, on each side."""
        ...

    def size_of(self, pixels: Pixels) -> Size:
        """The size of an input or of a drawn picture."""
        ...

    def is_linked(self, socket: Socket) -> bool:
        """True if something is linked to this input of the node."""
        ...

    def camera(self, socket: CameraSocket, frame: int | None = None) -> CameraModel | None:
        """The camera that is linked to an input, at `frame` (one of the node's `times`); None without a link."""
        ...

    def at(self, socket: Socket, frame: int) -> Drawn:
        """An input at another frame, which must be one of the node's `times`."""
        ...

    def settings_at(self, time: float) -> Mapping[str, Any]:
        """The values of the node by name, as they are at a time in frames, which may lie between two of them."""
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

        The function reads inputs, and keyword arguments that are pictures, by functions named after them:
        `image_at(ivec2)`, `image_near(vec2)` and `image_size`. The other keyword arguments are the parameters of the
        function, in order: so these cannot be called `size`, `edge`, `result` or `overlap`.

        `overlap` is how many pixels around its own the function reads at most, including those that `near`
        interpolates: of all pictures, or by name. Without it the function may read all pixels, and large pictures
        cannot be rendered in tiles.
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
        """Draw several pictures in one pass: the last parameters of `function` are an `out` for each of `results`."""
        ...

    def point(self, function: str, /, *inputs: Socket, result: Socket | None = None, **arguments: Argument) -> Drawn:
        """Call a pointwise `function`: all arguments, pictures too, are its parameters, in order. It can fuse."""
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
        """Run a complete shader program over every pixel of `size`. It makes four channels.

        `pictures` are by the names of the program's samplers, which interpolate and repeat the border pixels. Pixels
        that the program does not draw stay black.
        """
        ...

    def formula(self, text: str, **names: Argument) -> Drawn:
        """Four channels for each pixel, by a formula in the language of expressions.

        It can use pictures and numbers by these names, and the time. The node's GLSL file includes lib/formula.glsl.
        """
        ...

    def blur(
        self, image: Pixels, sigma: float | tuple[float, float], edge: Edge = "clamp", *, precise: bool = False
    ) -> Drawn:
        """Blur with a Gaussian; `sigma` is in pixels. A large sigma is computed on a smaller picture, to about 3e-4.

        If it is `precise`, for what subtracts blurs or decides by them, that begins at 7 pixels instead of 4.1.
        """
        ...

    def spread(self, image: Pixels, weights: tuple[float, ...], edge: Edge = "clamp") -> Drawn:
        """Blur along both axes with an odd number of centered weights that fall off smoothly.

        Many weights are computed on a smaller picture: then the spread of a single pixel is exact to 1e-3.
        """
        ...

    def convolve(
        self, image: Pixels, weights: tuple[float, ...], axis: Literal["x", "y"], edge: Edge = "clamp"
    ) -> Drawn:
        """Blur along one axis with an odd number of centered weights."""
        ...

    def convolve_2d(self, image: Pixels, kernel: Pixels) -> Drawn:
        """Convolve every channel with the same channel of another picture, of any size. Outside of pictures is black.

        The origin of the kernel is its center, pixel `size // 2`; the kernel is not normalized. It is computed by fast
        Fourier transforms, exact up to rounding.
        """
        ...

    def recolor(self, image: Pixels, change: ColorChange) -> Drawn:
        """Convert straight color exactly as OpenColorIO does; alpha stays. It can fuse, as `point` does."""
        ...

    def pad(self, image: Pixels, margin: tuple[int, int], edge: Edge = "clamp") -> Drawn:
        """Add `margin` pixels on the left and right, and above and below, as the edge mode says; below 0 cuts them off.

        For effects in several sizes, whose edge modes would mean other pixels in each of them.
        """
        ...

    def place(self, image: Pixels, matrix: Affine, kernel: Kernel, edge: Edge = "black") -> Drawn:
        """Move, rotate and scale: `matrix` maps a pixel of the result to its place in `image`.

        The kernel is wider where the picture shrinks. Two placements in a row with the same edge become one: pixels are
        filtered once, and parts that left the frame in between are still there.
        """
        ...

    def raster(
        self,
        scene: Scene,
        motions: tuple[Motion, Motion, Motion],
        cameras: tuple[CameraModel, CameraModel, CameraModel],
        near: float,
    ) -> Mapping[str, Drawn]:
        """Draw the meshes of a scene as a camera sees them. Motions and cameras are those of now, before and after.

        Returns `albedo` and `emission` (opaque on surfaces), `normal` (unit, toward the camera), `place` (world x, y, z
        and planar depth), `metal_rough`, `velocity` (pixels from the previous frame and to the next one, y down) and
        `surface` (u, v, object, material; numbered from 1). All are 0 on the background. Parts nearer than `near` are
        cut off.
        """
        ...

    def reduce(self, image: Pixels, operation: Literal["sum", "max"]) -> Drawn:
        """The sum or maximum of every channel over all pixels, as a picture of 1x1; exact at any size."""
        ...

    def history(self, first: Pixels, name: str = "") -> Drawn:
        """The picture that this node remembered in the previous frame; `first` in the first frame.

        For `Temporal` nodes. A node that remembers several pictures gives each a `name`.
        """
        ...

    def remember(self, pixels: Drawn, name: str = "") -> None:
        """Keep a picture for the next frame. For `Temporal` nodes."""
        ...

    def table(self, numbers: Sequence[float], width: int) -> Drawn:
        """Numbers as a picture of four channels with `width` pixels in a row, for functions to read."""
        ...

    def fill(self, mask: Pixels, fills: Sequence[OutlineFill]) -> Drawn:
        """A mask of one channel, changed by outlines one after the other: by how much of each pixel they cover.

        The node's GLSL file includes lib/paths.glsl.
        """
        ...

    def host(self, program: HostProgram, /, result: Socket | None = None, **pictures: Pixels) -> Drawn:
        """Run a program on the processor, which reads whole pictures by name and makes one of the node's size.

        Pictures that go on beyond their frame are handed over and made as a whole, all as large as the largest.
        The renderer downloads the pictures and runs it on a thread of its own. Its result is kept like all others.
        """
        ...

    def render(self, path: str, named: Mapping[str, str] = MappingProxyType({})) -> Render:
        """The layers of a render's file by role. `named` are layers that the user has chosen for a role.

        For `Source` nodes.
        """
        ...

    def typeset(self, block: TextBlock, /) -> TypesetText:
        """The outlines of a text, shaped and broken into lines as its scripts need it."""
        ...

    def expand_text(self, text: str, picture: Socket, /) -> str:
        """A text with its tokens replaced, such as `{frame}`; those about a file are about the one that is the source
        of `picture`. Raises GraphError for an unknown token.
        """
        ...

    def read(self, path: str, layer: str, result: Socket, space: str = "") -> Drawn:
        """A layer of a picture file as a picture of type `result`. `space` is its color space, "" to recognize it."""
        ...

    def asset(self, path: str, folder: str) -> Drawn:
        """A picture of the node itself, at its own size. The file must lie in `folder`, also behind links."""
        ...
