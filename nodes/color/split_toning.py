from typing import Annotated

from .._declare import RGBA, Doc, Fraction, Image, Pointwise, Slider, Trait


class SplitToning(Pointwise):
    """Tint shadows and highlights in different colors, as toned prints and film looks do; luminance stays.

    How much a pixel belongs to the highlights rises smoothly (3t^2 - 2t^3) over the range, which is counted in stops
    around middle gray (0.18). A gray tint changes nothing. Works on the color without its alpha; alpha stays. The
    alphas of the tints have no effect.
    """

    aliases = (
        "tint", "duotone", "tritone", "photo filter", "shadows highlights color", "teal and orange", "split tone",
        "color tint", "toning", "color temperature shadows", "sepia",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    shadows: Annotated[RGBA, Doc("The color that dark grays take on; only its hue and strength count.")] = (
        0.35,
        0.60,
        1.0,
        1.0,
    )
    highlights: Annotated[RGBA, Doc("The color that bright grays take on.")] = (1.0, 0.72, 0.40, 1.0)
    balance: Annotated[
        float, Slider(-6.0, 6.0, unit="EV", doc="Where shadows end and highlights begin, in stops above middle gray.")
    ] = 0.0
    range: Annotated[
        float, Slider(0.5, 12.0, unit="EV", minimum=0.01, doc="Over how many stops shadows change into highlights.")
    ] = 6.0
    amount: Annotated[
        Fraction,
        Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="Strength of the tints; link a mask here."),
    ] = 0.5

    def identity(self) -> str | None:
        gray = all(color[0] == color[1] == color[2] for color in (self.shadows, self.highlights))
        return "image" if gray or self.amount == 0.0 else None
