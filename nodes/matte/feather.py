from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Slider


class Feather(Filter):
    """Soften the edge of a matte: on both sides, only inward, or only outward.

    A straight edge becomes a Gaussian ramp. Inward the matte is 0 where it was 0 and reaches 1 inside; outward it is 1
    where it was 1 and reaches 0 outside. It works on every channel by itself, from 0 to 1.
    """

    aliases = (
        "soften matte", "edge blur", "soft edge", "blur mask", "refine edge", "mask feather", "inner feather",
        "refine soft matte", "refine hard matte",
    )  # fmt: skip

    image = Image(doc="The matte, or a premultiplied picture.")
    out = OutputSocket(follows="image")
    width: Annotated[
        float,
        Slider(
            0.0,
            100.0,
            unit="px",
            minimum=0.0,
            maximum=2000.0,
            doc="How wide the soft edge is; 95 % of the change lies in it.",
        ),
    ] = 10.0
    side: Annotated[Literal["both", "inside", "outside"], Doc("Where the soft edge lies.")] = "both"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.width == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        """A side alone shows half of the Gaussian, so that its sigma is a half of the width in place of a quarter."""
        sigma = self.width / (4.0 if self.side == "both" else 2.0)
        soft = draw.blur(self.image, sigma, self.edge)
        return soft if self.side == "both" else draw.point("feather", self.image, soft=soft, side=self.side)
