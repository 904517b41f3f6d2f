import math
from typing import Annotated, Literal

from .._declare import Dial, Doc, Draw, Drawn, Edge, Filter, Image, Position, Slider, Trait


class ChromaticAberration(Filter):
    """Spread light into its colors, as a lens that bends blue more than red.

    The light of a pixel is gathered along a line, from its red end to its blue end. Each step counts for the primaries
    that its wavelength excites (overlapping tents). The weights of each primary add up to 1, so that no light is lost
    and even gray areas stay gray. Alpha is gathered with equal weights.
    """

    aliases = (
        "ca", "color fringe", "fringing", "rgb split", "lateral color", "dispersion", "prism", "channel offset",
        "rgb shift", "lens aberration",
    )  # fmt: skip
    traits = (Trait.WARPS,)

    image = Image()
    shape: Annotated[
        Literal["radial", "straight"],
        Doc(
            "Radial grows from the center to the edges, as with a lens; straight is the same "
            "everywhere, as with a prism."
        ),
    ] = "radial"
    amount: Annotated[
        float,
        Slider(
            -0.05,
            0.05,
            unit="height",
            doc="How far red and blue are from green. For radial, this holds half the picture's "
            "height away from the center.",
        ),
    ] = 0.006
    angle: Annotated[
        float,
        Slider(-180.0, 180.0, unit="deg", doc="For straight: the direction in which red moves; 0 is right."),
        Dial("clockwise"),
    ] = 0.0
    samples: Annotated[
        int,
        Slider(
            3, 64, unit="count", minimum=3, maximum=256, doc="Steps from red to blue; 3 shows three separate pictures."
        ),
    ] = 16
    center: Annotated[Position, Doc("The optical axis.")] = (0.5, 0.5)
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        center = (self.center[0] * draw.size[0], self.center[1] * draw.size[1])
        # The farthest that light is thrown; a radial throw grows up to the farthest corner.
        farthest = abs(self.amount)
        if self.shape == "radial":
            width, height = draw.size
            corner = (max(center[0], width - center[0]), max(center[1], height - center[1]))
            farthest *= math.hypot(*corner) / (0.5 * height)
        return draw(
            "chromatic_aberration",
            self.image,
            edge=self.edge,
            overlap=math.ceil(farthest) + 1,
            shape=self.shape,
            amount=self.amount,
            angle=self.angle,
            samples=self.samples,
            center=center,
        )
