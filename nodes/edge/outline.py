from collections.abc import Mapping
from math import ceil, log2
from typing import Annotated, Literal

from .._declare import RGBA, Doc, Draw, Drawn, Field, Filter, Image, OutputSocket, Pixels, ProxyNote, Slider, Vector

_DEEP = 1e6
"""Pixels inside of the contour: deeper than any picture is wide, so that all of the inside belongs to the line."""


class Outline(Filter):
    """Draw a line of any width around a mask, or around the picture's own alpha.

    The line follows the exact distance to the contour, where the mask crosses one half (see Distance Field). A wider
    line costs little more. Around the picture's own alpha, an outside line lies behind the picture.
    """

    aliases = ("stroke", "contour", "cel outline", "ink", "toon lines", "line art", "freestyle", "border", "vegas")

    proxy_notes = (ProxyNote(("line", "out"), "its lines have hard edges, and a proxy averages small specks away"),)

    image = Image()
    mask = Field(0.0, doc="The mask that gets the line. Without a link, it is the picture's alpha.")
    position: Annotated[Literal["outside", "inside", "center"], Doc("On which side of the contour the line lies.")] = (
        "outside"
    )
    width: Annotated[float, Slider(0.0, 50.0, unit="px", minimum=0.0, maximum=1000.0, doc="Width of the line.")] = 4.0
    softness: Annotated[
        float,
        Slider(0.0, 50.0, unit="px", minimum=0.0, maximum=1000.0, doc="Over how many pixels the line's edges fade."),
    ] = 0.0
    color: Annotated[RGBA, Doc("The line's color; its alpha is how much it covers.")] = (1.0, 1.0, 1.0, 1.0)

    out = OutputSocket()
    line = OutputSocket(Field(doc="How much of each pixel the line covers."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Find for each pixel the nearest edge of the mask in its column, with steps that halve, then the nearest of
        those in its row: the exact distance, at a cost that grows with the logarithm of the width.

        A line outside the picture's own alpha lies behind the picture and is filled all the way inside: else the
        background would shine through between a soft edge and the line.
        """
        mask: Pixels = (
            self.mask if draw.is_linked(self.mask) else draw.point("outline_alpha", self.image, result=Field())
        )
        reach = ceil(self.width + 0.5 * self.softness) + 2
        columns = draw.point("outline_seeds", result=Vector(width=2), mask=mask)
        for level in reversed(range(ceil(log2(reach + 1)))):
            columns = draw(
                "outline_columns", seeds=columns, overlap=(0, 2**level), result=Vector(width=2), reach=2**level
            )
        contour = draw(
            "outline_distance",
            mask=mask,
            columns=columns,
            overlap={"mask": reach + 1, "columns": (reach, 0)},
            result=Field(),
            reach=reach,
        )
        behind = self.position == "outside" and not draw.is_linked(self.mask)
        first, last = {
            "outside": (0.0, self.width),
            "inside": (-self.width, 0.0),
            "center": (-self.width / 2, self.width / 2),
        }[self.position]
        line = draw.point(
            "outline_line", result=Field(), contour=contour, first=first, last=last, fade=1.0 + self.softness
        )
        under = (
            draw.point(
                "outline_line", result=Field(), contour=contour, first=-_DEEP, last=last, fade=1.0 + self.softness
            )
            if behind
            else line
        )
        out = draw.point("outline", self.image, line=under, color=self.color, behind=behind)
        return {"out": out, "line": line}
