import math
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Fraction, Image, Slider, Temporal, Vector


class FrameBlend(Temporal):
    """Blend every frame with all earlier ones, which fade: afterimages, ghosts, slow film, less noise.

    `y = (1 - a) x + a y'`, where y' is the result of the previous frame. By time, `a = exp(-dt / time)`: the picture is
    the same at any frame rate. The history is kept in 32 bits: in 16 bits, changes of less than half a step would be
    lost, and trails would never fade out.
    """

    aliases = (
        "blend frames", "time blur", "frame mix", "shutter", "motion blur by frames", "cc force motion blur",
        "frame blending",
    )  # fmt: skip

    image = Image()
    mode: Annotated[
        Literal["time", "persistence"],
        Doc("How the decay of earlier frames is given: by a time, or as the part that is left after one frame."),
    ] = "time"
    time: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="s",
            minimum=0.0,
            maximum=1e4,
            doc="By time: the time after which 1 / e (37 percent) is left.",
        ),
    ] = 0.1
    persistence: Annotated[Fraction, Doc("By persistence: the part that is left after one frame, a.")] = 0.7

    def passes(self, draw: Draw) -> Drawn:
        decay = self.persistence if self.mode == "persistence" else 0.0
        if self.mode == "time" and self.time > 0.0:
            decay = math.exp(-1.0 / (draw.rate * self.time))
        first = draw.point("frame_blend_first", self.image, result=Vector(width=4))
        blended = draw.point("frame_blend", self.image, before=draw.history(first), kept=decay, result=Vector(width=4))
        draw.remember(blended)
        return blended
