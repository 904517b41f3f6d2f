import math
from typing import Annotated, Literal

from .._declare import Dial, Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Position, Slider, Trait


class Ripple(Filter):
    """Shake the picture in waves, as a reflection in water.

    Every point moves by amplitude * sin(2 pi (distance / wavelength - phase)). This fades with the distance from the
    center as exp(-distance / reach).
    """

    aliases = (
        "wave warp", "wave", "water", "drip", "ripple pulse", "cc ripple pulse", "radio waves", "waves", "sine warp",
    )  # fmt: skip
    traits = (Trait.WARPS,)

    image = Image()
    out = OutputSocket(follows="image")
    shape: Annotated[Literal["circular", "straight"], Doc("Rings around the center, or waves that run one way.")] = (
        "circular"
    )
    motion: Annotated[
        Literal["along", "across"],
        Doc("Along moves points in the direction of the wave, across moves them to its sides."),
    ] = "along"
    amplitude: Annotated[float, Slider(0.0, 0.1, unit="height", doc="How far points move.")] = 0.01
    wavelength: Annotated[float, Slider(0.01, 0.5, unit="height", minimum=1e-4, doc="From one crest to the next.")] = (
        0.08
    )
    phase: Annotated[
        float, Slider(-4.0, 4.0, unit="ratio", doc="How many waves have passed; animate it to make the waves move.")
    ] = 0.0
    angle: Annotated[
        float,
        Slider(-180.0, 180.0, unit="deg", doc="For straight: the direction of the waves; 0 is right."),
        Dial("clockwise"),
    ] = 0.0
    reach: Annotated[
        float,
        Slider(0.1, 10.0, unit="height", minimum=1e-3, doc="The distance at which waves have fallen to 37 percent."),
    ] = 1.0
    center: Annotated[Position, Doc("Where the waves begin.")] = (0.5, 0.5)
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "mirror"

    def identity(self) -> str | None:
        return "image" if self.amplitude == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        center = (self.center[0] * draw.size[0], self.center[1] * draw.size[1])
        return draw(
            "ripple",
            self.image,
            edge=self.edge,
            overlap=math.ceil(abs(self.amplitude)) + 2,
            shape=self.shape,
            motion=self.motion,
            angle=self.angle,
            center=center,
            wave=(self.amplitude, self.wavelength, self.phase, self.reach),
        )
