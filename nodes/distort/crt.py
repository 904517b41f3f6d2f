import math
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Fraction, Image, Slider


class Crt(Filter):
    """Show the picture on an old television tube.

    The screen bulges, lines are shifted unevenly, color comes late, and the light is divided into scan lines and
    phosphor stripes. Lines and stripes are cosines. They are averaged over each pixel, so that they cause no moire and
    keep the light.
    """

    aliases = (
        "tv", "television", "scanlines", "old monitor", "tube", "retro screen", "analog tv", "interlace",
        "venetian blinds",
    )  # fmt: skip

    image = Image()
    barrel: Annotated[
        float,
        Slider(
            0.0,
            0.3,
            unit="ratio",
            minimum=0.0,
            maximum=4.0,
            doc="Bulge of the tube: r (1 + barrel r^2) in half heights.",
        ),
    ] = 0.05
    jitter: Annotated[
        float, Slider(0.0, 0.05, unit="height", minimum=0.0, doc="How far lines are shifted at most.")
    ] = 0.002
    chroma_delay: Annotated[
        float, Slider(-0.05, 0.05, unit="height", doc="How far color is shifted to the right of its brightness.")
    ] = 0.006
    lines: Annotated[
        float,
        Slider(60.0, 576.0, unit="count", minimum=1.0, doc="Scan lines: 240 for consoles, 480 or 576 for television."),
    ] = 120.0
    scanlines: Annotated[Fraction, Doc("How dark it is between the lines.")] = 0.5
    mask: Annotated[
        Literal["aperture grille", "shadow mask", "none"],
        Doc(
            "Aperture grille: upright stripes of red, green and blue; shadow mask: every second row of them is offset."
        ),
    ] = "aperture grille"
    mask_strength: Annotated[Fraction, Doc("How strongly the stripes separate the colors.")] = 0.3
    triad: Annotated[
        float, Slider(2.0, 16.0, unit="px", minimum=0.5, doc="Width of a red, a green and a blue stripe together.")
    ] = 3.0

    def passes(self, draw: Draw) -> Drawn:
        # The barrel bends most in the corners.
        width, height = draw.size
        bent = abs(self.barrel) * (1.0 + (width / height) ** 2) / 2.0
        across = bent * width + abs(self.jitter) + abs(self.chroma_delay)
        overlap = (math.ceil(across) + 2, math.ceil(bent * height) + 2)
        return draw(
            "crt",
            self.image,
            edge="black",
            overlap=overlap,
            barrel=self.barrel,
            jitter=self.jitter,
            chroma_delay=self.chroma_delay,
            lines=self.lines,
            scanlines=self.scanlines,
            mask=self.mask,
            mask_strength=self.mask_strength,
            triad=self.triad,
        )
