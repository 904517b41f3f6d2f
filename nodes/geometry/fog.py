import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    RGBA,
    CameraSocket,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Fraction,
    Image,
    OutputSocket,
    Slider,
    Trait,
    Vector,
)


class Fog(Filter):
    """Add fog to the picture: denser with the distance, or a layer on the ground.

    The visible part is exp(-density * distance) or exp(-(density * distance)^2), or it falls linearly from start to end
    (the three kinds of fog of OpenGL). Height fog gets thinner upward as exp(-height / thickness); the fog along the
    ray of every pixel is an exact integral (Wenzel 2006, Quilez 2010). If a camera is linked, the distance is measured
    along the ray, else it is the depth. Distances are in units of the scene.
    """

    aliases = (
        "fog 3d", "depth fog", "mist", "haze", "atmosphere", "volume fog", "depth cue", "aerial perspective", "smoke",
        "atmospherics", "depth haze", "adaptive fog",
    )  # fmt: skip
    traits = (Trait.NEEDS_SCENE_LIGHT,)

    image = Image()
    depth = Field(doc="Planar depth: the distance along the camera's axis. Pixels without depth are sky.")
    position = Vector(0.0, width=3, doc="Positions in the world, for the height if no camera is linked.")
    camera = CameraSocket(0.0, doc="For the height, the sun, and true distances.")
    mode: Annotated[
        Literal["linear", "exponential", "exponential squared", "height"],
        Doc(
            "Linear: from start to end. Exponential squared keeps near things clearer. Height: a "
            "layer on the ground, which needs a camera, or positions and eye."
        ),
    ] = "exponential"
    color: Annotated[RGBA, Doc("The light of the thickest fog. Its alpha is the most that fog covers.")] = (
        0.3,
        0.36,
        0.45,
        1.0,
    )
    density: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="scene",
            minimum=0.0,
            doc="How much fog one unit of distance holds; at the base of height fog.",
        ),
    ] = 0.08
    start: Annotated[float, Slider(0.0, 50.0, unit="scene", minimum=0.0, doc="Nearer surfaces stay clear.")] = 4.0
    end: Annotated[float, Slider(0.0, 100.0, unit="scene", minimum=0.0, doc="Where linear fog hides everything.")] = (
        20.0
    )
    base: Annotated[float, Slider(-10.0, 10.0, unit="scene", doc="The height at which height fog has its density.")] = (
        0.0
    )
    thickness: Annotated[
        float,
        Slider(
            0.1,
            20.0,
            unit="scene",
            minimum=1e-3,
            doc="The height over which height fog becomes thinner by a factor of e (2.7).",
        ),
    ] = 1.0
    up: Annotated[Literal["z", "y"], Doc("The axis of the world that points up: z in Blender, y in Maya.")] = "z"
    eye: Annotated[
        float, Slider(-10.0, 10.0, unit="scene", doc="The height of the camera, if only positions are linked.")
    ] = 1.6
    sky: Annotated[Fraction, Doc("How much fog covers pixels without depth.")] = 1.0
    alpha: Annotated[
        Literal["keep", "fill"],
        Doc(
            "Keep: fog only where the picture covers, for a layer that lies over others. Fill: fog in empty places too."
        ),
    ] = "keep"
    sun: Annotated[Fraction, Doc("How much the fog glows toward the sun; it needs a camera.")] = 0.0
    sun_color: Annotated[RGBA, Doc("Color of the fog in front of the sun.")] = (1.6, 1.1, 0.6, 1.0)
    sun_direction: Annotated[
        tuple[float, float, float],
        Slider(-1.0, 1.0, unit="ratio"),
        Doc("The direction to the sun, in the axes of the world."),
    ] = (0.3, 0.9, 0.3)
    sun_focus: Annotated[
        float, Slider(1.0, 100.0, unit="ratio", minimum=0.0, doc="Higher values keep the glow closer to the sun.")
    ] = 8.0

    out = OutputSocket()
    amount = OutputSocket(Field(doc="How much of each pixel the fog hides, 0..1."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        camera, placed = draw.camera(self.camera), draw.is_linked(self.position)
        rays = camera.inverse if camera else (0.0,) * 12
        length = math.hypot(*self.sun_direction)
        sun = tuple(part / length for part in self.sun_direction) if length and camera else (0.0, 0.0, 0.0)
        amount = draw.point(
            "fog_amount",
            self.depth,
            self.position,
            result=Field(),
            rays=rays,
            seen=camera is not None,
            placed=placed,
            mode=self.mode,
            density=self.density,
            start=self.start,
            end=self.end,
            base=self.base,
            thickness=self.thickness,
            up=self.up,
            eye=self.eye,
            sky=self.sky,
            most=self.color[3],
        )
        out = draw.point(
            "fog",
            self.image,
            amount=amount,
            rays=rays,
            color=self.color[:3],
            alpha=self.alpha,
            sun=self.sun,
            sun_color=self.sun_color[:3],
            sun_direction=sun,
            sun_focus=self.sun_focus,
        )
        return {"out": out, "amount": amount}
