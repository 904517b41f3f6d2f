"""The outlines of lights in the world: edges of areas, and the cones of spots."""

from __future__ import annotations

import math

from halation.nodes import Light, LightKind
from msgspec.structs import replace

from .geometry import Point
from .lights import Lamp
from .perspective import Place, move_place, unit

_STEPS = 64
"""The number of corners of circles in perspective."""

WIDEST_CONE = 80.0
"""Degrees: the circle of a wider cone would be larger than the picture."""


def half_axes_of(light: Light) -> tuple[Place, Place]:
    """From the middle of an area to its edges, for a light with its angles in degrees, as graphs have them."""
    return replace(light, roll=math.radians(light.roll)).half_axes


def outline(light: Light) -> list[list[Place]]:
    """The edges of a rectangle, a disc or a tube in the world, as closed paths."""
    along, across = half_axes_of(light)
    corners = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
    angles = [2.0 * math.pi * step / _STEPS for step in range(_STEPS)]
    round_points = [(math.cos(angle), math.sin(angle)) for angle in angles]
    if light.kind is LightKind.RECTANGLE:
        return [[_add_axes(light.place, along, across, corner) for corner in corners]]
    if light.kind is LightKind.DISC:
        return [[_add_axes(light.place, along, across, point) for point in round_points]]
    if light.kind is not LightKind.TUBE:
        return []
    deep = move_place((0.0, 0.0, 0.0), _cross(light.aim, unit(across)), light.size)
    ends = [move_place(light.place, along, side) for side in (1.0, -1.0)]
    sides = [[move_place(end, across, side) for end in ends] for side in (1.0, -1.0)]
    return [*([_add_axes(end, across, deep, point) for point in round_points] for end in ends), *sides]


def _add_axes(place: Place, along: Place, across: Place, parts: Point) -> Place:
    return move_place(move_place(place, along, parts[0]), across, parts[1])


def cone(lamp: Lamp, angle: float) -> list[Place]:
    """The circle in which a spot's cone of that half angle ends, around what it shines to."""
    goal = lamp.goal
    if goal is None:
        return []
    axis, length = unit(lamp.light.direction), math.dist(goal, lamp.light.place)
    radius = length * math.tan(math.radians(min(angle, WIDEST_CONE)))
    side = _across(axis, (0.0, 0.0, 1.0) if abs(axis[2]) < 0.9 else (1.0, 0.0, 0.0))
    perpendicular = _cross(axis, side)
    return [
        move_place(move_place(goal, side, radius * math.cos(step_angle)), perpendicular, radius * math.sin(step_angle))
        for step_angle in (2.0 * math.pi * step / _STEPS for step in range(_STEPS))
    ]


def sides(apex: Point, rim: list[Point]) -> tuple[Point, ...]:
    """The corners of a rim that the outline of its cone touches; none if the apex lies inside of the rim."""
    corners: list[Point] = []
    for before, at, after in zip((rim[-1], *rim[:-1]), rim, (*rim[1:], rim[0]), strict=True):
        if (_side(apex, at, before) >= 0.0) == (_side(apex, at, after) >= 0.0):
            corners.append(at)
    return tuple(corners)


def _side(start: Point, end: Point, of: Point) -> float:
    """Above 0 on one side of a line, below on the other."""
    return (end[0] - start[0]) * (of[1] - start[1]) - (end[1] - start[1]) * (of[0] - start[0])


def _across(axis: Place, near: Place) -> Place:
    return unit(_cross(axis, near))


def _cross(a: Place, b: Place) -> Place:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
