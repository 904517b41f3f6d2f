import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Literal, Self

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Pixels, Size, Slider, Trait

_LOBES = 3.0
"""The reach of the widest filter, Lanczos, in pixels of the smaller picture."""


class Resize(Filter):
    """Make the picture larger or smaller in pixels.

    The filter covers pixels of the source when it enlarges and pixels of the result when it shrinks, so that nothing
    aliases. Catmull-Rom and Mitchell: Mitchell and Netravali 1988. The size is rounded to whole pixels, at least one.
    """

    aliases = (
        "reformat", "scale", "scale image", "resample", "change resolution", "resolution", "canvas size", "letterbox",
        "fit", "downscale", "image size", "down-res", "up-res", "tv scale",
        "pixel aspect ratio", "anamorphic", "unsqueeze", "desqueeze", "square pixels",
    )  # fmt: skip
    traits = (Trait.RESAMPLES, Trait.STRETCHES)

    image = Image()
    out = OutputSocket(follows="image")
    scale: Annotated[
        tuple[float, float],
        Slider(0.1, 4.0, unit="ratio", minimum=0.001, maximum=64.0, doc="Factor on the width and on the height."),
    ] = (1.0, 1.0)
    square_pixels: Annotated[
        bool,
        Doc(
            "Multiply the width by the pixel aspect ratio of the picture, so that its pixels become square: "
            "for an anamorphic plate it is doubled."
        ),
    ] = False
    kernel: Annotated[
        Literal["box", "triangle", "catmull-rom", "mitchell", "lanczos"],
        Doc(
            "Box averages exactly the area that a pixel covers and keeps enlarged pixels hard. "
            "Triangle is soft. Catmull-Rom and Lanczos (3 lobes) are sharp and may ring around "
            "lights. Mitchell is in between."
        ),
    ] = "triangle"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.scale == (1.0, 1.0) else None

    def with_pixel_aspect(self, aspect: float) -> Self:
        return replace(self, scale=(self.scale[0] * aspect, self.scale[1])) if self.square_pixels else self

    def output_size(self, inputs: Mapping[str, Size], canvas: Size) -> Size:
        width, height = super().output_size(inputs, canvas)
        return (max(round(width * self.scale[0]), 1), max(round(height * self.scale[1]), 1))

    def passes(self, draw: Draw) -> Drawn:
        # Across a pole of a panorama lies the pixel half a turn away: whole pixels only at the full width.
        first, last = (1, 0) if self.edge == "panorama" else (0, 1)
        return self._resample(draw, self._resample(draw, self.image, first), last)

    def _resample(self, draw: Draw, picture: Pixels, axis: int) -> Drawn:
        before, after = draw.size_of(picture), draw.size
        shrink = before[axis] / after[axis]
        reach = math.ceil(_LOBES * max(shrink, 1.0)) + 2
        return draw(
            "resize",
            image=picture,
            size=(before[0], after[1]) if axis else (after[0], before[1]),
            edge=self.edge,
            overlap=(0, reach) if axis else (reach, 0),
            axis=axis,
            shrink=shrink,
            kernel=self.kernel,
        )
