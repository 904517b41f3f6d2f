import math
from typing import Annotated

from .._declare import Draw, Drawn, Field, Filter, OutputSocket, Pixels, ProxyNote, Slider, Socket, Vector


class FillHoles(Filter):
    """Close the holes of a matte: dark parts from which no dark way leads out of the picture.

    A soft matte is filled as far as it must be crossed: every pixel becomes the highest value on the lowest way out
    (reconstruction by erosion, Vincent 1993). Ways go up, down, left and right, not across corners.
    """

    aliases = (
        "fill holes", "close holes", "binary fill holes", "fill matte", "solid matte", "matte fill", "hole filler",
        "clean matte", "flood fill", "core matte",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("out",), "a gap of one pixel is a way out of a hole"),)

    matte = Field(doc="A matte, 0..1.")
    turns: Annotated[
        int,
        Slider(
            1,
            16,
            unit="count",
            minimum=1,
            maximum=256,
            doc="How winding a way out may be: it has at most about twice this many corners. Dark parts with more "
            "winding ways are filled.",
        ),
    ] = 6

    out = OutputSocket(Field(doc="The matte without holes."))

    def passes(self, draw: Draw) -> Drawn:
        """Ways along rows are found from both ends at once, then ways along columns, and so on.

        A pixel on a way raises what comes along it to its own value, and lowers it to what is known of it already. Such
        a limit after another one is a limit again, so that rows are joined from 1, 2, 4, ... pixels (Blelloch 1990).
        """
        filled: Pixels = draw.point("fill_holes_start", result=Field())
        for _ in range(self.turns):
            for axis, length in enumerate(draw.size):
                limits: Pixels = draw.point("fill_holes_limits", self.matte, filled=filled, result=Vector(width=4))
                for doubling in range(math.ceil(math.log2(length)) + 1):
                    limits = draw(
                        "fill_holes_double", limits=limits, edge="black", result=Vector(width=4), axis=axis,
                        reach=2**doubling,
                    )  # fmt: skip
                filled = draw.point("fill_holes_joined", limits=limits, result=Field())
        assert not isinstance(filled, Socket)
        return filled
