from typing import Annotated, Literal

from .._declare import Dial, Doc, Image, Pointwise, ProxyNote, Slider


class Halftone(Pointwise):
    """Print the picture: dots or lines of ink on white paper, whose areas make the tones.

    Every screen covers exactly the part of the paper that the tone needs, in linear light, so that from a distance the
    colors up to white are correct (Demichel's equation; full gray component replacement). The four inks have the angles
    that printers use: 15, 75, 0 and 45 degrees. Each pixel is the mean of nine samples. Alpha is kept.
    """

    aliases = (
        "cc halftone",
        "dot screen", "newspaper", "print", "comic dots", "ben day", "color halftone", "raster", "screen print",
        "half tone",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("out",), "its pattern is as fine as pixels of the proxy"),)

    image = Image()
    inks: Annotated[Literal["cmyk", "black"], Doc("Cyan, magenta, yellow and black ink, or black alone.")] = "cmyk"
    pattern: Annotated[Literal["dot", "line", "cross"], Doc("Round dots, parallel lines, or a grid of lines.")] = "dot"
    size: Annotated[
        float, Slider(2.0, 40.0, unit="px", minimum=0.5, doc="The distance from one dot or line to the next.")
    ] = 6.0
    angle: Annotated[
        float,
        Slider(-90.0, 90.0, unit="deg", doc="Rotates all screens, in addition to each ink's own angle."),
        Dial("clockwise"),
    ] = 0.0
