from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    Doc,
    Draw,
    Drawn,
    Field,
    Image,
    OutputSocket,
    Picks,
    Reader,
    RenderPath,
    Vector,
    matte_of,
    pick_ids,
)

_AT_ONCE = 32
"""Ids that one draw looks for: two to a vector."""


class Cryptomatte(Reader):
    """Cut out objects, materials or assets by name, with soft edges and motion blur as in the render.

    Reads the cryptomatte layers of a render (Friedman and Jones 2015, by Psyop's specification 1.2.0): the matte is the
    exact sum of the coverage of all chosen ids. Names are looked up in the file's manifest, else hashed.
    """

    aliases = (
        "crypto", "object matte", "encryptomatte", "matte", "object id", "material id", "mask by name", "psyop",
        "pick object",
    )  # fmt: skip

    path: Annotated[RenderPath, Doc("The render, relative to the graph's folder.")] = ""
    layer: Annotated[Literal["object", "material", "asset"], Doc("What the ids stand for.")] = "object"
    pick: Annotated[
        str,
        Picks("layer"),
        Doc(
            'Names, such as monkey, ring_*, "with, comma". In a name, * stands for any text, ? '
            "for any letter, and [ab] for one of these letters. Names after a minus are excluded:"
            " *, -floor."
        ),
    ] = "*"
    invert: Annotated[bool, Doc("Mask everything else.")] = False

    matte = OutputSocket(Field(doc="How much of each pixel the chosen names cover, 0..1."))
    colors = OutputSocket(Image(doc="A color for every id, which shows where each one is."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        matte = matte_of(draw.render(self.path).mattes, self.layer)
        if matte is None:
            return {}
        ranks = [draw.read(self.path, layer, Vector(width=4)) for layer in matte.layers]
        ids = sorted(pick_ids(self.pick, matte.ids))
        coverage = draw.point("cryptomatte_nothing", result=Field())
        if not matte.ids and self.pick.strip() == "*":
            for layer in ranks:
                coverage = draw.point("cryptomatte_anything", result=Field(), coverage=coverage, ranks=layer)
        for first in range(0, len(ids), _AT_ONCE):
            batch = ids[first : first + _AT_ONCE]
            # Halves of the bits: floats hold them exactly, and no driver takes them for a number that it may change.
            halves = [float(half) for bits in batch for half in (bits >> 16, bits & 0xFFFF)]
            halves += [0.0] * (2 * _AT_ONCE - len(halves))
            for layer in ranks:
                coverage = draw.point(
                    "cryptomatte_covered",
                    result=Field(),
                    coverage=coverage,
                    ranks=layer,
                    ids=tuple(halves),
                    count=len(batch),
                )
        colors = draw.point("cryptomatte_no_colors", result=Vector(width=4))
        for layer in ranks:
            colors = draw.point("cryptomatte_mixed", result=Vector(width=4), colors=colors, ranks=layer)
        return {
            "matte": draw.point("cryptomatte", result=Field(), coverage=coverage, invert=self.invert),
            "colors": draw.point("cryptomatte_colors", colors=colors),
        }
