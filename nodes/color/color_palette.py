from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Image, ProxyNote, Slider, Stops, Trait, ramp_knots


class ColorPalette(Filter):
    """Reduce a picture to a few given colors, with ordered dithering between them.

    Every pixel gets the nearest color of the palette, by the distance of sRGB values. A pattern is added before, so
    that areas of two colors look like those between them. Works on the color without its alpha; alpha stays.
    """

    aliases = (
        "indexed color", "reduce colors", "quantize", "color quantization", "pixel art colors", "retro",
        "ordered dither", "nearest color", "limited palette", "gameboy", "color count",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR,)

    proxy_notes = (ProxyNote(("out",), "its pattern is made of whole pixels, and its colors do not mix", "look"),)

    image = Image()
    colors: Annotated[Stops, Doc("The palette: the colors of the stops. Their places do not matter.")] = (
        0.0, 0.005, 0.03, 0.005, 1.0,
        0.33, 0.03, 0.12, 0.03, 1.0,
        0.67, 0.26, 0.41, 0.005, 1.0,
        1.0, 0.33, 0.5, 0.005, 1.0,
    )  # fmt: skip
    dither: Annotated[
        Literal["none", "bayer 2", "bayer 4", "bayer 8", "blue noise"],
        Doc("The pattern: Bayer matrices (1973) of 2, 4 or 8 cells on a side, or blue noise (Ulichney 1993)."),
    ] = "bayer 4"
    spread: Annotated[
        float,
        Slider(
            0.0, 1.0, unit="ratio", minimum=0.0, maximum=4.0,
            doc="How strong the pattern is: the distance between neighboring colors of the palette, as sRGB values.",
        ),
    ] = 0.25  # fmt: skip
    size: Annotated[
        float, Slider(1.0, 16.0, unit="px", minimum=0.01, doc="The side of a dot of the pattern, at least one pixel.")
    ] = 1.0

    def passes(self, draw: Draw) -> Drawn:
        return draw.point(
            "color_palette", self.image, colors=ramp_knots(self.colors), count=len(self.colors) // 5,
            dither=self.dither, spread=self.spread, size=self.size,
        )  # fmt: skip
