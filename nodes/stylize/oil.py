from math import ceil
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, ProxyNote, Slider, Vector


class Oil(Filter):
    """Paint in dabs of oil: every pixel gets the color of the most frequent brightness around it.

    The pixels of a disc are sorted into steps of tone (the luminance as a display shows it, sRGB, up to 1). The result
    is the mean color of the step with the most pixels; if several have as many, of the darkest (Holzmann 1988, "Beyond
    Photography").
    """

    aliases = ("oil paint", "painting", "brush strokes", "painterly", "paint", "oil painting", "impressionist")

    proxy_notes = (ProxyNote(("out",), "the tone that is most frequent is one of fewer"),)

    image = Image()
    radius: Annotated[
        float,
        Slider(
            1.0, 16.0, unit="px", minimum=0.0, maximum=64.0, doc="Size of the brush. The cost grows with its square."
        ),
    ] = 4.0
    levels: Annotated[
        int, Slider(2, 32, unit="count", minimum=2, maximum=32, doc="How many steps of tone: few make large flat dabs.")
    ] = 12
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.radius < 1.0 else None

    def passes(self, draw: Draw) -> Drawn:
        tones = draw.point("oil_tones", self.image, result=Vector(width=4))
        reach = ceil(self.radius)
        painted = draw(
            "oil_dab",
            tones=tones,
            edge=self.edge,
            overlap=reach,
            result=Vector(width=4),
            reach=reach,
            radius=self.radius,
            levels=self.levels,
        )
        return draw.point("oil", tones=painted)
