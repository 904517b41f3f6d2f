from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Fraction, Image, OutputSocket, Slider, Vector


class Echo(Filter):
    """Repeat moving objects, each time fainter: earlier frames beside this one, as in a multiple exposure.

    Echo k is the frame `k spacing` frames earlier, times `decay^k`. Behind and in front lay the frames over each other
    by alpha (Porter and Duff 1984), so that they need a picture with transparent parts; the others also work with light
    on black. Average keeps the exposure: all frames are added and divided by the sum of their weights.
    """

    aliases = (
        "time echo", "trails", "motion trail", "ghosting", "frame echo", "cc wide time", "wide time", "repeat frames",
        "strobe", "after image",
    )  # fmt: skip

    image = Image()
    out = OutputSocket(follows="image")
    echoes: Annotated[
        int, Slider(0, 12, unit="count", minimum=0, maximum=127, doc="How many frames are added to this one.")
    ] = 4
    spacing: Annotated[
        int,
        Slider(-8, 8, unit="count", doc="How many frames lie between two echoes; below 0 they come from the future."),
    ] = 2
    decay: Annotated[Fraction, Doc("How strong each echo is compared to the one before.")] = 0.6
    mode: Annotated[
        Literal["brightest", "add", "screen", "average", "behind", "in front"],
        Doc(
            "How echoes are combined with the picture. Brightest compares channel by channel; "
            "screen adds but never passes white."
        ),
    ] = "brightest"

    def identity(self) -> str | None:
        return "image" if self.echoes == 0 or self.spacing == 0 or self.decay == 0.0 else None

    def times(self, frame: int) -> Mapping[str, tuple[int, ...]]:
        return {"image": tuple(frame - back * self.spacing for back in range(self.echoes + 1))}

    def passes(self, draw: Draw) -> Drawn:
        """All but the last sum stay in 32 bits."""
        vector, total = Vector(width=4), 1.0
        joined = draw.point("echo_first", self.image, result=vector)
        for back in range(1, self.echoes + 1):
            strength = self.decay**back
            total += strength
            joined = draw.point(
                "echo_join",
                image=draw.at(self.image, draw.frame - back * self.spacing),
                seen=joined,
                strength=strength,
                mode=self.mode,
                result=vector,
            )
        return draw.point("echo", seen=joined, total=total if self.mode == "average" else 1.0)
