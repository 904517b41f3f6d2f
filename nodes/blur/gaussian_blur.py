from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, Slider


class GaussianBlur(Filter):
    """Blur with a Gaussian. The cost hardly grows with sigma.

    Within 1e-5 of scipy's gaussian_filter below a sigma of 7 pixels, within 3e-4 (RMS) of it above.
    """

    image = Image()
    sigma: Annotated[
        float,
        Slider(
            0.0, 100.0, unit="px", minimum=0.0, maximum=2000.0,
            doc="Standard deviation; the visible reach is about thrice that.",
        ),
    ] = 5.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.sigma == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        return draw.blur(self.image, sigma=self.sigma, edge=self.edge)
