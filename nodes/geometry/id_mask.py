import re
from collections.abc import Mapping
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Field, Filter, Image, OutputSocket, ProxyNote

_SPANS = 16
"""Spans of numbers that one draw looks at."""

_NUMBER = r"(-?\d+(?:\.\d+)?)"
_SPAN = re.compile(rf"(?<![\w.]){_NUMBER}(?:\s*-\s*{_NUMBER})?(?![\w.])")


class IdMask(Filter):
    """Cut out objects or materials by their numbers, exactly: a pixel is in the mask or not.

    For passes of one number per pixel, such as object and material index. Cryptomatte does the same with soft edges.
    """

    aliases = (
        "id matte", "object id", "material id", "object mask", "index matte", "object index", "material index",
        "multimatte", "puzzle matte", "matte from id", "index mask",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("colors",), "it has hard edges between strong colors, as wide as a pixel of the proxy"),)

    ids = Field(doc="Numbers of objects or materials.")
    pick: Annotated[str, Doc("Numbers and ranges of numbers, such as 1, 4, 7-9.")] = "1"
    invert: Annotated[bool, Doc("Mask everything else.")] = False

    mask = OutputSocket(Field(doc="1 or 0."))
    colors = OutputSocket(Image(doc="A color for every number, which shows where each one is; 0 is black."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        mask, spans = draw.point("id_mask_none", result=Field()), _spans(self.pick)
        for first in range(0, len(spans), _SPANS):
            chosen = [*spans[first : first + _SPANS], *[(1.0, 0.0)] * _SPANS][:_SPANS]
            flat = tuple(end for span in chosen for end in span)
            mask = draw.point("id_mask_add", self.ids, result=Field(), mask=mask, spans=flat)
        return {
            "mask": draw.point("id_mask", result=Field(), matte=mask, invert=self.invert),
            "colors": draw.point("id_mask_colors", self.ids),
        }


def _spans(pick: str) -> list[tuple[float, float]]:
    """The spans of numbers that a text names; other words are skipped."""
    return [(float(match[1]), float(match[2] or match[1])) for match in _SPAN.finditer(pick)]
