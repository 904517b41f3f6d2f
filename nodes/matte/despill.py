from typing import Annotated, Literal

from .._declare import Doc, Fraction, Image, Pointwise, Slider


class Despill(Pointwise):
    """Take the light of a green or blue screen out of a picture.

    What the screen's channel has above a limit, which the other two channels set, is removed. A part of what is removed
    can come back as gray light, so that edges do not get darker.
    """

    aliases = (
        "spill suppress", "spill suppressor", "hue correct", "color spill", "green spill", "spill", "despill screen",
        "advanced spill suppressor", "key cleaner", "blue spill", "color suppress",
    )  # fmt: skip

    image = Image()
    screen: Annotated[Literal["green", "blue", "red"], Doc("The channel of the screen.")] = "green"
    limit: Annotated[
        Literal["average", "maximum", "minimum", "double"],
        Doc(
            "What the screen's channel may reach: the average of the other two, the larger one, the smaller one. "
            "Double: two thirds of the first and a third of the second, in the order red, green, blue."
        ),
    ] = "average"
    amount: Annotated[
        Fraction, Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="How much of the spill is removed.")
    ] = 1.0
    scale: Annotated[
        float,
        Slider(0.5, 1.5, unit="ratio", minimum=0.0, maximum=4.0, doc="Factor on the limit; below 1 removes more."),
    ] = 1.0
    keep_light: Annotated[
        Fraction,
        Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="How much of its luminance comes back as gray."),
    ] = 0.0

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None
