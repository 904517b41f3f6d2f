from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Image, Trait


class Stereo(Filter):
    """Combine the pictures of the left and the right eye: for colored glasses, or packed into one frame.

    The anaglyph of Dubois (2001) has the least error for red and cyan glasses and bright displays. Packed pictures are
    squeezed to half the width or height, as displays and video files expect them.
    """

    aliases = (
        "stereo", "anaglyph", "3d glasses", "side by side", "over under", "top bottom", "stereoscopic", "join views",
        "stereo combine", "red cyan", "interlaced stereo", "split and join", "dubois", "shuffle views", "stereo align",
        "combiner",
    )  # fmt: skip
    traits = (Trait.USES_ALPHA,)

    left = Image()
    right = Image()
    format: Annotated[
        Literal[
            "dubois", "color anaglyph", "half color anaglyph", "gray anaglyph", "side by side", "top and bottom",
            "interlaced",
        ],
        Doc(
            "The first four are for red and cyan glasses, with more color and more discomfort from gray to color. "
            "Interlaced: even rows are those of the left eye."
        ),
    ] = "dubois"  # fmt: skip
    swap: Annotated[bool, Doc("Exchange left and right.")] = False

    def passes(self, draw: Draw) -> Drawn:
        first, second = (self.right, self.left) if self.swap else (self.left, self.right)
        if self.format in ("side by side", "top and bottom"):
            return draw("stereo_packed", first=first, second=second, format=self.format)
        return draw.point("stereo_mixed", first=first, second=second, format=self.format)
