import math
from typing import Annotated, Literal

from .._declare import Dial, Doc, Draw, Drawn, Edge, Fraction, Image, Position, Slider, Temporal, Vector

_SMALLEST = 1e-3
"""No scale is nearer to 0."""


class Feedback(Temporal):
    """Feed the picture back into itself: tunnels, spirals and trails that drift, rotate and change color.

    The previous result is scaled and rotated around the pivot and moved. Its hue is rotated, it fades, and it is
    combined with the picture. It is read by Catmull-Rom interpolation (Mitchell and Netravali 1988), limited to the
    range of the four pixels around, so that it stays sharp and never rings. No light exceeds the ceiling. The history
    is kept in 32 bits. The first frame is its own previous result.
    """

    aliases = (
        "trails", "video feedback", "recursion", "previous frame", "loop", "feedback loop", "tunnel", "infinite zoom",
        "image loop",
    )  # fmt: skip

    image = Image()
    position: Annotated[
        tuple[float, float],
        Slider(-50.0, 50.0, unit="px", doc="How far the previous result moves in each frame, to the right and down."),
    ] = (0.0, 0.0)
    rotation: Annotated[
        float, Slider(-15.0, 15.0, unit="deg", doc="How far it rotates in each frame, clockwise."), Dial("clockwise")
    ] = 2.0
    scale: Annotated[
        float,
        Slider(
            0.8, 1.25, unit="ratio", minimum=_SMALLEST, maximum=1000.0, doc="Its scale in each frame; above 1 it grows."
        ),
    ] = 1.06
    pivot: Annotated[Position, Doc("The point around which it rotates and grows.")] = (0.5, 0.5)
    hue: Annotated[float, Slider(-60.0, 60.0, unit="deg", doc="How far hues rotate in each frame.")] = 10.0
    decay: Annotated[Fraction, Doc("The part that is left after one frame.")] = 0.9
    mode: Annotated[
        Literal["brightest", "add", "screen", "over", "mix"],
        Doc(
            "How the picture is combined with the previous result. Over covers it by alpha. Mix "
            "keeps the exposure: 1 - decay of the picture, and decay of the previous result."
        ),
    ] = "brightest"
    ceiling: Annotated[
        float,
        Slider(1.0, 100.0, unit="scene", minimum=0.0, maximum=65504.0, doc="The largest light that is fed back."),
    ] = 50.0
    edge: Annotated[Edge, Doc("What lies outside the screen.")] = "black"

    def passes(self, draw: Draw) -> Drawn:
        width, height = draw.size
        pivot = (self.pivot[0] * width, self.pivot[1] * height)
        cos, sin = (part / max(self.scale, _SMALLEST) for part in (math.cos(self.rotation), math.sin(self.rotation)))
        first = draw.point("feedback_first", self.image, ceiling=self.ceiling, result=Vector(width=4))
        # Where a pixel of the screen was in the frame before: across and down are the rows of the matrix.
        across, down = (cos, sin), (-sin, cos)
        moved = (pivot[0] + self.position[0], pivot[1] + self.position[1])
        start = tuple(at - row[0] * moved[0] - row[1] * moved[1] for at, row in zip(pivot, (across, down), strict=True))
        past = draw(
            "feedback_past",
            history=draw.history(first),
            edge=self.edge,
            result=Vector(width=4),
            across=across,
            down=down,
            start=start,
            hue_turn=self.hue / (2.0 * math.pi),
            decay=self.decay,
        )
        joined = draw.point("feedback", self.image, past=past, mode=self.mode, decay=self.decay, result=Vector(width=4))
        draw.remember(draw.point("feedback_first", image=joined, ceiling=self.ceiling, result=Vector(width=4)))
        return joined
