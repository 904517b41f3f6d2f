import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    Doc,
    Draw,
    Drawn,
    Edge,
    Filter,
    Image,
    Kernel,
    OutputSocket,
    Position,
    Reach,
    Resampling,
    Slider,
    Trait,
)

_ENDLESS = 1e9
"""Focal lengths: farther than any picture, and finite, so that GLSL can calculate with it."""

_STEPS = 512
"""Of what a lens sees, from the axis to a corner."""

_MISSED = 1e-3
"""How far, in focal lengths, a point that is found may be from the one that is wanted. A choice: half a pixel for a
focal length of 500 pixels."""


_REACH: Mapping[Kernel, int] = {"nearest": 2, "triangle": 2, "catmull-rom": 3, "mitchell": 3, "lanczos": 4}
"""Pixels that a kernel reads around a place, and one more for rounding."""


class LensDistortion(Filter):
    """Distort the picture as a lens does, or straighten footage that a lens has distorted.

    The model of Brown (1971) and Conrady (1919), with OpenCV's names. Let p be a point, measured from the center in
    focal lengths. It moves to p (1 + k1 r^2 + k2 r^4 + k3 r^6) plus the tangential terms of p1 and p2. Distort applies
    this, undistort inverts it; with equal numbers each undoes the other.
    """

    aliases = (
        "lens distort", "undistort", "optics compensation", "barrel", "pincushion", "fish eye", "fisheye",
        "lens correction", "st map lens", "distort lens", "movie distortion", "wide angle",
    )  # fmt: skip
    traits = (Trait.WARPS,)

    image = Image()
    out = OutputSocket(follows="image")
    direction: Annotated[
        Literal["distort", "undistort"],
        Doc("Distort gives a render the bend of a lens; undistort straightens footage."),
    ] = "distort"
    k1: Annotated[
        float, Slider(-0.5, 0.5, unit="ratio", doc="Below 0 gives barrel distortion, above 0 pincushion distortion.")
    ] = -0.15
    k2: Annotated[
        float, Slider(-0.5, 0.5, unit="ratio", doc="The same as k1, with more effect toward the corners.")
    ] = 0.0
    k3: Annotated[float, Slider(-0.5, 0.5, unit="ratio", doc="The same as k1, with effect only near the corners.")] = (
        0.0
    )
    p1: Annotated[float, Slider(-0.1, 0.1, unit="ratio", doc="Tangential: a lens that is tilted up or down.")] = 0.0
    p2: Annotated[float, Slider(-0.1, 0.1, unit="ratio", doc="Tangential: a lens that is tilted to the side.")] = 0.0
    focal: Annotated[
        float,
        Slider(0.25, 4.0, unit="height", minimum=0.01, doc="Focal length; a longer lens bends less of what it sees."),
    ] = 1.0
    zoom: Annotated[
        float, Slider(0.5, 2.0, unit="ratio", minimum=0.01, doc="Above 1 enlarges the result, to hide bent borders.")
    ] = 1.0
    center: Annotated[Position, Doc("The optical axis.")] = (0.5, 0.5)
    kernel: Resampling = "triangle"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "black"

    def identity(self) -> str | None:
        bends = (self.k1, self.k2, self.k3, self.p1, self.p2) != (0.0,) * 5
        return None if bends or self.zoom != 1.0 else "image"

    def passes(self, draw: Draw) -> Drawn:
        center = (self.center[0] * draw.size[0], self.center[1] * draw.size[1])
        x, y = (max(abs(at), abs(side - at)) / self.focal for at, side in zip(center, draw.size, strict=True))
        _, moved = self._bounds(x / self.zoom, y / self.zoom)
        beyond = draw.overscan / self.focal
        far, _ = self._bounds((x + beyond) / self.zoom, (y + beyond) / self.zoom)
        overlap = None
        if moved is not None:
            part, reach = 1.0 / self.zoom, math.ceil(moved * self.focal + 1.0 / self.zoom) + _REACH[self.kernel]
            matrix = (part, 0.0, center[0] * (1.0 - part), 0.0, part, center[1] * (1.0 - part))
            overlap = Reach(matrix, (reach, reach))
        return draw(
            "lens_distortion",
            self.image,
            edge=self.edge,
            overlap=overlap,
            direction=self.direction,
            radial=(self.k1, self.k2, self.k3),
            tangential=(self.p1, self.p2),
            focal=self.focal,
            zoom=self.zoom,
            center=center,
            far=far,
            kernel=self.kernel,
        )

    def _bounds(self, x: float, y: float) -> tuple[float, float | None]:
        """How far from the axis straight points lie that are seen at most so far across and down, and how far they
        move, all in focal lengths; None where that is unknown."""
        radius = math.hypot(x, y)
        if self.direction == "undistort":
            pushed = sum(abs(k) * radius**power for k, power in ((self.k1, 3), (self.k2, 5), (self.k3, 7)))
            return radius, pushed + 3.0 * radius**2 * (abs(self.p1) + abs(self.p2))
        if self.p1 or self.p2 or self.edge != "black":  # behind a bend that turns back, the source can lie anywhere
            return _ENDLESS, None
        step = radius / _STEPS
        straight = bent = moved = 0.0
        while bent < radius and straight < _STEPS * radius:
            straight += step
            square = straight * straight
            before, bent = bent, straight * (1.0 + square * (self.k1 + square * (self.k2 + square * self.k3)))
            moved = max(moved, abs(straight - bent))
            if bent < before:
                break
        return straight + step, moved + 2.0 * step + _MISSED
