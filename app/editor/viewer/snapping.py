"""Snapping of what is dragged to the middle, the thirds and the edges of the picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from msgspec import Struct

from .geometry import Point

_SNAP_DEGREES = 2.0
"""How near an angle must be to one that it snaps to. Chosen by feel."""

FRACTIONS = (0.0, 1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0)
"""Lines that points snap to, as fractions of the width and the height of the picture."""


class SnapGuide(Struct, frozen=True):
    """A line across the picture at which something snapped: `x` is upright, `y` level."""

    axis: Literal["x", "y"]
    at: float
    """In pixels of the picture."""


class Snapping(Struct, frozen=True):
    """How a drag snaps in a picture. All lengths are pixels of the full picture."""

    size: Point
    reach: float = 0.0
    """The distance from which on a line attracts; 0 switches snapping off."""

    def snap(self, points: Sequence[Point]) -> tuple[Point, tuple[SnapGuide, ...]]:
        """How far points that move as one have to move so that one of them lies on a line, on each axis."""
        offsets, guides = [0.0, 0.0], list[SnapGuide]()
        for index, axis in ((0, "x"), (1, "y")):
            lines = [fraction * self.size[index] for fraction in FRACTIONS]
            gaps = [(line - point[index], line) for point in points for line in lines]
            gap, line = min(gaps, key=lambda pair: abs(pair[0]), default=(0.0, 0.0))
            if gaps and self.reach > 0.0 and abs(gap) <= self.reach:
                offsets[index] = gap
                guides.append(SnapGuide("x" if axis == "x" else "y", line))
        return (offsets[0], offsets[1]), tuple(guides)

    def snap_point(self, point: Point) -> tuple[Point, tuple[SnapGuide, ...]]:
        """A point, on the lines that attract it."""
        (x, y), guides = self.snap((point,))
        return (point[0] + x, point[1] + y), guides

    def snap_angle(self, degrees: float) -> float:
        """An angle; whole steps of 15 degrees attract it from 2 degrees away, as they are far apart on a dial."""
        nearest = round(degrees / 15.0) * 15.0
        return nearest if self.reach > 0.0 and abs(degrees - nearest) <= _SNAP_DEGREES else degrees
