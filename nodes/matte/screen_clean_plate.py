from typing import Annotated

from .._declare import RGBA, Doc, Draw, Drawn, Field, Filter, Fraction, Image, Pixels, ProxyNote, Slider, Trait
from ._diffusion import fill_roughly
from ._morphology import grow


class ScreenCleanPlate(Filter):
    """Make the picture of a green or blue screen without its subject, for a screen that is lit unevenly.

    Pixels that look like the screen stay, by the color difference that the keyer uses; the screen diffuses from there
    over all others. Link the result to the clean plate of the keyer.
    """

    aliases = (
        "clean plate", "screen clean plate", "cleanplate", "ibk colour", "ibk color", "clean screen", "keying screen",
        "screen color", "uneven screen", "screen correction", "smart screen", "gradient screen",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.USES_ALPHA)

    proxy_notes = (ProxyNote(("out",), "the pixels that count as the screen are whole ones"),)

    image = Image()
    garbage = Field(0.0, doc="What is never the screen, 0..1: above 0 it is filled.")
    screen: Annotated[RGBA, Doc("The color of the screen, as it is lit on average.")] = (0.06, 0.5, 0.1, 1.0)
    balance: Annotated[
        Fraction,
        Doc("The channels that the screen is compared with: 0 is the smaller one, 1 the larger, 0.5 their average."),
    ] = 0.5
    low: Annotated[
        float,
        Slider(0.0, 1.0, unit="ratio", minimum=0.0, doc="Screen that is darker than this part of its color is filled."),
    ] = 0.7
    high: Annotated[
        float,
        Slider(1.0, 3.0, unit="ratio", minimum=1.0, doc="Screen that is brighter than this multiple is filled."),
    ] = 2.0
    tolerance: Annotated[
        float,
        Slider(
            0.0,
            0.5,
            unit="ratio",
            minimum=0.0,
            doc="How far `rgb / (r + g + b)` may be from that of the screen; farther is filled.",
        ),
    ] = 0.12
    inset: Annotated[
        float,
        Slider(
            0.0,
            50.0,
            unit="px",
            minimum=0.0,
            maximum=500.0,
            doc="How far from the subject pixels of the screen must be to stay.",
        ),
    ] = 7.0
    smooth: Annotated[
        float,
        Slider(0.0, 100.0, unit="px", minimum=0.0, maximum=2000.0, doc="Blur of the plate, which removes its noise."),
    ] = 6.0

    def passes(self, draw: Draw) -> Drawn:
        seen: Pixels = draw.point(
            "screen_clean_plate_seen", self.image, self.garbage, screen=self.screen, balance=self.balance, low=self.low,
            high=self.high, tolerance=self.tolerance,
        )  # fmt: skip
        if self.inset > 0.0:
            seen = grow(draw, seen, -self.inset, "circle", "clamp")
        known = draw.point("screen_clean_plate_known", seen=seen, result=Field())
        color = draw.point("screen_clean_plate_color", self.image)
        plate = fill_roughly(draw, color, known)
        # The subject is gone, so that it does not bleed into the blur.
        smooth: Pixels = draw.blur(plate, self.smooth) if self.smooth > 0.0 else plate
        return draw.point("screen_clean_plate", plate=smooth, screen=self.screen, known=draw.reduce(known, "max"))
