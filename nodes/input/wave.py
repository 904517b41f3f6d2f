from typing import Annotated, Literal

from .._declare import Dial, Doc, Field, Image, OutputSocket, Pointwise, Position, Slider


class Wave(Pointwise):
    """Waves in straight bands or in rings: as sines, triangles, saws or squares."""

    aliases = (
        "wave texture", "bands", "rings", "stripes", "sine", "sine wave", "zone plate", "ripples", "wood", "lines",
        "radio waves", "venetian blinds", "square wave",
    )  # fmt: skip

    pattern: Annotated[Literal["bands", "rings"], Doc("Straight bands, or rings around the center.")] = "bands"
    profile: Annotated[Literal["sine", "triangle", "saw", "square"], Doc("The shape of a wave.")] = "sine"
    wavelength: Annotated[float, Slider(2.0, 512.0, unit="px", minimum=0.01, doc="From one crest to the next.")] = 64.0
    angle: Annotated[
        float,
        Slider(-180.0, 180.0, unit="deg", doc="The direction in which bands follow each other."),
        Dial("clockwise"),
    ] = 0.0
    phase: Annotated[
        float, Slider(-1.0, 1.0, unit="ratio", doc="Moves the waves, in wavelengths; animate it to make them run.")
    ] = 0.0
    center: Annotated[Position, Doc("Where waves start.")] = (0.5, 0.5)
    distortion: Annotated[
        float, Slider(0.0, 4.0, unit="ratio", doc="How far noise bends the waves, in wavelengths.")
    ] = 0.0
    size: Annotated[float, Slider(4.0, 512.0, unit="px", minimum=0.01, doc="The size of the noise.")] = 128.0
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another noise.")] = 0

    out = OutputSocket(Image(doc="The waves as an opaque gray."))
    value = OutputSocket(Field(doc="The waves, 0..1."))
