from typing import Annotated

from .._declare import Dial, Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Position, Slider


class Kaleidoscope(Filter):
    """Mirror one slice of the picture all around, as in a tube of mirrors."""

    aliases = ("cc kaleida", "mirror", "mandala", "reflect", "symmetry", "kaleido")

    image = Image()
    out = OutputSocket(follows="image")
    segments: Annotated[
        int,
        Slider(
            2, 24, unit="count", minimum=1, maximum=360, doc="How many pairs of a slice and its mirror image there are."
        ),
    ] = 6
    rotation: Annotated[
        float, Slider(-180.0, 180.0, unit="deg", doc="Turns the figure, clockwise."), Dial("clockwise")
    ] = 0.0
    slice: Annotated[
        float,
        Slider(-180.0, 180.0, unit="deg", doc="The direction of the slice from the center of the picture; 0 is right."),
        Dial("clockwise"),
    ] = 0.0
    zoom: Annotated[float, Slider(0.25, 4.0, unit="ratio", minimum=0.01, doc="Above 1 enlarges the slice.")] = 1.0
    center: Annotated[Position, Doc("Where the mirrors meet.")] = (0.5, 0.5)
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "mirror"

    def passes(self, draw: Draw) -> Drawn:
        center = (self.center[0] * draw.size[0], self.center[1] * draw.size[1])
        return draw(
            "kaleidoscope",
            self.image,
            edge=self.edge,
            segments=self.segments,
            center=center,
            tube=(self.rotation, self.slice, self.zoom),
        )
