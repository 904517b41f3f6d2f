from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Fraction, Image, OutputSocket, Size, Slider, Trait


class Upscale(Filter):
    """Enlarge the picture with sharp edges, without halos or stairs, by AMD's FidelityFX Super Resolution 1.

    EASU of FSR 1 (AMD 2021) enlarges: the 12 nearest pixels are weighed by a Lanczos kernel that is stretched along the
    edge, and no channel leaves the range of the 4 nearest pixels. RCAS then sharpens each pixel by its 4 neighbors.
    Both work on square roots of display light, as FSR asks for; light of a scene is first made to fit in 0..1 by
    c / (1 + max(r, g, b)), and afterwards is as bright as it was. It is made for factors up to 2. The size is rounded
    to whole pixels. Alpha is enlarged by the same weights and is not sharpened.
    """

    aliases = (
        "fsr", "fsr 1", "super resolution", "superresolution", "fidelityfx super resolution", "easu", "rcas", "upres",
        "up-res", "enlarge", "super scale", "superscale", "detail-preserving upscale", "smart scale", "magnify",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.RESAMPLES)

    image = Image()
    out = OutputSocket()
    scale: Annotated[
        float,
        Slider(1.0, 2.0, unit="ratio", minimum=1.0, maximum=8.0, doc="Factor on the width and on the height."),
    ] = 2.0
    sharpness: Annotated[
        Fraction,
        Doc("How much RCAS sharpens: 1 is its most, 0.5 one of its stops less; 0 leaves out the sharpening."),
    ] = 0.8
    light: Annotated[
        Literal["scene", "display"],
        Doc(
            "Scene: light may be brighter than 1, and sharpening makes no pixel brighter or darker than those around "
            "it. Display: light after the tone map, which is limited to 0..1."
        ),
    ] = "scene"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.scale == 1.0 and self.sharpness == 0.0 and self.light == "scene" else None

    def output_size(self, inputs: Mapping[str, Size], canvas: Size) -> Size:
        width, height = super().output_size(inputs, canvas)
        return (max(round(width * self.scale), 1), max(round(height * self.scale), 1))

    def passes(self, draw: Draw) -> Drawn:
        same = draw.size_of(self.image) == draw.size
        codes = (
            draw.point("upscale_encode", self.image, light=self.light)
            if same
            else draw("upscale_easu", self.image, edge=self.edge, overlap=3, light=self.light)
        )
        return draw("upscale_rcas", codes=codes, edge=self.edge, overlap=1, sharpness=self.sharpness, light=self.light)
