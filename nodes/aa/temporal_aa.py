from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Field, Fraction, Image, Slider, Temporal, Vector


class TemporalAa(Temporal):
    """Smooth edges and fine detail with samples of many frames: for renders whose pixels are sampled elsewhere in each.

    What the picture became in the frame before is fetched from where every surface was (by its velocity, that of the
    nearest of 3 x 3 pixels), and mixed with this frame. It is held within the mean and the
    standard deviation of the 3 x 3 colors around, in YCoCg (Karis 2014, Salvi 2016): what is no longer there leaves no
    ghost. See `jitter` of Scene.
    """

    aliases = ("taa", "anti-aliasing", "temporal anti-aliasing", "supersampling")

    image = Image(doc="One sample per pixel.")
    velocity = Vector(
        width=4,
        doc=("Pixels of the full-size picture, x right, y down: x and y from the frame before. The rest is not used."),
    )
    depth = Field(0.0, doc="Says what is nearest, and what was hidden in the frame before.")
    share: Annotated[
        Fraction,
        Doc(
            "How much this frame counts: little is smooth, much is quick to follow what changes. At least 0.25 where "
            "things move by half a pixel."
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
            doc="How many standard deviations the past may be off: more is smoother, less leaves no ghosts.",
        ),
    ] = 1.0
    weigh_light: Annotated[
        bool,
        Doc(
            "Let a sample of a lamp count less the brighter it is, as 1 / (1 + luminance): edges of lights are "
            "smooth too."
        ),
    ] = True
    kernel: Annotated[
        Literal["catmull-rom", "lanczos"],
        Doc("How the past is read between pixels: Lanczos (3 lobes) keeps it sharper while things move."),
    ] = "lanczos"
    tolerance: Annotated[
        float,
        Slider(
            0.01,
            0.5,
            unit="ratio",
            minimum=0.0,
            maximum=1e6,
            doc="With depth: what was nearer or farther by more than this part was something else.",
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
