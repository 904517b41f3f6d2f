from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Field, Fraction, Image, Slider, Temporal, Vector


class TemporalAa(Temporal):
    """Smooth edges and detail with samples of many frames: for renders with jittered samples.

    Each surface is found in the result of the previous frame by its velocity (that of the nearest of 3 x 3 pixels), and
    its color there is mixed with this frame. The old color is limited to the mean plus or minus the standard deviation
    of the 3 x 3 colors around, in YCoCg (Karis 2014, Salvi 2016), so that objects that are gone leave no ghosts. See
    `jitter` of Scene.
    """

    aliases = ("taa", "anti-aliasing", "temporal anti-aliasing", "supersampling")

    image = Image(doc="The render, with one sample per pixel.")
    velocity = Vector(
        width=4,
        doc=(
            "Motion in pixels of the full-size picture, x right, y down: x and y since the "
            "previous frame. The rest is not used."
        ),
    )
    depth = Field(0.0, doc="Shows which surface is nearest, and which one was hidden in the previous frame.")
    share: Annotated[
        Fraction,
        Doc(
            "The weight of this frame: low is smooth, high follows changes quickly. At least 0.25 "
            "where surfaces move by half a pixel."
        ),
    ] = 0.1
    gamma: Annotated[
        float,
        Slider(
            0.5,
            3.0,
            unit="ratio",
            minimum=0.0,
            maximum=100.0,
            doc="How many standard deviations the old color may differ: more is smoother, less leaves no ghosts.",
        ),
    ] = 1.0
    weigh_light: Annotated[
        bool,
        Doc("Weight samples by 1 / (1 + luminance), so that edges of bright lights are smooth too."),
    ] = True
    kernel: Annotated[
        Literal["catmull-rom", "lanczos"],
        Doc("The interpolation of the old picture: Lanczos (3 lobes) keeps it sharper during motion."),
    ] = "lanczos"
    tolerance: Annotated[
        float,
        Slider(
            0.01,
            0.5,
            unit="ratio",
            minimum=0.0,
            maximum=1e6,
            doc="If depth is linked: a pixel whose depth differs by more than this part shows another surface.",
        ),
    ] = 0.1

    def times(self, frame: int) -> Mapping[str, tuple[int, ...]]:
        return {"depth": (frame, frame - 1)}

    def passes(self, draw: Draw) -> Drawn:
        vector = Vector(width=4)
        sample = draw.point("temporal_aa_sample", self.image, result=vector, weigh_light=self.weigh_light)
        history = draw.history(sample)
        blended = sample
        if history != sample:
            blended = draw(
                "temporal_aa_blend",
                self.velocity,
                sample=sample,
                history=history,
                depth=draw.at(self.depth, draw.frame),
                depth_before=draw.at(self.depth, draw.frame - 1),
                result=vector,
                share=self.share,
                gamma=self.gamma,
                tolerance=self.tolerance,
                deep=draw.is_linked(self.depth),
                kernel=self.kernel,
            )
        draw.remember(blended)
        return draw.point("temporal_aa", blended=blended, weigh_light=self.weigh_light)
