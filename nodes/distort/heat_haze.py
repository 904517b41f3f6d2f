import math
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Field, Filter, Image, OutputSocket, Slider, Trait


class HeatHaze(Filter):
    """Let the picture shimmer as above a fire or a hot road.

    Two noises (gradient noise, Perlin 2002; two octaves) move every point in x and in y. They rise and change over
    time; the same frame always looks the same.
    """

    aliases = ("heat distortion", "haze", "hot air", "shimmer", "air distortion", "mirage")
    traits = (Trait.WARPS,)

    image = Image()
    out = OutputSocket(follows="image")
    heat = Field(1.0, doc="Where it is hot: factor on the amount, pixel by pixel.")
    amount: Annotated[float, Slider(0.0, 0.05, unit="height", doc="How far points move at most.")] = 0.008
    size: Annotated[float, Slider(0.01, 0.5, unit="height", minimum=1e-4, doc="Size of the swirls.")] = 0.06
    stretch: Annotated[
        float,
        Slider(
            0.25, 4.0, unit="ratio", minimum=0.01, doc="Above 1 swirls are taller than wide, below 1 wider than tall."
        ),
    ] = 1.6
    rise: Annotated[float, Slider(-2.0, 2.0, unit="height", doc="How far swirls rise per second.")] = 0.25
    change: Annotated[float, Slider(0.0, 8.0, unit="ratio", doc="How many times per second the swirls change.")] = 1.5
    rate: Annotated[float, Slider(12.0, 60.0, unit="ratio", minimum=0.01, doc="Frames per second of the sequence.")] = (
        24.0
    )
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another haze.")] = 0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "mirror"

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        # A picture of heat may hold any number; without one nothing moves farther than the amount.
        overlap = {"heat": 0} | ({} if draw.is_linked(self.heat) else {"image": math.ceil(abs(self.amount)) + 2})
        return draw(
            "heat_haze",
            self.image,
            self.heat,
            edge=self.edge,
            overlap=overlap,
            amount=self.amount,
            swirl=(self.size, self.size * self.stretch),
            rise=self.rise / self.rate,
            change=self.change / self.rate,
            seed=self.seed,
        )
