from collections.abc import Mapping
from typing import Annotated, Any, Literal

from .._declare import Doc, Draw, Drawn, Edge, Field, Filter, Image, OutputSocket, ProxyNote, Slider, space_pixels


class EdgeDetect(Filter):
    """Show how fast the picture changes: the length of its gradient, or its Laplacian.

    Every operator is scaled so that a step of height 1 along a row or column gives 1, so that all of them have the same
    brightness. Sobel and Feldman 1968, Prewitt 1970, Scharr 2000. Alpha is kept.
    """

    version = 2
    aliases = (
        "find edges", "sobel", "prewitt", "laplacian", "edges", "filter", "edge filter", "outline", "roberts", "kirsch",
        "edge", "edge detection",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("magnitude", "out"), "its lines are one or two pixels wide at any size", "look"),)

    image = Image()
    operator: Annotated[
        Literal["sobel", "scharr", "prewitt", "laplace"],
        Doc("Scharr differs least between directions; Laplace draws thin double lines."),
    ] = "sobel"
    channels: Annotated[
        Literal["luminance", "separate"],
        Doc("Gray edges of the luminance, or each color channel's own. `magnitude` is then the strongest channel's."),
    ] = "luminance"
    strength: Annotated[float, Slider(0.0, 10.0, unit="ratio", minimum=0.0, doc="Factor on the edges.")] = 1.0
    threshold: Annotated[
        float,
        Slider(0.0, 1.0, unit="scene", minimum=0.0, doc="Subtracted from every edge, so that weaker edges disappear."),
    ] = 0.0
    width: Annotated[
        float,
        Slider(
            0.0,
            16.0,
            unit="px",
            minimum=0.0,
            maximum=200.0,
            doc="Distance of the pixels that are compared, and about the width of lines; 0 is one pixel at any size.",
        ),
    ] = 1.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    out = OutputSocket()
    magnitude = OutputSocket(Field())

    @classmethod
    def upgrade(cls, version: int, values: dict[str, Any]) -> dict[str, Any]:
        return {"width": 0.0, **values}

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        spacing = space_pixels(self.width)
        image = draw.blur(self.image, spacing.sigma, self.edge, precise=True)
        # Pixels are a whole number apart, the width need not be: the gain makes up for the difference.
        settings: dict[str, Any] = {
            "image": image,
            "edge": self.edge,
            "overlap": spacing.step,
            "operator": self.operator,
            "channels": self.channels,
            "strength": self.strength * spacing.gain,
            "threshold": self.threshold / spacing.gain,
            "spacing": spacing.step,
        }
        return {
            "out": draw("edge_detect", **settings),
            "magnitude": draw("edge_detect_magnitude", result=Field(), **settings),
        }
