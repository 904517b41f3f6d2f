from typing import Annotated

from .._declare import Doc, Draw, Drawn, Filter, Fraction, Image, LookupFile, SpaceChange, TablePath, Trait
from ._spaces import WORKING, Space, name_space


class LutFile(Filter):
    """Apply a lookup table or a list of color operations from a file: .cube, .3dl, .csp, .spi3d, .clf, .cc, .icc, ...

    Choose the color spaces that the table was made for. Most looks take a camera's log or sRGB values, and give values
    for a display, which the node brings back to scene light. The result is OpenColorIO's own GLSL, so it is exact;
    tables of three dimensions use tetrahedral interpolation. Works on the color without its alpha; alpha stays. Without
    a file the picture passes unchanged.
    """

    aliases = (
        "lut", "apply color lut", "3d lut", "cube", "vectorfield", "file lut", "ocio file transform", "apply lut",
        "look up table", "film look", "csp", "truelight",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.CHANGES_ENCODING)

    image = Image()
    file: Annotated[TablePath, Doc("The table. A relative path starts at the folder of the graph.")] = ""
    takes: Annotated[Space, Doc("The color space that the table expects.")] = WORKING
    gives: Annotated[Space, Doc("The color space that the table gives.")] = WORKING
    inverse: Annotated[bool, Doc("Undo the table, where it has an inverse.")] = False
    amount: Annotated[Fraction, Doc("Mix with the input.")] = 1.0

    def identity(self) -> str | None:
        return "image" if not self.file or self.amount == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        first, last = (self.gives, self.takes) if self.inverse else (self.takes, self.gives)
        color = draw.point("lut_file_color", self.image)
        if first != WORKING:
            color = draw.recolor(color, SpaceChange(name_space(WORKING), name_space(first)))
        color = draw.recolor(color, LookupFile(self.file, self.inverse))
        if last != WORKING:
            color = draw.recolor(color, SpaceChange(name_space(last), name_space(WORKING)))
        return draw.point("lut_file", self.image, changed=color, amount=self.amount)
