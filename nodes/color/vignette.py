from typing import Annotated, Literal

from .._declare import Doc, Fraction, Image, Pointwise, Position, Slider


class Vignette(Pointwise):
    """Darken toward the edges, as lenses do.

    Distances are parts of half the picture: 1 is the middle of an edge, 1.41 a corner.
    """

    aliases = ("cc vignette", "darken corners", "lens falloff", "edge darkening", "vignetting")

    image = Image()
    falloff: Annotated[
        Literal["smooth", "cos4"],
        Doc(
            "Smooth is a soft ring at the radius. Cos4 is the natural light loss of a lens, cos^4"
            " of the angle to its axis: the radius is then the focal length, and softness has no "
            "effect."
        ),
    ] = "smooth"
    amount: Annotated[
        float,
        Slider(
            0.0, 1.0, unit="ratio", minimum=-16.0, maximum=1.0, doc="How dark it gets: 1 is black, below 0 brightens."
        ),
    ] = 0.5
    radius: Annotated[
        float, Slider(0.1, 2.0, unit="ratio", minimum=0.001, doc="Where the ring lies: 1 is the middle of an edge.")
    ] = 1.0
    softness: Annotated[
        Fraction,
        Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="Width of the ring, as a part of the radius."),
    ] = 0.5
    roundness: Annotated[
        Fraction,
        Slider(
            0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="0 follows the shape of the picture, 1 is a circle."
        ),
    ] = 0.0
    center: Annotated[Position, Doc("The brightest point.")] = (0.5, 0.5)

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None
