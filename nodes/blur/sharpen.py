from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Slider


class Sharpen(Filter):
    """Sharpen by an unsharp mask: the detail that a Gaussian blur would remove is added once more.

    `out = in + amount * detail`, where `detail = in - blur(in, sigma)`. The threshold reduces the detail, so that faint
    grain is not sharpened. The limit keeps it small, so that lamps do not get black halos. Alpha is kept.
    """

    aliases = ("unsharp mask", "usm", "high pass", "detail", "clarity", "deblur", "texture", "luma sharpen")

    image = Image()
    out = OutputSocket(follows="image")
    amount: Annotated[
        float,
        Slider(0.0, 3.0, unit="ratio", minimum=-1.0, maximum=100.0, doc="How much detail is added; -1 takes it away."),
    ] = 0.8
    sigma: Annotated[
        float,
        Slider(
            0.3,
            20.0,
            unit="px",
            minimum=0.0,
            maximum=2000.0,
            doc="Size of the detail. Large values raise local contrast.",
        ),
    ] = 1.5
    threshold: Annotated[
        float, Slider(0.0, 0.5, unit="scene", minimum=0.0, doc="Detail fainter than this is left alone.")
    ] = 0.0
    limit: Annotated[
        float,
        Slider(
            0.0,
            2.0,
            unit="ratio",
            minimum=0.0,
            doc="The largest detail that is added, as a part of the pixel's own brightness.",
        ),
    ] = 0.3
    channels: Annotated[
        Literal["luminance", "separate"],
        Doc("Luminance adds the same gray detail to all channels, which leaves no colored fringes."),
    ] = "luminance"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 or self.sigma == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        return draw.point(
            "sharpen",
            self.image,
            soft=draw.blur(self.image, self.sigma, self.edge, precise=True),
            amount=self.amount,
            threshold=self.threshold,
            limit=self.limit,
            channels=self.channels,
        )
