import math
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Field, Filter, Image, Slider, Trait


class Glass(Filter):
    """Show the picture through uneven glass in front of it.

    The slope of the surface bends the view by Snell's law: if a ray meets the surface at angle a to its normal, the
    picture moves by thickness * tan(a - asin(sin(a) / index)). Dispersion gives red light a smaller index than blue
    light. If `surface` is not linked, the glass has random bumps (gradient noise, Perlin 2002).
    """

    aliases = ("cc glass", "refraction", "frosted glass", "ribbed glass", "fluted glass", "window", "glass distort")
    traits = (Trait.WARPS,)

    image = Image()
    surface = Field(0.0, doc="How high the glass is, 0 to 1. Without a link, random bumps.")
    relief: Annotated[
        float, Slider(0.0, 0.1, unit="height", minimum=0.0, doc="How high a surface of 1 rises above one of 0.")
    ] = 0.04
    thickness: Annotated[
        float, Slider(0.0, 0.5, unit="height", minimum=0.0, doc="How far the picture lies behind the surface.")
    ] = 0.15
    index: Annotated[
        float,
        Slider(
            1.0,
            2.5,
            unit="ratio",
            minimum=1.0,
            maximum=5.0,
            doc="Refractive index: water 1.33, glass 1.5, diamond 2.4.",
        ),
    ] = 1.5
    dispersion: Annotated[
        float, Slider(0.0, 0.3, unit="ratio", minimum=0.0, doc="How much larger the index is for blue than for red.")
    ] = 0.06
    samples: Annotated[
        int,
        Slider(3, 32, unit="count", minimum=3, maximum=128, doc="Steps from red to blue, if there is dispersion."),
    ] = 9
    size: Annotated[float, Slider(0.005, 0.5, unit="height", minimum=1e-4, doc="Size of random bumps.")] = 0.08
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another pattern of bumps.")] = 0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "mirror"

    def identity(self) -> str | None:
        return "image" if 0.0 in (self.relief, self.thickness) or (self.index, self.dispersion) == (1.0, 0.0) else None

    def passes(self, draw: Draw) -> Drawn:
        light = (self.index, self.dispersion)
        samples = self.samples if self.dispersion > 0.0 else 1
        # However steep the glass is, light leaves it within the critical angle of what is grazed.
        index = max(self.index + 0.5 * self.dispersion, 1.0)
        reach = math.ceil(self.thickness * math.sqrt(index**2 - 1.0)) + 3
        if draw.is_linked(self.surface):
            return draw(
                "glass",
                self.image,
                self.surface,
                edge=self.edge,
                overlap={"image": reach, "surface": 1},
                relief=self.relief,
                thickness=self.thickness,
                light=light,
                samples=samples,
            )
        return draw(
            "glass_hammered",
            self.image,
            edge=self.edge,
            overlap=reach,
            relief=self.relief,
            thickness=self.thickness,
            light=light,
            samples=samples,
            bump=self.size,
            seed=self.seed,
        )
