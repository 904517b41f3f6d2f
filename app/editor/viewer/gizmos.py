"""Gizmos: values of a node as grips on the picture, and what a drag of a grip makes of them. Nothing here draws.

All points are pixels of the full picture, x right and y down. A gizmo holds the values at the start of a drag, so that
rounding does not add up while the mouse moves.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Protocol

from halation.nodes import Plain
from msgspec import Struct

from ...graph import Port
from .geometry import Point
from .grips import GripShape
from .snapping import SnapGuide, Snapping


class GizmoGrip(Struct, frozen=True):
    """A point that can be dragged. `part` tells the grips of one gizmo apart; `port` is the value that it changes."""

    port: Port
    at: Point
    shape: GripShape = "place"
    part: str = ""

    @property
    def id(self) -> str:
        """The name of the grip among all of the picture."""
        return f"{self.port} {self.part}".rstrip()


class GizmoOutline(Struct, frozen=True):
    """A line that belongs to a gizmo: through points, or a circle. Those of grips appear when the mouse is over it."""

    points: tuple[Point, ...]
    radius: float = 0.0
    """Above 0, a dashed circle around the first point."""
    part: str | None = None
    """The grip that it belongs to; None always shows it."""
    is_closed: bool = False


class GizmoDrag(Struct, frozen=True):
    """What a drag makes of the values, and the lines to which it snapped."""

    values: Mapping[Port, Plain]
    guides: tuple[SnapGuide, ...] = ()


class Gizmo(Protocol):
    """Grips that belong together."""

    @property
    def is_deferred(self) -> bool:
        """True if a drag counts when the button is released: the picture would move away under the mouse."""
        ...

    @property
    def grips(self) -> tuple[GizmoGrip, ...]:
        """The grips, those on top last."""
        ...

    @property
    def outlines(self) -> tuple[GizmoOutline, ...]:
        """The lines below the grips."""
        ...

    def drag(self, part: str, to: Point, snapping: Snapping, *, is_constrained: bool = False) -> GizmoDrag:
        """The values for a grip that is dragged to a point; constrained keeps an axis, or proportions."""
        ...


class PlaceGizmo(Struct, frozen=True):
    """A position, or a length across and down from a point."""

    port: Port
    value: Point
    unit: Point
    """The pixels of 1 across, and of 1 down."""
    origin: Point = (0.0, 0.0)
    """Where the value 0, 0 is."""
    low: float = -1.0
    high: float = 2.0
    """The range of both numbers."""
    shape: GripShape = "place"
    is_deferred: bool = False

    @property
    def at(self) -> Point:
        """Where the grip is."""
        return self.origin[0] + self.value[0] * self.unit[0], self.origin[1] + self.value[1] * self.unit[1]

    @property
    def grips(self) -> tuple[GizmoGrip, ...]:
        """The position."""
        return (GizmoGrip(self.port, self.at, self.shape),)

    @property
    def outlines(self) -> tuple[GizmoOutline, ...]:
        """A line from the point where the value is 0, for lengths."""
        return () if self.shape == "place" else (GizmoOutline((self.origin, self.at), part=""),)

    def drag(self, part: str, to: Point, snapping: Snapping, *, is_constrained: bool = False) -> GizmoDrag:
        """Move the position; constrained along one axis."""
        at, guides = snapping.snap_point(hold_axis(self.at, to) if is_constrained else to)
        parts = ((at[i] - self.origin[i]) / self.unit[i] if self.unit[i] else 0.0 for i in (0, 1))
        x, y = (round(min(max(number, self.low), self.high), 5) for number in parts)
        return GizmoDrag({self.port: (x, y)}, guides)


class JoiningLines(Struct, frozen=True):
    """Lines that join positions, which have grips of their own."""

    lines: tuple[tuple[Point, ...], ...]
    is_deferred: bool = False
    grips: tuple[GizmoGrip, ...] = ()

    @property
    def outlines(self) -> tuple[GizmoOutline, ...]:
        """The lines."""
        return tuple(GizmoOutline(points) for points in self.lines)

    def drag(self, part: str, to: Point, snapping: Snapping, *, is_constrained: bool = False) -> GizmoDrag:
        """Nothing: there is no grip."""
        return GizmoDrag({})


class SizeGizmo(Struct, frozen=True):
    """A length, as the radius of a circle around a point."""

    port: Port
    value: float
    unit: float
    """The pixels of 1."""
    center: Point
    direction: float
    """Where around the circle the grip is, in degrees clockwise from the right."""
    least: float
    """The grip never is nearer to the center, so that it can be seen and reached for a length of 0."""
    low: float
    high: float
    is_deferred: bool = False

    @property
    def radius(self) -> float:
        """The length in pixels."""
        return abs(self.value) * self.unit

    @property
    def grips(self) -> tuple[GizmoGrip, ...]:
        """The dot on the circle."""
        return (GizmoGrip(self.port, go_from(self.center, self.direction, self.least + self.radius), "size"),)

    @property
    def outlines(self) -> tuple[GizmoOutline, ...]:
        """The circle, and a line to the grip."""
        at = self.grips[0].at
        return GizmoOutline((self.center, at), part=""), GizmoOutline((self.center,), self.radius, part="")

    def drag(self, part: str, to: Point, snapping: Snapping, *, is_constrained: bool = False) -> GizmoDrag:
        """Change the length by how much farther from the center the mouse is; constrained in whole steps of ten."""
        angle = math.radians(self.direction)
        far = (to[0] - self.center[0]) * math.cos(angle) + (to[1] - self.center[1]) * math.sin(angle)
        length = (far - self.least) / self.unit * (-1.0 if self.value < 0.0 else 1.0)
        if is_constrained:
            step = 10.0 ** math.floor(math.log10(max(abs(self.value), 1e-3)))
            length = round(length / step) * step
        low = max(self.low, 0.0) if self.value >= 0.0 else self.low
        return GizmoDrag({self.port: round(min(max(length, low), self.high), 5)})


class TurnGizmo(Struct, frozen=True):
    """An angle, as a dial around a point."""

    port: Port
    value: float
    """In degrees."""
    center: Point
    arm: float
    """The length of the dial's arm."""
    is_clockwise: bool
    low: float
    high: float
    is_deferred: bool = False

    @property
    def grips(self) -> tuple[GizmoGrip, ...]:
        """The end of the arm."""
        return (GizmoGrip(self.port, go_from(self.center, self._turn, self.arm), "turn"),)

    @property
    def outlines(self) -> tuple[GizmoOutline, ...]:
        """The arm, and the dial."""
        arm = GizmoOutline((self.center, self.grips[0].at))
        return arm, GizmoOutline((self.center,), self.arm, part="")

    @property
    def _turn(self) -> float:
        return self.value if self.is_clockwise else -self.value

    def drag(self, part: str, to: Point, snapping: Snapping, *, is_constrained: bool = False) -> GizmoDrag:
        """Turn the arm to the mouse, on the shorter way; constrained to whole steps of 15 degrees."""
        degrees = math.degrees(math.atan2(to[1] - self.center[1], to[0] - self.center[0]))
        angle = degrees if self.is_clockwise else -degrees
        angle += 360.0 * round((self.value - angle) / 360.0)
        angle = round(angle / 15.0) * 15.0 if is_constrained else snapping.snap_angle(angle)
        while angle > self.high and angle - 360.0 >= self.low:
            angle -= 360.0
        while angle < self.low and angle + 360.0 <= self.high:
            angle += 360.0
        return GizmoDrag({self.port: round(min(max(angle, self.low), self.high), 2)})


def bend_through(start: Point, middle: Point, end: Point) -> tuple[Point, ...]:
    """Points on the parabola through three points."""
    points = list[Point]()
    for number in range(13):
        t = number / 12
        a, b, c = (1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)
        points.append((a * start[0] + b * middle[0] + c * end[0], a * start[1] + b * middle[1] + c * end[1]))
    return tuple(points)


def go_from(start: Point, degrees: float, length: float) -> Point:
    """The point at a distance from another one, in a direction clockwise from the right."""
    angle = math.radians(degrees)
    return start[0] + length * math.cos(angle), start[1] + length * math.sin(angle)


def hold_axis(start: Point, to: Point) -> Point:
    """A point on a level or upright line through the start, whichever is nearer."""
    across = abs(to[0] - start[0]) >= abs(to[1] - start[1])
    return (to[0], start[1]) if across else (start[0], to[1])
