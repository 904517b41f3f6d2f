import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Image, OutputSocket, ProxyNote, Size, Slider

Projection = Literal["lat-long", "cube strip", "cube cross", "fisheye", "mirror ball", "little planet", "perspective"]
"""How directions lie in a picture."""

_QUARTER = math.pi / 2.0

_WIDEST = {"fisheye": math.tau, "little planet": math.radians(350.0), "perspective": math.radians(170.0)}
"""The largest angle of view of each projection that has one: little planets and perspective views end before infinity.
The last degrees would take nearly all of the picture."""


_HEIGHTS = {"lat-long": 2.0, "cube strip": 1.0, "cube cross": 3.0, "mirror ball": 2.0}
"""The height of pictures that show all directions, in the length of a quarter turn."""

_ASPECTS = {"lat-long": 2.0, "cube strip": 6.0, "cube cross": 4.0 / 3.0}
"""Width over height of pictures that are no squares."""


class Panorama(Filter):
    """Convert a panorama to another projection, and look around in it.

    Lat-long holds all directions by longitude and latitude, with the front in the middle. A cube strip holds six faces
    in a row: right, left, up, down, front and back; a cube cross has up and down above and below the front. A fisheye
    is equidistant: the distance from the middle grows with the angle. A mirror ball is a polished ball seen from far
    away. A little planet is stereographic and looks down. Perspective is what a camera sees.

    The result has as many pixels per quarter turn as the picture, and even sides, as videos need them. Faces of cubes
    and the sides of a lat-long picture join without a seam. What a projection does not show is empty.
    """

    aliases = (
        "spherical transform", "latlong", "equirectangular", "cubemap", "cube map", "360", "vr", "vr converter", "hdri",
        "light probe", "mirrored ball", "tiny planet", "little planet", "fisheye", "environment", "lat long",
        "latlong patcher", "pano map", "vr sphere to plane",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("out",), "a view enlarges a part of the picture, and pixels of a proxy are larger"),)

    image = Image()
    out = OutputSocket(follows="image")
    source: Annotated[Projection, Doc("The projection of the picture.")] = "lat-long"
    source_angle: Annotated[
        float,
        Slider(
            10.0,
            360.0,
            unit="deg",
            minimum=1.0,
            maximum=360.0,
            doc="The angle that the picture's height shows, for a fisheye, a little planet and a perspective view.",
        ),
    ] = 180.0
    target: Annotated[Projection, Doc("The projection of the result.")] = "perspective"
    angle: Annotated[
        float,
        Slider(
            10.0,
            360.0,
            unit="deg",
            minimum=1.0,
            maximum=360.0,
            doc="The angle that the result's height shows, for a fisheye, a little planet and a perspective view.",
        ),
    ] = 60.0
    yaw: Annotated[float, Slider(-180.0, 180.0, unit="deg", doc="Turns the view to the right.")] = 0.0
    pitch: Annotated[float, Slider(-90.0, 90.0, unit="deg", doc="Turns the view up.")] = 0.0
    roll: Annotated[float, Slider(-180.0, 180.0, unit="deg", doc="Tilts the view clockwise.")] = 0.0
    aspect: Annotated[
        float,
        Slider(0.5, 3.0, unit="ratio", minimum=0.1, maximum=10.0, doc="Width over height of a perspective view."),
    ] = 16.0 / 9.0
    scale: Annotated[
        float, Slider(0.1, 4.0, unit="ratio", minimum=0.01, maximum=16.0, doc="Factor on the size of the result.")
    ] = 1.0

    def output_size(self, inputs: Mapping[str, Size], canvas: Size) -> Size:
        # Sizes are asked of nodes as they are saved, in degrees.
        source_angle, angle = math.radians(self.source_angle), math.radians(self.angle)
        height = super().output_size(inputs, canvas)[1]
        quarter = self.scale * height / _count_quarters(self.source, source_angle)
        if self.target in ("cube strip", "cube cross"):
            quarter = max(2.0 * round(quarter / 2.0), 2.0)  # faces are whole pixels
        down = quarter * _count_quarters(self.target, angle)
        across = down * (self.aspect if self.target == "perspective" else _ASPECTS.get(self.target, 1.0))
        return (2 * round(across / 2.0) or 1, 2 * round(down / 2.0) or 1)

    def passes(self, draw: Draw) -> Drawn:
        return draw(
            "panorama",
            self.image,
            edge="panorama" if self.source == "lat-long" else "clamp",
            source=self.source,
            source_angle=_limit_angle(self.source, self.source_angle),
            target=self.target,
            angle=_limit_angle(self.target, self.angle),
            turn=_rotation(self.yaw, self.pitch, self.roll),
        )


def _limit_angle(projection: Projection, angle: float) -> float:
    return min(angle, _WIDEST.get(projection, math.tau))


def _count_quarters(projection: Projection, angle: float) -> float:
    """How many quarter turns lie in the height of a picture, at the scale of the middle of a perspective view."""
    angle = _limit_angle(projection, angle)
    if projection == "perspective":
        return 2.0 * math.tan(angle / 2.0) / _QUARTER
    return _HEIGHTS.get(projection, angle / _QUARTER)


def _rotation(yaw: float, pitch: float, roll: float) -> tuple[float, ...]:
    """Where the front, the left and the top of the view lie in the panorama: x is the front, y left, z up."""
    cy, sy, cp, sp, cr, sr = (part(angle) for angle in (yaw, pitch, roll) for part in (math.cos, math.sin))
    front = (cp * cy, -cp * sy, sp)
    left, top = (sy, cy, 0.0), (-sp * cy, sp * sy, cp)
    tilted_left = tuple(cr * a + sr * b for a, b in zip(left, top, strict=True))
    tilted_top = tuple(cr * b - sr * a for a, b in zip(left, top, strict=True))
    return (*front, *tilted_left, *tilted_top)
