import math
from collections.abc import Mapping
from typing import Annotated

from .._declare import (
    RGBA,
    CameraSocket,
    Dial,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Fraction,
    Image,
    OutputSocket,
    ProxyNote,
    Slider,
    Vector,
)


class RimLight(Filter):
    """Add light along the rims of surfaces, where they turn away from the camera.

    The rim is (1 - n.v)^power, where n is the normal and v the direction to the camera. The light can come from all
    around or from one side. It is added where the mask and the picture's alpha cover.
    """

    aliases = ("rim", "back light", "edge light", "fresnel light", "light wrap", "kicker")

    proxy_notes = (ProxyNote(("out", "rim"), "it compares neighboring pixels, which are farther apart in a proxy"),)

    image = Image()
    normal = Vector(width=3, doc="Normals of surfaces.")
    camera = CameraSocket(0.0, doc="Without one, normals are the camera's own: x right, y up, z toward it.")
    mask = Field(
        1.0,
        doc="Where the light falls. Use it to exclude flat ground, which the camera sees at a "
        "grazing angle, so that all of it is rim.",
    )
    color: Annotated[RGBA, Doc("Color of the light; its alpha scales it.")] = (1.0, 0.85, 0.7, 1.0)
    intensity: Annotated[float, Slider(0.0, 10.0, unit="ratio", doc="How strong it is.")] = 2.0
    power: Annotated[
        float, Slider(0.5, 10.0, unit="ratio", minimum=0.0, maximum=1000.0, doc="Higher makes the rim narrower.")
    ] = 3.0
    focus: Annotated[Fraction, Doc("0: light from all around; 1: light from one side only.")] = 0.0
    angle: Annotated[
        float,
        Slider(-180.0, 180.0, unit="deg", doc="The side that the light comes from: 0 is right, 90 is above."),
        Dial("counterclockwise"),
    ] = 45.0

    out = OutputSocket()
    rim = OutputSocket(Field(doc="How much of the light each pixel gets, 0..1, without the mask."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        camera = draw.camera(self.camera)
        rays = camera.inverse if camera else (0.0,) * 10 + (-1.0, 0.0)
        right, down = (camera.right, camera.down) if camera else ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
        across, up = math.cos(self.angle), math.sin(self.angle)
        side = tuple(across * a - up * b for a, b in zip(right, down, strict=True))
        rim = draw(
            "rim_light_rim",
            self.normal,
            overlap=1,
            result=Field(),
            rays=rays,
            power=self.power,
            focus=self.focus,
            side=side,
        )
        gain = self.intensity * self.color[3]
        light = tuple(gain * part for part in self.color[:3])
        return {"out": draw.point("rim_light", self.image, rim=rim, mask=self.mask, light=light), "rim": rim}
