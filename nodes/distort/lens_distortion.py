from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, Position, Slider


class LensDistortion(Filter):
    """Bend the picture as a lens does, or straighten one that a lens has bent.

    The model of Brown (1971) and Conrady (1919), with OpenCV's names: seen from the center in focal lengths, a point
    moves to p (1 + k1 r^2 + k2 r^4 + k3 r^6) plus the tangential terms of p1 and p2. Distort applies it, undistort
    takes it back; with equal numbers each undoes the other.
    """

    image = Image()
    direction: Annotated[Literal["distort", "undistort"], Doc(
        "Distort gives a render the bend of a lens; undistort straightens footage."
    )] = "distort"
    k1: Annotated[float, Slider(-0.5, 0.5, unit="ratio", doc="Below 0 is a barrel, above 0 a pincushion.")] = -0.15
    k2: Annotated[float, Slider(-0.5, 0.5, unit="ratio", doc="The same, more toward the corners.")] = 0.0
    k3: Annotated[float, Slider(-0.5, 0.5, unit="ratio", doc="The same, in the very corners.")] = 0.0
    p1: Annotated[float, Slider(-0.1, 0.1, unit="ratio", doc="A lens tilted up or down.")] = 0.0
    p2: Annotated[float, Slider(-0.1, 0.1, unit="ratio", doc="A lens tilted sideways.")] = 0.0
    focal: Annotated[float, Slider(
        0.25, 4.0, unit="height", minimum=0.01, doc="Focal length; a longer lens bends less of what it sees."
    )] = 1.0
    zoom: Annotated[float, Slider(
        0.5, 2.0, unit="ratio", minimum=0.01, doc="Above 1 enlarges the result, to hide bent borders."
    )] = 1.0
    center: Annotated[Position, Doc("The optical axis.")] = (0.5, 0.5)
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "black"

    def identity(self) -> str | None:
        bends = (self.k1, self.k2, self.k3, self.p1, self.p2) != (0.0,) * 5
        return None if bends or self.zoom != 1.0 else "image"

    def passes(self, draw: Draw) -> Drawn:
        center = (self.center[0] * draw.size[0], self.center[1] * draw.size[1])
        return draw(
            "lens_distortion", self.image, edge=self.edge, direction=self.direction,
            radial=(self.k1, self.k2, self.k3), tangential=(self.p1, self.p2), focal=self.focal, zoom=self.zoom,
            center=center,
        )
