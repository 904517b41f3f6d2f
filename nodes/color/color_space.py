from typing import Annotated

from .._declare import Doc, Draw, Drawn, Filter, Image, SpaceChange
from ._spaces import SPACES, WORKING, Space


class ColorSpace(Filter):
    """Convert colors from one space to another: primaries, white point and encoding.

    Between nodes pictures are in linear Rec.709: convert to another space for an operation that wants it, and back. To
    the HDR displays (PQ, HLG) 1 is 100 cd/m2. Computed by OpenColorIO's own GLSL from its ACES studio config, exactly.
    Works on the color without its alpha; alpha stays.
    """

    image = Image()
    source: Annotated[Space, Doc("What the numbers are in.")] = WORKING
    target: Annotated[Space, Doc("What they come out in.")] = "acescg"

    def identity(self) -> str | None:
        return "image" if self.source == self.target else None

    def passes(self, draw: Draw) -> Drawn:
        color = draw.point("color_space_color", self.image)
        changed = draw.recolor(color, SpaceChange(SPACES[self.source], SPACES[self.target]))
        return draw.point("color_space", self.image, changed=changed)
