"""The links of a graph as they are drawn, and which of them is near a point or crossed by a line. Canvas units."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import cached_property

import numpy as np
from halation.nodes import Kind
from msgspec import Struct
from numpy.typing import NDArray

from ...authoring.edits.element_id import ElementId
from ...graph import Port
from .geometry import (
    SAMPLES,
    Curve,
    Point,
    Rect,
    find_crossed,
    find_crossing,
    find_midpoint,
    measure_distances,
    sample_curves,
)


class Wire(Struct, frozen=True):
    """A link as drawn: one curve from pin to dot to pin. `fault` says why it cannot work."""

    target: Port
    source: Port
    stops: tuple[ElementId, ...]
    """The elements that it joins, from the source on."""
    kind: Kind | None
    curves: tuple[Curve, ...]
    fault: str = ""
    muted: bool = False

    def crosses_border(self, keys: Collection[ElementId]) -> bool:
        """True if exactly one end is among `keys`."""
        return (self.stops[0] in keys) != (self.stops[-1] in keys)

    @property
    def middle(self) -> Point:
        """A point about half way along the link."""
        return find_midpoint(self.curves[len(self.curves) // 2])


class LinkIndex(Struct, frozen=True, dict=True):
    """All links, with cached polylines: they stay valid while elements change their looks but not their places."""

    wires: tuple[Wire, ...] = ()

    @cached_property
    def lines(self) -> NDArray[np.float64]:
        """All curves of all links as polylines."""
        shapes = [shape for wire in self.wires for shape in wire.curves]
        return sample_curves(np.array(shapes, float)) if shapes else np.zeros((0, SAMPLES + 1, 2))

    @cached_property
    def _bounds(self) -> NDArray[np.float64]:
        """Left, top, right and bottom of what each link can reach: a curve stays among its handles."""
        spans = [len(wire.curves) for wire in self.wires]
        handles = np.array([shape for wire in self.wires for shape in wire.curves], float).reshape(-1, 4, 2)
        starts = np.cumsum([0, *spans[:-1]])
        low = np.minimum.reduceat(handles.min(axis=1), starts)
        high = np.maximum.reduceat(handles.max(axis=1), starts)
        return np.hstack([low, high])

    def list_visible(self, rect: Rect) -> list[Wire]:
        """The links of which a part may lie in a rectangle."""
        if not self.wires:
            return []
        left, top, right, bottom = self._bounds.T
        inside = (left <= rect[2]) & (right >= rect[0]) & (top <= rect[3]) & (bottom >= rect[1])
        return [self.wires[number] for number in inside.nonzero()[0].tolist()]

    @cached_property
    def by_target(self) -> Mapping[Port, Wire]:
        """Links by target."""
        return {wire.target: wire for wire in self.wires}

    @cached_property
    def _owners(self) -> list[Wire]:
        """The link that each of `lines` belongs to."""
        return [wire for wire in self.wires for _ in wire.curves]

    def find_near(self, x: float, y: float, reach: float, skip: Collection[ElementId] = ()) -> Wire | None:
        """The link nearest to a point within reach, leaving out those that join one of `skip`."""
        if not len(self.lines):
            return None
        gaps = measure_distances(self.lines, (x, y))
        near = np.flatnonzero(gaps <= reach)
        for index in near[np.argsort(gaps[near])]:
            wire = self._owners[index]
            if not any(stop in skip for stop in wire.stops):
                return wire
        return None

    def find_crossed(self, start: Point, end: Point) -> dict[Port, Point]:
        """The links that a straight line crosses, and where."""
        if not len(self.lines):
            return {}
        return {
            self._owners[index].target: find_crossing(self.lines[index], start, end)
            for index in np.flatnonzero(find_crossed(self.lines, start, end))
        }
