from typing import Annotated, Literal

from .._declare import RGBA, Doc, Field, Fraction, Image, OutputSocket, Pointwise, Slider, Trait


class ChromaKey(Pointwise):
    """Cut out a subject in front of a green, blue or red screen, and remove the screen's light from it.

    The largest channel of the screen's color is keyed. Difference is the method of film and video keyers (Vlahos 1964):
    how far that channel exceeds the others, relative to the screen. It is exact for gray subjects (Smith and Blinn
    1996). Distance compares colors without their brightness: it is how far `rgb / (r + g + b)` is from that of the
    screen, divided by the tolerance. `out` is the subject without the light of the screen, `matte` is its coverage.
    """

    aliases = (
        "keyer", "keying", "keylight", "primatte", "ultimatte", "ibk", "ibk colour", "delta keyer", "chroma keyer",
        "ultra keyer", "color key", "channel key", "hue keyer", "green screen", "blue screen", "greenscreen",
        "bluescreen", "despill", "spill suppressor", "advanced spill suppressor", "color spill", "hue spill replace",
        "color range", "linear color key", "distance key", "difference key", "remove background", "3d keyer",
        "qualifier", "replace color", "wand mask", "rgb key",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.USES_ALPHA)

    image = Image()
    screen: Annotated[RGBA, Doc("The color of the empty screen, as it is lit.")] = (0.06, 0.5, 0.1, 1.0)
    method: Annotated[
        Literal["difference", "distance"],
        Doc("Difference keeps hair, smoke and shadows; distance is for screens that are neither green, blue nor red."),
    ] = "difference"
    limit: Annotated[
        Literal["maximum", "average"],
        Doc(
            "The limit of the screen's channel in the subject: the larger of the other two, or "
            "their average, which removes more."
        ),
    ] = "maximum"
    black: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="ratio",
            minimum=-1.0,
            maximum=1.0,
            doc="Mattes below this become 0, which cleans the screen.",
        ),
    ] = 0.0
    white: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="ratio",
            minimum=0.0,
            maximum=2.0,
            doc="Mattes above this become 1, which closes holes in the subject.",
        ),
    ] = 1.0
    tolerance: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="ratio",
            minimum=0.0,
            doc="For distance: a pixel that is at least this far from the screen's color is solid.",
        ),
    ] = 0.5
    spill: Annotated[
        Fraction,
        Slider(
            0.0,
            1.0,
            unit="ratio",
            minimum=0.0,
            maximum=1.0,
            doc="How much of the screen's light is removed from the subject.",
        ),
    ] = 1.0

    out = OutputSocket(Image(doc="The subject, premultiplied."))
    matte = OutputSocket(Field(doc="How much of each pixel the subject covers, 0..1."))
