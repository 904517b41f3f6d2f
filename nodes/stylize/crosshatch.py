from typing import Annotated

from .._declare import RGBA, Dial, Doc, Fraction, Image, Pointwise, ProxyNote, Slider


class Crosshatch(Pointwise):
    """Shade with a pen: the darker the picture, the thicker the strokes and the more layers of them.

    Every layer takes an equal part of the tones (the luminance as a display shows it, sRGB) and keeps all strokes of
    the lighter layers, as in tonal art maps (Praun et al. 2001). Each pixel is the mean of nine samples. Alpha is kept.
    """

    aliases = ("hatching", "sketch", "pencil", "cross hatch", "pen and ink", "scribble", "engraving", "charcoal")

    proxy_notes = (ProxyNote(("out",), "its pattern is as fine as pixels of the proxy"),)

    image = Image()
    size: Annotated[
        float, Slider(2.0, 40.0, unit="px", minimum=0.5, doc="The distance from one stroke to the next.")
    ] = 7.0
    thickness: Annotated[Fraction, Doc("The thickness of strokes, as a part of their spacing.")] = 0.35
    layers: Annotated[
        int, Slider(1, 6, unit="count", minimum=1, maximum=16, doc="The number of layers of strokes.")
    ] = 4
    angle: Annotated[
        float,
        Slider(-90.0, 90.0, unit="deg", doc="Direction of the first layer: 0 is level, 45 rises to the right."),
        Dial("counterclockwise"),
    ] = 45.0
    ink: Annotated[RGBA, Doc("Color of the strokes.")] = (0.01, 0.01, 0.015, 1.0)
    paper: Annotated[RGBA, Doc("Color between the strokes.")] = (0.9, 0.88, 0.82, 1.0)
