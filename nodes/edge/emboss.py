from math import hypot
from typing import Annotated, Any, Literal

from .._declare import Dial, Doc, Draw, Drawn, Edge, Field, Filter, Image, ProxyNote, Slider, space_pixels


class Emboss(Filter):
    """Turn the picture into a relief that is lit from one side, or shade the picture itself like one.

    The tone (luminance as a display shows it) is taken as a height. Its slope (Sobel) gives a normal, which a distant
    light shades: `N.L / L.z` (Lambert; bump mapping: Blinn 1978). That is 1 where the picture is flat. Alpha is kept.
    """

    version = 2
    aliases = ("bump boss", "bump", "relief", "bevel", "color emboss", "create bump map", "texturize", "bevel alpha")

    proxy_notes = (
        ProxyNote(("out",), "it is not linear: its result for an average differs from the average of its results"),
    )

    image = Image()
    kind: Annotated[
        Literal["relief", "bump"], Doc("Relief is gray, 0.18 where it is flat. Bump shades the picture's own colors.")
    ] = "relief"
    direction: Annotated[
        float,
        Slider(-180.0, 180.0, unit="deg", doc="Where the light stands: 0 is right, 90 is up."),
        Dial("counterclockwise"),
    ] = 135.0
    elevation: Annotated[
        float,
        Slider(
            5.0,
            90.0,
            unit="deg",
            minimum=1.0,
            maximum=90.0,
            doc="How high the light stands; low light brings out detail.",
        ),
    ] = 30.0
    height: Annotated[
        float, Slider(-20.0, 20.0, unit="px", doc="How far white rises above black; below 0 it lies deeper.")
    ] = 6.0
    softness: Annotated[
        float,
        Slider(
            0.0, 10.0, unit="px", minimum=0.0, maximum=500.0, doc="Sigma of a blur that makes the relief smooth first."
        ),
    ] = 0.7
    width: Annotated[
        float,
        Slider(
            0.0,
            16.0,
            unit="px",
            minimum=0.0,
            maximum=200.0,
            doc="Distance of the pixels whose heights make the slope; 0 is one pixel at any size.",
        ),
    ] = 1.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    @classmethod
    def upgrade(cls, version: int, values: dict[str, Any]) -> dict[str, Any]:
        return {"width": 0.0, **values}

    def passes(self, draw: Draw) -> Drawn:
        spacing = space_pixels(self.width)
        tone = draw.point("emboss_tone", self.image, result=Field())
        relief = draw.blur(tone, hypot(self.softness, spacing.sigma), self.edge, precise=True)
        return draw(
            "emboss",
            self.image,
            relief=relief,
            edge=self.edge,
            overlap={"image": 0, "relief": spacing.step},
            kind=self.kind,
            direction=self.direction,
            elevation=self.elevation,
            height=self.height,
            spacing=spacing.step,
        )
