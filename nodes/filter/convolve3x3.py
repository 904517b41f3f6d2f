from collections.abc import Mapping
from math import fsum
from types import MappingProxyType
from typing import Annotated, Any, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, Kernel3x3, OutputSocket, ProxyNote, Slider, space_pixels

_IDENTITY: Kernel3x3 = (0, 0, 0, 0, 1, 0, 0, 0, 0)

_KERNELS: Mapping[str, Kernel3x3] = MappingProxyType(
    {
        "sharpen": (0, -1, 0, -1, 5, -1, 0, -1, 0),
        "box": (1 / 9, 1 / 9, 1 / 9, 1 / 9, 1 / 9, 1 / 9, 1 / 9, 1 / 9, 1 / 9),
        "laplacian 4": (0, 1, 0, 1, -4, 1, 0, 1, 0),
        "laplacian 8": (1, 1, 1, 1, -8, 1, 1, 1, 1),
        "laplacian isotropic": (1 / 6, 4 / 6, 1 / 6, 4 / 6, -20 / 6, 4 / 6, 1 / 6, 4 / 6, 1 / 6),
        "emboss": (2, 0, 0, 0, -1, 0, 0, 0, -1),
        "relief": (-1, -2, -1, 0, 1, 0, 1, 2, 1),
        "sobel x": (-1, 0, 1, -2, 0, 2, -1, 0, 1),
        "sobel y": (-1, -2, -1, 0, 0, 0, 1, 2, 1),
        "prewitt x": (-1, 0, 1, -1, 0, 1, -1, 0, 1),
        "prewitt y": (-1, -1, -1, 0, 0, 0, 1, 1, 1),
        "scharr x": (-3, 0, 3, -10, 0, 10, -3, 0, 3),
        "scharr y": (-3, -10, -3, 0, 0, 0, 3, 10, 3),
    }
)
"""Named after their authors, or as in textbooks. "laplacian isotropic" has rotational symmetry up to the fourth order;
"emboss" has a sum of 0, as "relief" has."""

_ZERO_SUM = 1e-9
"""A sum of weights that is 0 but for rounding: it cannot be made 1."""


class Convolve3x3(Filter):
    """Weight each pixel and its eight neighbors: sharpen, emboss, Laplacian, gradients or a kernel of your own.

    out = scale * sum(kernel * neighbors) + bias. The kernel is not flipped (correlation, not convolution).
    """

    version = 2
    aliases = (
        "convolve", "convolution", "matrix", "kernel", "custom filter", "custom convolution", "filter", "laplacian",
        "edge enhance", "soften", "shadow filter", "3x3", "matrix3x3",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("out",), "it compares neighboring pixels, which are farther apart in a proxy"),)

    image = Image()
    out = OutputSocket(follows="image")
    preset: Annotated[
        Literal[
            "custom",
            "sharpen",
            "box",
            "laplacian 4",
            "laplacian 8",
            "laplacian isotropic",
            "emboss",
            "relief",
            "sobel x",
            "sobel y",
            "prewitt x",
            "prewitt y",
            "scharr x",
            "scharr y",
        ],
        Doc("A well-known kernel; `custom` uses the nine numbers below."),
    ] = "sharpen"
    kernel: Annotated[Kernel3x3, Doc("Nine weights in reading order, for the preset `custom`.")] = _IDENTITY
    normalize: Annotated[
        Literal["none", "sum", "absolute sum"],
        Doc(
            "Divide the weights by their sum, which keeps the brightness, or by the sum of their "
            "absolute values. A sum of 0 divides nothing."
        ),
    ] = "none"
    scale: Annotated[float, Slider(-4.0, 4.0, unit="ratio", doc="Factor on the filtered color.")] = 1.0
    bias: Annotated[
        float,
        Slider(
            -1.0,
            1.0,
            unit="scene",
            doc="Added to the color, as far as alpha covers the pixel: 0.18 puts an emboss on middle gray.",
        ),
    ] = 0.0
    filter_alpha: Annotated[bool, Doc("Filter alpha like a color instead of keeping it.")] = False
    width: Annotated[
        float,
        Slider(
            0.0,
            16.0,
            unit="px",
            minimum=0.0,
            maximum=200.0,
            doc="Distance of the neighbors, in whole pixels, at least one; 0 is one pixel at any size.",
        ),
    ] = 1.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    @classmethod
    def upgrade(cls, version: int, values: dict[str, Any]) -> dict[str, Any]:
        return {"width": 0.0, **values}

    def weights(self) -> Kernel3x3:
        """The nine weights that are applied: preset, normalization and scale resolved."""
        kernel = _KERNELS.get(self.preset, self.kernel)
        total = {"none": 1.0, "sum": fsum(kernel), "absolute sum": fsum(map(abs, kernel))}[self.normalize]
        factor = self.scale / total if abs(total) > _ZERO_SUM else self.scale
        a, b, c, d, e, f, g, h, i = (weight * factor for weight in kernel)
        return (a, b, c, d, e, f, g, h, i)

    def identity(self) -> str | None:
        return "image" if self.weights() == _IDENTITY and self.bias == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        step = space_pixels(self.width).step
        return draw(
            "convolve3x3",
            self.image,
            edge=self.edge,
            overlap=step,
            kernel=self.weights(),
            spacing=step,
            bias=self.bias,
            filter_alpha=self.filter_alpha,
        )
