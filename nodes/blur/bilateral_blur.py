from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Slider

_REACH = 1.5
"""The radius of the circular window in sigmas, as in OpenCV's bilateralFilter."""


class BilateralBlur(Filter):
    """Smooth surfaces and noise but keep edges: neighbors with a different color have less weight.

    Each neighbor has the weight `exp(-d^2 / (2 sigma^2) - c^2 / (2 sigma_range^2))`, where d is its distance in pixels
    and c the difference of its color (Tomasi and Manduchi 1998). Neighbors within 1.5 sigma count, as in OpenCV. If a
    guide is linked, the weights compare the colors of the guide instead (joint bilateral filter, Petschnigg et al.
    2004): clean albedo or normals can guide the blur of noisy light.
    """

    aliases = (
        "bilateral", "denoise", "smart blur", "surface blur", "edge-preserving blur", "remove noise", "remove grain",
        "degrain", "noise reduction", "reduce noise", "smooth", "beauty", "skin smoothing", "dust and scratches",
        "rolling guidance",
    )  # fmt: skip

    image = Image()
    out = OutputSocket(follows="image")
    guide = Image(
        0.0, doc="Edges of this picture stop the blur. Without a link, the edges of the blurred picture itself do."
    )
    sigma: Annotated[
        float,
        Slider(
            0.5, 12.0, unit="px", minimum=0.0, maximum=64.0, doc="Radius of the blur. The cost grows with its square."
        ),
    ] = 4.0
    sigma_range: Annotated[
        float,
        Slider(
            0.01,
            1.0,
            unit="scene",
            minimum=1e-6,
            doc="How different the color of a neighbor may be. Larger values blur across stronger edges.",
        ),
    ] = 0.1
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.sigma == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        radius = max(round(_REACH * self.sigma), 1)
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
