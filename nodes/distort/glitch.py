import math
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Filter, Fraction, Image, Slider


class Glitch(Filter):
    """Break the picture into bands that jump sideways, as damaged video does.

    Wide bands and bands of a quarter of their height jump separately, and their colors move apart. A hash (pcg3d:
    Jarzynski and Olano 2020) decides which bands jump and how far, so that a frame always looks the same.
    """

    aliases = (
        "datamosh", "digital damage", "bad tv", "signal error", "corruption", "vhs", "bad signal", "block glitch",
        "jitter",
    )  # fmt: skip

    image = Image()
    amount: Annotated[Fraction, Doc("How many of the bands jump.")] = 0.25
    shift: Annotated[float, Slider(0.0, 0.5, unit="height", doc="How far they jump at most.")] = 0.12
    colors: Annotated[
        float, Slider(0.0, 0.1, unit="height", doc="How far red and blue move apart in these bands at most.")
    ] = 0.03
    band: Annotated[float, Slider(0.01, 0.5, unit="height", minimum=1e-4, doc="Height of the wide bands.")] = 0.12
    hold: Annotated[int, Slider(1, 24, unit="count", minimum=1, doc="How many frames a glitch lasts.")] = 2
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another glitch.")] = 0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "wrap"

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 or (self.shift, self.colors) == (0.0, 0.0) else None

    def passes(self, draw: Draw) -> Drawn:
        farthest = math.ceil(2.0 * (abs(self.shift) + abs(self.colors)))
        return draw(
            "glitch",
            self.image,
            edge=self.edge,
            overlap=(farthest + 1, 1),
            amount=self.amount,
            shift=self.shift,
            colors=self.colors,
            band=self.band,
            hold=self.hold,
            seed=self.seed,
        )
