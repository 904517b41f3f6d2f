from typing import Annotated, Any, Literal

from .._declare import (
    Doc,
    Draw,
    Drawn,
    Filter,
    HostProgram,
    Image,
    ProxyNote,
    Slider,
    Stops,
    Trait,
    Vector,
    ramp_knots,
)


class ColorPalette(Filter):
    """Reduce a picture to a few colors, given or found in it, with dithering between them.

    Every pixel gets the nearest color of the palette, by the distance of sRGB values. A pattern is added before, so
    that areas of two colors look like those between them; or what a pixel is off by goes to its neighbors. Works on the
    color without its alpha; alpha stays. To find colors, and to diffuse errors, takes the processor, and each frame is
    a picture of its own there: its dots do not stay.
    """

    aliases = (
        "indexed color", "reduce colors", "quantize", "color quantization", "pixel art colors", "retro",
        "ordered dither", "nearest color", "limited palette", "gameboy", "color count", "error diffusion",
        "floyd steinberg", "median cut", "k-means",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR,)

    proxy_notes = (ProxyNote(("out",), "its pattern is made of whole pixels, and its colors do not mix", "look"),)

    image = Image()
    palette: Annotated[
        Literal["given", "found"],
        Doc(
            "The colors that are given, or as many as `count` that are found in the picture: by cuts where colors "
            "differ most (Wan et al. 1990), then k-means (Lloyd 1982)."
        ),
    ] = "given"
    colors: Annotated[Stops, Doc("The palette: the colors of the stops. Their places do not matter.")] = (
        0.0, 0.005, 0.03, 0.005, 1.0,
        0.33, 0.03, 0.12, 0.03, 1.0,
        0.67, 0.26, 0.41, 0.005, 1.0,
        1.0, 0.33, 0.5, 0.005, 1.0,
    )  # fmt: skip
    count: Annotated[int, Slider(2, 64, unit="count", minimum=2, maximum=256, doc="How many colors are found.")] = 16
    dither: Annotated[
        Literal["none", "bayer 2", "bayer 4", "bayer 8", "blue noise", "error diffusion"],
        Doc(
            "The pattern: Bayer matrices (1973) of 2, 4 or 8 cells on a side, or blue noise (Ulichney 1993). Or errors "
            "are diffused to the pixels right and below (Floyd and Steinberg 1976)."
        ),
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
        if self.palette == "given" and self.dither != "error diffusion":
            return draw.point(
                "color_palette", self.image, colors=ramp_knots(self.colors), count=len(self.colors) // 5,
                dither=self.dither, spread=self.spread, size=self.size,
            )  # fmt: skip
        four = Vector(width=4)
        pictures: dict[str, Any] = {"codes": draw.point("color_palette_codes", self.image, result=four)}
        if self.dither not in ("none", "error diffusion"):
            pictures["pattern"] = draw.point(
                "color_palette_pattern", codes=pictures["codes"], dither=self.dither, spread=self.spread,
                size=self.size, result=four,
            )  # fmt: skip
        given = (part for first in range(0, len(self.colors), 5) for part in self.colors[first + 1 : first + 4])
        settings = (
            ("colors", " ".join(map(str, given)) if self.palette == "given" else ""),
            ("count", float(self.count)),
            ("diffused", self.dither == "error diffusion"),
        )
        reduced = draw.host(HostProgram("reduce_colors", settings), **pictures)
        return draw.point("color_palette_join", self.image, reduced=reduced)
