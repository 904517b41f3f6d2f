from collections.abc import Mapping
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Filter, Image, OutputSocket, Position, Size, Slider, Trait


class Crop(Filter):
    """Keep a rectangle of the picture.

    Corners are fractions of the picture and are rounded to whole pixels. At least one pixel remains.
    """

    aliases = (
        "trim", "letterbox", "cut", "region of interest", "adjust bbox", "black outside", "rectangle", "matte bars",
        "adjust bounding box", "border", "aspect bars", "set domain", "auto domain",
    )  # fmt: skip
    traits = (Trait.CUTS_OUT,)

    image = Image()
    out = OutputSocket(follows="image")
    top_left: Annotated[Position, Doc("One corner of what is kept.")] = (0.0, 0.0)
    bottom_right: Annotated[Position, Doc("The opposite corner.")] = (1.0, 1.0)
    resize: Annotated[
        bool, Doc("Make the picture as small as the rectangle; off keeps the size, with nothing around the rectangle.")
    ] = True
    softness: Annotated[
        float,
        Slider(0.0, 200.0, unit="px", minimum=0.0, doc="Fade out over this many pixels inside the rectangle."),
    ] = 0.0

    def box(self, size: Size) -> tuple[int, int, int, int]:
        """Left, top, right and bottom in whole pixels of a picture of this size."""
        left, right = _span(self.top_left[0], self.bottom_right[0], size[0])
        top, bottom = _span(self.top_left[1], self.bottom_right[1], size[1])
        return left, top, right, bottom

    def identity(self) -> str | None:
        corners = ((0.0, 0.0), (1.0, 1.0))
        return "image" if (self.top_left, self.bottom_right) == corners and self.softness == 0.0 else None

    def output_size(self, inputs: Mapping[str, Size], canvas: Size) -> Size:
        size = super().output_size(inputs, canvas)
        left, top, right, bottom = self.box(size)
        return (right - left, bottom - top) if self.resize else size

    def passes(self, draw: Draw) -> Drawn:
        left, top, right, bottom = self.box(draw.size_of(self.image))
        start = (float(left), float(top)) if self.resize else (0.0, 0.0)
        return draw(
            "crop",
            self.image,
            start=start,
            box=(float(left), float(top), float(right), float(bottom)),
            softness=self.softness,
        )


def _span(start: float, end: float, length: int) -> tuple[int, int]:
    """Between two fractions of a length, in whole pixels, at least one of them."""
    low, high = (round(min(max(end, 0.0), 1.0) * length) for end in sorted((start, end)))
    low = min(low, length - 1)
    return low, max(high, low + 1)
