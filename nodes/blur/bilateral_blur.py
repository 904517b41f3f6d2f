from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, Slider


class BilateralBlur(Filter):
    """Smooth surfaces and noise while edges stay: neighbors with another color have less weight.

    A neighbor's weight is `exp(-d^2 / (2 sigma^2) - c^2 / (2 sigma_range^2))`, d its distance in pixels and c that of
    its color (Tomasi and Manduchi 1998), within 1.5 sigma as in OpenCV. With a guide, that picture's colors are
    compared instead (joint bilateral, Petschnigg et al. 2004): noisy light may follow clean albedo or normals.
    """

    aliases = (
        "bilateral", "denoise", "smart blur", "surface blur", "edge-preserving blur", "remove noise", "remove grain",
        "degrain", "noise reduction", "reduce noise", "smooth", "beauty", "skin smoothing", "dust and scratches",
    )  # fmt: skip

    image = Image()
    guide = Image(0.0, doc="Where this changes, the picture is not blurred. Without a link, the picture itself.")
    sigma: Annotated[
        float,
        Slider(
            0.5, 12.0, unit="px", minimum=0.0, maximum=64.0, doc="Radius of the blur. The cost grows with its square."
        ),
    ] = 4.0
    sigma_range: Annotated[
        float, Slider(0.01, 1.0, unit="scene", minimum=1e-6, doc="How much a color may differ to be mixed in.")
    ] = 0.1
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.sigma == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        radius = max(round(1.5 * self.sigma), 1)
        return draw(
            "bilateral_blur",
            image=self.image,
            guide=self.guide if draw.is_linked(self.guide) else self.image,
            edge=self.edge,
            overlap=radius,
            radius=radius,
            sigma=self.sigma,
            sigma_range=self.sigma_range,
        )
