from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Image, OutputSocket, Slider


class Sanitize(Filter):
    """Repair pixels that are NaN, infinite, too bright or negative, before they spread.

    `neighbors` gives a broken channel the mean of its finite values among the 3 x 3 pixels around, or 0 if there are
    none, as OpenImageIO's fixNonFinite does. Channels of the same pixel that are finite stay.
    """

    aliases = ("remove nan", "fix nan", "clean infinite", "nan fix", "kill nan", "remove infinity")

    image = Image()
    out = OutputSocket(follows="image")
    repair: Annotated[Literal["neighbors", "black"], Doc("What a broken channel (NaN, infinity) becomes.")] = (
        "neighbors"
    )
    negative: Annotated[
        Literal["keep", "clip", "mirror"],
        Doc("What light below 0 becomes: unchanged, black, or its absolute value. Negative alpha always becomes 0."),
    ] = "clip"
    maximum: Annotated[
        float,
        Slider(
            1.0,
            65504.0,
            unit="scene",
            minimum=0.0,
            maximum=65504.0,
            doc="The highest value; 65504 is the largest half float.",
        ),
    ] = 65504.0
    limit_alpha: Annotated[bool, Doc("Keep alpha within 0..1.")] = True

    def passes(self, draw: Draw) -> Drawn:
        return draw(
            "sanitize",
            self.image,
            overlap=1,
            repair=self.repair,
            negative=self.negative,
            maximum=self.maximum,
            limit_alpha=self.limit_alpha,
        )
