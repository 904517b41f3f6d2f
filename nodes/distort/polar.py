from typing import Annotated, Literal

from .._declare import Dial, Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Position, Slider


class Polar(Filter):
    """Wrap the picture into a disc, or unwrap a disc into a strip.

    Wrap bends the picture once around the center, clockwise: its top is at the center, and its bottom at the radius.
    Unwrap is the inverse. Effects between the two work around the center or along the radius: a horizontal blur between
    unwrap and wrap is a spin blur.
    """

    aliases = (
        "coordinate space",
        "polar coordinates", "coord space", "rectangular to polar", "tiny planet", "spherical transform", "unwrap",
    )  # fmt: skip

    image = Image()
    out = OutputSocket(follows="image")
    direction: Annotated[Literal["wrap", "unwrap"], Doc("Wrap makes a disc, unwrap opens it.")] = "wrap"
    radius: Annotated[float, Slider(0.1, 1.5, unit="height", minimum=1e-3, doc="Radius of the disc.")] = 0.5
    rotation: Annotated[
        float,
        Slider(
            -180.0,
            180.0,
            unit="deg",
            doc="The direction from the center in which the left side of the picture lies; 0 is right.",
        ),
        Dial("clockwise"),
    ] = -90.0
    center: Annotated[Position, Doc("The middle of the disc.")] = (0.5, 0.5)
    edge: Annotated[
        Edge,
        Doc(
            "What lies outside the disc and the picture. Outside the disc, black is empty; the others stretch its rim."
        ),
    ] = "clamp"

    def passes(self, draw: Draw) -> Drawn:
        center = (self.center[0] * draw.size[0], self.center[1] * draw.size[1])
        if self.direction == "unwrap":
            return draw(
                "polar_unwrap", self.image, edge=self.edge, radius=self.radius, rotation=self.rotation, center=center
            )
        return draw(
            "polar_wrap",
            self.image,
            edge="wrap",
            radius=self.radius,
            rotation=self.rotation,
            center=center,
            empty=self.edge == "black",
        )
