import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Fraction, Image, OutputSocket, Slider, Temporal, Vector


class LightTrails(Temporal):
    """Draw with light: bright pixels leave a trail, as in a long exposure.

    `trail = max(bright, a trail')`, where trail' is that of the previous frame; by time, `a = exp(-dt / time)`, the
    same at any frame rate. The picture is visible wherever it is brighter. The trail is kept in 32 bits.
    """

    aliases = (
        "trails", "light painting", "light streaks", "long exposure", "car lights", "particle trails", "max trails",
    )  # fmt: skip

    image = Image()
    fade: Annotated[
        Literal["time", "never"],
        Doc("Trails fade with time or stay forever, as the trails of stars and cars in a long exposure."),
    ] = "time"
    time: Annotated[
        float,
        Slider(
            0.02,
            5.0,
            unit="s",
            minimum=0.0,
            maximum=1e4,
            doc="The time after which 1 / e (37 percent) of the light is left.",
        ),
    ] = 0.5
    threshold: Annotated[
        float,
        Slider(0.0, 5.0, unit="scene", minimum=0.0, doc="Only light above this leaves a trail; at 0, all light does."),
    ] = 1.0
    knee: Annotated[Fraction, Doc("The part of the threshold over which light fades in.")] = 0.5
    intensity: Annotated[float, Slider(0.0, 2.0, unit="ratio", minimum=0.0, doc="How bright the trails are.")] = 1.0

    out = OutputSocket(Image(doc="The picture with its trails."))
    trail = OutputSocket(Image(doc="The trails alone."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        decay = 1.0
        if self.fade == "time":
            decay = math.exp(-1.0 / (draw.rate * self.time)) if self.time > 0.0 else 0.0
        vector = Vector(width=4)
        bright = draw.point("light_trails_bright", self.image, threshold=self.threshold, knee=self.knee, result=vector)
        trail = draw.point("light_trails_fade", bright=bright, before=draw.history(bright), kept=decay, result=vector)
        draw.remember(trail)
        out = draw.point("light_trails", self.image, trail=trail, intensity=self.intensity)
        return {"out": out, "trail": draw.point("light_trails_alone", trail=trail, intensity=self.intensity)}
