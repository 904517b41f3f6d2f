from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, ProxyNote, Slider
from ._morphology import grow


class DilateErode(Filter):
    """Grow a matte, or shrink it: every pixel becomes the largest or the smallest one around it.

    This is gray morphology with a flat disc or square. A fraction of a pixel mixes the two nearest whole radii, so that
    a soft edge moves by exactly the radius. It works on every channel by itself.
    """

    aliases = (
        "dilate", "erode", "grow", "shrink", "choke", "spread", "matte choker", "simple choker", "morphology", "expand",
        "contract", "minimax", "filter erode", "erode fast", "erode filter", "dilate erode", "minimum", "maximum",
        "erode blur", "erode smooth",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("out",), "it enlarges single pixels, and a proxy averages small specks away"),)

    image = Image(doc="The matte, or a premultiplied picture.")
    out = OutputSocket(follows="image")
    radius: Annotated[
        float,
        Slider(
            -50.0,
            50.0,
            unit="px",
            minimum=-1000.0,
            maximum=1000.0,
            doc="Above 0 bright areas grow, below 0 they shrink.",
        ),
    ] = 5.0
    shape: Annotated[Literal["circle", "square"], Doc("What a single bright pixel grows to.")] = "circle"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.radius == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        return grow(draw, self.image, self.radius, self.shape, self.edge)
