from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Slider, Trait, Vector


class Displace(Filter):
    """Displace the picture by a vector map: every pixel shows what is `vector * amount` pixels away.

    x points right and y down. Positions between pixels are interpolated (bilinear).
    """

    aliases = (
        "idistort", "displacement map", "displacement", "vector distort", "warp", "distort", "vector warp", "push",
        "refract", "normal map distort",
    )  # fmt: skip
    traits = (Trait.WARPS,)

    image = Image()
    out = OutputSocket(follows="image")
    vector = Vector(
        0.0, width=2, doc="The offset at which to read, as a multiple of `amount`. Without a link nothing moves."
    )
    amount: Annotated[
        tuple[float, float],
        Slider(-200.0, 200.0, unit="px", doc="How far a vector of length 1 reaches, in x and in y."),
    ] = (20.0, 20.0)
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.amount == (0.0, 0.0) else None

    def passes(self, draw: Draw) -> Drawn:
        return draw("displace", self.image, self.vector, edge=self.edge, amount=self.amount)
