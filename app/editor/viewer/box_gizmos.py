"""Gizmos with corners: a rectangle that is kept, and the frame of a picture that is moved, scaled, turned and skewed.

A transform maps a pixel q of the frame to pivot + position + R K S (q - pivot): scaled by S, skewed by K, turned by R.
A drag solves this for the value that its grip stands for, the others stay.
"""

from __future__ import annotations

import math

from msgspec import Struct

from ...graph import Port
from .geometry import Point
from .gizmos import GizmoDrag, GizmoGrip, GizmoOutline, hold_axis
from .snapping import SnapGuide, Snapping

_SIDES = ("nw", "ne", "se", "sw", "n", "e", "s", "w")
_CORNERS = ("nw", "ne", "se", "sw")

MOST_SKEW = 80.0
"""Degrees: at 90 nothing is left of the picture."""

LEAST_SCALE = 1e-3
"""No drag makes a scale smaller: with 0 the way back would be lost."""


class RectangleGizmo(Struct, frozen=True):
    """Two opposite corners, as fractions of a frame of which the picture shows `origin` to `origin` + `size`."""

    top_left: Port
    bottom_right: Port
    box: tuple[float, float, float, float]
    """Left, top, right and bottom."""
    origin: Point
    size: Point
    is_deferred: bool = False

    @property
    def grips(self) -> tuple[GizmoGrip, ...]:
        """The middle, the sides and the corners."""
        return (
            GizmoGrip(self.top_left, self._at("move"), "place", "move"),
            *(GizmoGrip(self._port(part), self._at(part), "corner", part) for part in reversed(_SIDES)),
        )

    @property
    def outlines(self) -> tuple[GizmoOutline, ...]:
        """The rectangle."""
        return (GizmoOutline(tuple(self._at(part) for part in _CORNERS), is_closed=True),)

    def _port(self, part: str) -> Port:
        return self.top_left if part in ("n", "w", "nw", "ne") else self.bottom_right

    def _at(self, part: str) -> Point:
        left, top, right, bottom = self.box
        x = left if "w" in part else right if "e" in part and part != "move" else (left + right) / 2.0
        y = top if "n" in part else bottom if "s" in part else (top + bottom) / 2.0
        return self.origin[0] + x * self.size[0], self.origin[1] + y * self.size[1]

    def drag(self, part: str, to: Point, snapping: Snapping, *, is_constrained: bool = False) -> GizmoDrag:
        """Move a corner, a side or all of it; constrained keeps the proportions, or the axis."""
        start, box = self._at(part), list(self.box)
        if part == "move":
            to = hold_axis(start, to) if is_constrained else to
            by = to[0] - start[0], to[1] - start[1]
            corners = [(at[0] + by[0], at[1] + by[1]) for at in map(self._at, (*_CORNERS, "move"))]
            more, guides = snapping.snap(corners)
            across, down = ((by[i] + more[i]) / self.size[i] for i in (0, 1))
            across = min(max(across, -box[0]), 1.0 - box[2])
            down = min(max(down, -box[1]), 1.0 - box[3])
            return self._give((box[0] + across, box[1] + down, box[2] + across, box[3] + down), guides)
        if is_constrained and part in _CORNERS:
            to = self._keep_proportions(part, to)
        at, guides = snapping.snap_point(to)
        x, y = ((at[i] - self.origin[i]) / self.size[i] for i in (0, 1))
        for index, side, number in ((0, "w", x), (2, "e", x), (1, "n", y), (3, "s", y)):
            if side in part:
                box[index] = min(max(number, 0.0), 1.0)
        used = {axis for axis, letters in (("x", "we"), ("y", "ns")) if set(letters) & set(part)}
        return self._give((box[0], box[1], box[2], box[3]), tuple(guide for guide in guides if guide.axis in used))

    def _keep_proportions(self, part: str, to: Point) -> Point:
        opposite = self._at(_CORNERS[(_CORNERS.index(part) + 2) % 4])
        start = self._at(part)
        diagonal = start[0] - opposite[0], start[1] - opposite[1]
        length = diagonal[0] ** 2 + diagonal[1] ** 2 or 1.0
        share = ((to[0] - opposite[0]) * diagonal[0] + (to[1] - opposite[1]) * diagonal[1]) / length
        return opposite[0] + share * diagonal[0], opposite[1] + share * diagonal[1]

    def _give(self, box: tuple[float, float, float, float], guides: tuple[SnapGuide, ...]) -> GizmoDrag:
        left, top, right, bottom = (round(number, 5) for number in box)
        return GizmoDrag({self.top_left: (left, top), self.bottom_right: (right, bottom)}, guides)


