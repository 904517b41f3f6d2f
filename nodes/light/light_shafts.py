import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from .._declare import (
    RGBA,
    CameraSocket,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Image,
    OutputSocket,
    Position,
    Slider,
    Trait,
    Vector,
)
from ._march import surfaces

_SAMPLES = {"preview": 4, "quality": 12, "reference": 64}
"""Along the way to every pixel; its neighbors lend 16 times as many."""

_SIDES = ("right", "below")
"""Where the seams of a pixel are: see shaders/lib/seam.glsl."""


class LightShafts(Filter):
    """Fill the air with haze: objects in front of the light cast shafts of shadow.

    The light that the haze scatters once toward the camera is summed along the ray of every pixel. For each place on
    the ray, a second ray through the picture, by depth, finds whether the light reaches it. So shafts have a place in
    the world, unlike those of Sun Beams, which smear bright pixels. Lamps are sampled by equal angles (Kulla and
    Fajardo 2012); haze scatters forward as in Henyey and Greenstein 1941. The picture is not dimmed: Fog does that.
    """

    aliases = (
        "god rays", "godrays", "volumetric light", "volume rays", "light rays", "crepuscular rays", "volumetrics",
        "light beams", "sun shafts", "cc light rays", "volumetric shadows",
    )  # fmt: skip
    traits = (Trait.NEEDS_SCENE_LIGHT,)

    image = Image()
    depth = Field(doc="Planar depth: the distance along the camera's axis.")
    camera = CameraSocket(doc="The camera that the depth was rendered with.")
    light: Annotated[
        Literal["picture", "sun", "lamp"],
        Doc("A sun at a place in the picture, a sun in a direction of the world, or a lamp somewhere in it."),
    ] = "picture"
    source: Annotated[Position, Doc("Where the sun is in the picture, or outside of it.")] = (0.4, -0.1)
    direction: Annotated[
        tuple[float, float, float], Slider(-1.0, 1.0, unit="ratio"), Doc("Towards the sun, in the world's axes.")
    ] = (-0.3, 0.9, 0.4)
    position: Annotated[
        tuple[float, float, float], Slider(-10.0, 10.0, unit="scene"), Doc("Where the lamp is in the world.")
    ] = (-0.5, 1.0, 2.2)
    color: Annotated[RGBA, Doc("Color of the light; its alpha scales it.")] = (1.0, 0.85, 0.65, 1.0)
    intensity: Annotated[
        float,
        Slider(0.0, 20.0, unit="scene", minimum=0.0, doc="Light of the sun, or of the lamp one unit away from it."),
    ] = 1.0
    density: Annotated[
        float, Slider(0.0, 0.5, unit="scene", minimum=0.0, doc="How much of the light one unit of distance scatters.")
    ] = 0.05
    forward: Annotated[
        float,
        Slider(
            -0.9,
            0.9,
            unit="ratio",
            minimum=-0.99,
            maximum=0.99,
            doc="Above 0, haze is brightest around the light, as dust and mist are; at 0, as bright everywhere.",
        ),
    ] = 0.4
    distance: Annotated[
        float,
        Slider(
            1.0, 100.0, unit="scene", minimum=1e-3, maximum=1e8, doc="How far away haze ends, if no surface is nearer."
        ),
    ] = 20.0
    thickness: Annotated[
        float,
        Slider(
            0.01,
            10.0,
            unit="scene",
            minimum=0.0,
            maximum=1e8,
            doc="The assumed thickness of objects: rays that are farther behind them pass.",
        ),
    ] = 1.0
    quality: Annotated[
        Literal["preview", "quality", "reference"], Doc("4, 12 or 64 samples along the ray of every pixel.")
    ] = "quality"

    out = OutputSocket(Image(doc="The picture with the light of the haze."))
    shafts = OutputSocket(Image(doc="The light of the haze alone; it covers nothing."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """March along the ray of every pixel with a pattern of noise, then average it away over neighbors."""
        camera = draw.camera(self.camera)
        rows, rays = (camera.rows, camera.inverse) if camera else ((0.0,) * 12, (0.0,) * 12)
        all_surfaces = surfaces(draw, self.depth, "light_shafts")
        length = math.hypot(*self.direction)
        to = tuple(part / length for part in self.direction) if length else (0.0, 0.0, 1.0)
        haze = draw(
            "light_shafts_haze",
            surfaces=all_surfaces,
            result=Field(),
            rows=rows,
            rays=rays,
            light=self.light,
            to=self.position if self.light == "lamp" else to,
            source=self.source,
            density=self.density,
            ahead=self.forward,
            longest=self.distance,
            thickness=self.thickness,
            count=_SAMPLES[self.quality],
        )
        haze = draw("light_shafts_denoise", surfaces=all_surfaces, haze=haze, result=Field())
        haze = self._smooth(draw, all_surfaces, haze)
        gain = self.intensity * self.color[3]
        light = tuple(gain * part for part in self.color[:3])
        return {
            "out": draw.point("light_shafts", self.image, haze=haze, light=light),
            "shafts": draw.point("light_shafts_alone", self.image, haze=haze, light=light),
        }

    def _smooth(self, draw: Draw, all_surfaces: Drawn, haze: Drawn) -> Drawn:
        """Mixes the haze of both sides along contours: depth is not filtered, so that haze has jagged edges."""
        three = Vector(width=3)
        seams = draw("light_shafts_seams", surfaces=all_surfaces, result=three)
        lines: dict[str, Any] = {
            side: draw(f"light_shafts_{side}", seams=seams, edge="black", result=three) for side in _SIDES
        }
        runs = draw("light_shafts_runs", seams=seams, **lines, edge="black", result=three)
        return draw("light_shafts_smooth", haze=haze, runs=runs, **lines, edge="black", result=Field())
