import math
from collections.abc import Mapping
from typing import Annotated

from .._declare import (
    RGBA,
    Dial,
    Doc,
    Draw,
    Drawn,
    Edge,
    Filter,
    Fraction,
    Image,
    OutputSocket,
    ProxyNote,
    Reach,
    Size,
    Slider,
    Trait,
)

_NO_LIMIT = 65504.0
"""The largest half float: nothing that passes keep is brighter."""

_SQUARE = 1e-5
"""Turned by less, in radians, the arms lie along rows and columns: a pixel off at the end of the largest picture."""


class Star(Filter):
    """Put a four-pointed star on bright light, as a cross filter on a lens does.

    The bright light is blurred by a Gaussian in one direction (u) and separately in the other one (v), and both are
    added: `out = image + intensity / 2 (G_u light + G_v light)` (the star of TU Wien's "Screenspace Effects"). `glow`
    is the star alone. Without threshold and limit it is linear and has the same sum as the light. If the star is
    turned, the light is rotated, blurred and rotated back. That makes the arms softer by less than a pixel, and keeps
    the sum of lights of a single pixel only within 7 percent. Alpha is kept.
    """

    aliases = (
        "star glow", "glint", "starburst", "cross filter", "star filter", "sparkles", "star burst", "twinkle",
        "simple star", "highlight", "lens flare",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT, Trait.NEEDS_HIGHLIGHTS)
    proxy_notes = (ProxyNote(("glow",), "the average of several pixels exceeds a threshold less often"),)

    image = Image()
    length: Annotated[
        float, Slider(0.0, 0.3, unit="height", minimum=0.0, maximum=1.0, doc="Standard deviation along an arm.")
    ] = 0.08
    angle: Annotated[
        float,
        Slider(-45.0, 45.0, unit="deg", doc="How far the star is turned, counterclockwise."),
        Dial("counterclockwise"),
    ] = 45.0
    intensity: Annotated[
        float, Slider(0.0, 4.0, unit="ratio", minimum=0.0, doc="How much of the bright light goes into the star.")
    ] = 0.4
    tint: Annotated[RGBA, Doc("Color of the star; white keeps that of the light.")] = (1.0, 1.0, 1.0, 1.0)
    threshold: Annotated[
        float, Slider(0.0, 10.0, unit="scene", minimum=0.0, doc="Only light above this luminance glows.")
    ] = 1.0
    knee: Annotated[Fraction, Doc("Softness of the threshold: the part of it over which light fades in.")] = 0.5
    limit: Annotated[
        float,
        Slider(
            1.0,
            1000.0,
            unit="scene",
            minimum=0.0,
            maximum=_NO_LIMIT,
            doc="The largest luminance that glows, to limit suns and noise; 65504 is no limit.",
        ),
    ] = _NO_LIMIT
    edge: Annotated[
        Edge,
        Doc(
            "What lies outside the picture. Black: no light. Clamp is for glow without a "
            "threshold: an even picture then stays even."
        ),
    ] = "black"

    out = OutputSocket()
    glow = OutputSocket()

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        light = draw.point("star_light", self.image, threshold=self.threshold, knee=self.knee, limit=self.limit)
        # The star is the same at every quarter of a turn.
        angle = math.remainder(self.angle, math.pi / 2.0)
        turned, frame = abs(angle) > _SQUARE, draw.size
        if turned:
            frame = _frame(draw.size, angle)
            turn = _turn(frame, draw.size, -angle)
            light = draw("star_turn", image=light, size=frame, edge=self.edge, overlap=turn, angle=-angle)
        u = draw.blur(light, (self.length, 0.0), self.edge)
        v = draw.blur(light, (0.0, self.length), self.edge)
        arms = draw.point("star_cross", u=u, v=v)
        if turned:
            turn = _turn(draw.size, frame, angle)
            arms = draw("star_turn", image=arms, size=draw.size, edge=self.edge, overlap=turn, angle=angle)
        glow = draw.point("star_glow", self.image, arms=arms, tint=self.tint)
        return {"out": draw.point("star", self.image, glow=glow, intensity=self.intensity), "glow": glow}


def _frame(size: Size, angle: float) -> Size:
    """What holds a picture of this size that is turned about its middle, with a pixel around it."""
    cos, sin = abs(math.cos(angle)), abs(math.sin(angle))
    return math.ceil(size[0] * cos + size[1] * sin) + 2, math.ceil(size[0] * sin + size[1] * cos) + 2


def _turn(size: Size, read: Size, angle: float) -> Reach:
    """Where a picture of this size lies in the other one, which is turned about its middle."""
    cos, sin = math.cos(angle), math.sin(angle)
    x, y = (0.5 * side for side in size)
    return Reach((cos, -sin, 0.5 * read[0] - cos * x + sin * y, sin, cos, 0.5 * read[1] - sin * x - cos * y), (2, 2))