class TransformGizmo(Struct, frozen=True):
    """The frame of a picture, as a node moves, scales, turns and skews it about a pivot."""

    node: str
    size: Point
    position: Point
    rotation: float
    """Degrees, clockwise."""
    scale: Point
    skew: Point
    """Degrees: how far upright edges lean, and how far level ones fall."""
    pivot: Point
    """In pixels."""
    arm: float
    """How far above the frame the grip is that turns it."""
    names: frozenset[str]
    """The values that can be dragged."""
    unit: float = 1.0
    """The pixels of 1 of the position."""
    is_deferred: bool = False

    @property
    def grips(self) -> tuple[GizmoGrip, ...]:
        """The middle, the arm, the diamonds on two edges, the sides and the corners."""
        width, height = self.size
        grips = [
            GizmoGrip(Port(self.node, "skew"), self.map((width * 0.75, 0.0)), "skew", "x"),
            GizmoGrip(Port(self.node, "skew"), self.map((0.0, height * 0.75)), "skew", "y"),
            GizmoGrip(Port(self.node, "rotation"), self._find_arm_end(), "turn", "turn"),
            *(GizmoGrip(Port(self.node, "scale"), self.map(self._corner(part)), "corner", part) for part in _SIDES),
            GizmoGrip(Port(self.node, "position"), self._find_move_grip(), "place", "move"),
        ]
        return tuple(grip for grip in grips if grip.port.socket in self.names)

    @property
    def outlines(self) -> tuple[GizmoOutline, ...]:
        """The frame, and the arm."""
        frame = GizmoOutline(tuple(self.map(self._corner(part)) for part in _CORNERS), is_closed=True)
        arm = GizmoOutline((self.map((self.size[0] / 2.0, 0.0)), self._find_arm_end()))
        return (frame, arm) if "rotation" in self.names else (frame,)

    @property
    def _center(self) -> Point:
        """Where the pivot comes to lie."""
        return self.pivot[0] + self.position[0] * self.unit, self.pivot[1] + self.position[1] * self.unit

    def map(self, point: Point) -> Point:
        """Where a pixel of the frame lies in the result."""
        x, y = (point[i] - self.pivot[i] for i in (0, 1))
        x, y = x * self.scale[0], y * self.scale[1]
        lean, fall = (math.tan(math.radians(angle)) for angle in self.skew)
        x, y = x + lean * y, y + fall * x
        radians = math.radians(self.rotation)
        x, y = x * math.cos(radians) - y * math.sin(radians), x * math.sin(radians) + y * math.cos(radians)
        center = self._center
        return center[0] + x, center[1] + y

    def drag(self, part: str, to: Point, snapping: Snapping, *, is_constrained: bool = False) -> GizmoDrag:
        """Move, scale, turn or skew; constrained keeps the axis, the proportions, or whole steps of 15 degrees."""
        match part:
            case "move":
                return self._move(to, snapping, is_constrained)
            case "turn":
                return self._turn(to, snapping, is_constrained)
            case "x" | "y":
                return self._skew(part, to)
            case _:
                return self._grow(part, to, snapping, is_constrained)

    def _corner(self, part: str) -> Point:
        x = 0.0 if "w" in part else self.size[0] if "e" in part else self.size[0] / 2.0
        y = 0.0 if "n" in part else self.size[1] if "s" in part else self.size[1] / 2.0
        return x, y

    def _find_arm_end(self) -> Point:
        """A point above the upper edge of the frame, however it is turned."""
        foot, below = self.map((self.size[0] / 2.0, 0.0)), self.map((self.size[0] / 2.0, self.size[1]))
        length = math.dist(foot, below) or 1.0
        return foot[0] + (foot[0] - below[0]) / length * self.arm, foot[1] + (foot[1] - below[1]) / length * self.arm

    def _find_move_grip(self) -> Point:
        """A point right of the middle of the frame: in the middle itself there is the pivot, most of the time."""
        middle, right = (self.map((self.size[0] * share, self.size[1] / 2.0)) for share in (0.5, 1.0))
        share = self.arm / (math.dist(middle, right) or 1.0)
        return middle[0] + (right[0] - middle[0]) * share, middle[1] + (right[1] - middle[1]) * share

    def _back(self, to: Point) -> Point:
        """A point of the result before it was moved and turned, from the pivot."""
        x, y = (to[i] - self._center[i] for i in (0, 1))
        angle = -math.radians(self.rotation)
        return x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)

    def _move(self, to: Point, snapping: Snapping, is_constrained: bool) -> GizmoDrag:
        start = self._find_move_grip()
        to = hold_axis(start, to) if is_constrained else to
        by = to[0] - start[0], to[1] - start[1]
        points = [
            self.map((self.size[0] / 2.0, self.size[1] / 2.0)),
            *(self.map(self._corner(part)) for part in _CORNERS),
        ]
        more, guides = snapping.snap([(x + by[0], y + by[1]) for x, y in points])
        x, y = (round(self.position[i] + (by[i] + more[i]) / self.unit, 3) for i in (0, 1))
        return GizmoDrag({Port(self.node, "position"): (x, y)}, guides)

    def _turn(self, to: Point, snapping: Snapping, is_constrained: bool) -> GizmoDrag:
        center = self._center
        arm = self._find_arm_end()
        before, after = (math.atan2(at[1] - center[1], at[0] - center[0]) for at in (arm, to))
        angle = self.rotation + math.remainder(math.degrees(after - before), 360.0)
        angle = round(angle / 15.0) * 15.0 if is_constrained else snapping.snap_angle(angle)
        return GizmoDrag({Port(self.node, "rotation"): round(math.remainder(angle, 360.0), 2)})

    def _grow(self, part: str, to: Point, snapping: Snapping, is_constrained: bool) -> GizmoDrag:
        to, guides = snapping.snap_point(to)
        lean, fall = (math.tan(math.radians(angle)) for angle in self.skew)
        x, y = self._back(to)
        whole = 1.0 - lean * fall
        x, y = (x - lean * y) / whole, (y - fall * x) / whole
        away = tuple(self._corner(part)[i] - self.pivot[i] for i in (0, 1))
        scale, solved = list(self.scale), (x, y)
        if is_constrained and part in _CORNERS:
            before = tuple(away[i] * self.scale[i] for i in (0, 1))
            length = before[0] ** 2 + before[1] ** 2 or 1.0
            share = (x * before[0] + y * before[1]) / length
            scale = [share * self.scale[0], share * self.scale[1]]
        else:
            for index, letters in ((0, "we"), (1, "ns")):
                if set(letters) & set(part) and abs(away[index]) > 0.5:
                    scale[index] = solved[index] / away[index]
        wide, high = (round(math.copysign(max(abs(number), LEAST_SCALE), number), 4) for number in scale)
        return GizmoDrag({Port(self.node, "scale"): (wide, high)}, guides)

    def _skew(self, part: str, to: Point) -> GizmoDrag:
        grip = (self.size[0] * 0.75, 0.0) if part == "x" else (0.0, self.size[1] * 0.75)
        x, y = ((grip[i] - self.pivot[i]) * self.scale[i] for i in (0, 1))
        solved, skew = self._back(to), list(self.skew)
        across = (solved[0] - x, y) if part == "x" else (solved[1] - y, x)
        if abs(across[1]) > 0.5:
            angle = math.degrees(math.atan(across[0] / across[1]))
            skew[0 if part == "x" else 1] = round(min(max(angle, -MOST_SKEW), MOST_SKEW), 2)
        return GizmoDrag({Port(self.node, "skew"): (skew[0], skew[1])})
