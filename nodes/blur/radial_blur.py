import math
from typing import Annotated, Literal

from .._declare import Dial, Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Position, Slider


class RadialBlur(Filter):
    """Blur around a point, as if the camera had turned (spin) or zoomed during the exposure.

    Each pixel becomes the mean along an arc around the center (spin) or along the line through the center (zoom). The
    way is sampled at least once per pixel (bilinear), but at most 512 times.
    """

    aliases = ("zoom blur", "spin blur", "rotational blur", "cc radial blur", "cc radial fast blur", "crash zoom")

    image = Image()
    out = OutputSocket(follows="image")
    kind: Annotated[Literal["zoom", "spin"], Doc("Zoom blurs away from the center, spin around it.")] = "zoom"
    zoom: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="ratio",
            minimum=0.0,
            maximum=2.0,
            doc="For zoom: how far a pixel spreads, as a part of its distance from the center.",
        ),
    ] = 0.15
    angle: Annotated[
        float,
        Slider(
            0.0, 90.0, unit="deg", minimum=0.0, maximum=360.0, doc="For spin: the whole angle that a pixel turns by."
        ),
        Dial("clockwise"),
    ] = 10.0
    center: Annotated[Position, Doc("The point that stays sharp.")] = (0.5, 0.5)
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if (self.zoom if self.kind == "zoom" else self.angle) == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        sides = zip(self.center, draw.size, strict=True)
        far = [max(abs(at), abs(1.0 - at)) * side for at, side in sides]
        if self.kind == "zoom":
            reach = [0.5 * self.zoom * distance for distance in far]
        else:
            reach = [min(0.5 * self.angle, 2.0) * math.hypot(*far)] * 2
        return draw(
            "radial_blur",
            self.image,
            edge=self.edge,
            overlap=(math.ceil(reach[0]) + 2, math.ceil(reach[1]) + 2),
            kind=self.kind,
            zoom=self.zoom,
            angle=self.angle,
            center=self.center,
        )
