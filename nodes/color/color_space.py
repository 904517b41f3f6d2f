from typing import Annotated

from .._declare import Doc, Draw, Drawn, Filter, Image, OfSpace, SpaceChange, Trait
from ._spaces import WORKING, Space, name_space


class ColorSpace(Filter):
    """Convert colors from one space to another: primaries, white point and encoding.

    Between nodes, pictures are in the working space: linear Rec.709, unless the graph names another one. Convert to
    another space for an operation that needs it, and then back. `source_name` and `target_name` can name a space of the
    graph's color config. For the HDR displays (PQ, HLG), the number 1 is 100 cd/m2. The conversion is OpenColorIO's own
    GLSL, so it is exact. A space that the config does not have comes from the ACES studio config. Works on the color
    without its alpha; alpha stays.
    """

    aliases = (
        "colorspace", "convert colorspace", "color space transform", "cst", "ocio color space", "ocio display",
        "ocio log convert", "log to lin", "log2lin", "lin to log", "linear to log", "cineon converter", "cineon log",
        "color profile converter", "color management", "aces", "acescg", "srgb to linear", "linearize", "gamut",
        "gamut mapping", "convert to display", "rec709", "alexa log", "plog lin",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.CHANGES_ENCODING)

    image = Image()
    source: Annotated[Space, Doc("The color space of the input.")] = WORKING
    target: Annotated[Space, Doc("The color space of the output.")] = "acescg"
    source_name: Annotated[
        str, OfSpace(), Doc("A space or role of the graph's color config, in place of the source.")
    ] = ""
    target_name: Annotated[
        str, OfSpace(), Doc("A space or role of the graph's color config, in place of the target.")
    ] = ""

    def identity(self) -> str | None:
        return "image" if self._names[0] == self._names[1] else None

    @property
    def _names(self) -> tuple[str, str]:
        return self.source_name or name_space(self.source), self.target_name or name_space(self.target)

    def passes(self, draw: Draw) -> Drawn:
        color = draw.point("color_space_color", self.image)
        changed = draw.recolor(color, SpaceChange(*self._names))
        return draw.point("color_space", self.image, changed=changed)
