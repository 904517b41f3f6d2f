import math
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Field, Filter, Image, OutputSocket, Slider, Trait, Vector


class NoiseWarp(Filter):
    """Warp the picture by moving noise: wobbling, flowing, dissolving.

    The noise is simplex noise (Perlin, 2001; Gustavson and McEwan, 2022) in several layers (fBm). Push moves points by
    two independent noises. Flow moves them by the curl of one noise (Bridson, Hourihan and Nordenstam, 2007), which
    stirs the picture without squeezing it.
    """

    aliases = (
        "turbulent displace", "turbulence", "wiggle", "liquid", "fluid warp", "distort by noise", "rough edges",
        "roughen edges", "wave", "warp",
    )  # fmt: skip
    traits = (Trait.WARPS,)

    image = Image()
    out = OutputSocket(follows="image")
    mask = Field(1.0, doc="Factor on the amount, pixel by pixel.")
    amount: Annotated[float, Slider(0.0, 0.2, unit="height", doc="How far points move at most, in x and in y.")] = 0.06
    kind: Annotated[
        Literal["push", "flow"], Doc("Push bulges and pinches; flow stirs and, while the amount is small, keeps areas.")
    ] = "push"
    size: Annotated[float, Slider(0.01, 1.0, unit="height", minimum=1e-4, doc="Size of the largest waves.")] = 0.25
    octaves: Annotated[
        int,
        Slider(1, 8, unit="count", minimum=1, maximum=16, doc="How many layers, each half as large as the one before."),
    ] = 2
    gain: Annotated[
        float,
        Slider(
            0.0, 1.0, unit="ratio", minimum=0.0, maximum=4.0, doc="How far each layer moves compared to the one before."
        ),
    ] = 0.4
    evolution: Annotated[float, Slider(0.0, 10.0, unit="ratio", doc="Changes the waves smoothly.")] = 0.0
    speed: Annotated[float, Slider(-0.2, 0.2, unit="ratio", doc="How much evolution grows with every frame.")] = 0.02
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another pattern.")] = 0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "mirror"

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        ways = draw(
            "noise_warp_ways",
            result=Vector(width=2),
            kind=self.kind,
            wave=self.size,
            octaves=self.octaves,
            gain=self.gain,
            evolution=self.evolution,
            speed=self.speed,
            seed=self.seed,
        )
        # A mask may hold any number; without one nothing moves farther than the amount.
        far = math.ceil(abs(self.amount))
        overlap = {"ways": 1, "mask": 0} | ({} if draw.is_linked(self.mask) else {"image": 2 * far + 3})
        return draw("noise_warp", self.image, self.mask, edge=self.edge, overlap=overlap, ways=ways, amount=self.amount)
