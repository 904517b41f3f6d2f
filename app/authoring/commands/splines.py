"""Commands for the points of a spline, which may have keys: each key has all points, or a point has keys of its own."""

from __future__ import annotations

from collections.abc import Iterable
from operator import add

from halation.nodes import Row

from ...errors import GraphError
from ...graph import Graph, Port
from ...language.translation import translate
from ..edits.point_keys import (
    SplineEdit,
    change_points,
    drop_point_keys,
    find_point_keys,
    key_all_points,
    key_moved_points,
    points_at,
    set_point_keys,
)
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited
from .keys import check_not_animated_outside


class MovePoints(EditCommand[None], frozen=True):
    """Set the points of a spline, or, where they have keys, a key at the current frame.

    With `ripples` all keys follow: what is added at this frame is added to each of them. With `singly` only the points
    that moved get a key, of their own.
    """

    port: Port
    points: tuple[Row, ...]
    """As many as there are."""
    label: str
    merge: str = ""
    ripples: bool = False
    singly: bool = False

    def apply(self, document: OpenDocument) -> Edited[None]:
        check_not_animated_outside(document, self.port)
        return Edited(self.label, None, self._move(document.graph, document.time.frame), merge=self.merge)

    def _move(self, graph: Graph, frame: int) -> Graph:
        if not self.ripples:
            return (key_moved_points if self.singly else key_all_points)(graph, self.port, self.points, frame)
        before = points_at(graph, self.port, frame)
        offsets = [
            tuple(b - a for a, b in zip(old, new, strict=True)) for old, new in zip(before, self.points, strict=True)
        ]

        def shift(points: tuple[Row, ...]) -> Iterable[Row]:
            return (tuple(map(add, point, offset)) for point, offset in zip(points, offsets, strict=True))

        return change_points(graph, self.port, shift, None)


class ChangePoints(EditCommand[None], frozen=True):
    """Change the points of a spline in the same way in all of its keys, or where it has none.

    `origins` says which point each one was before, None of one that is new. Without it they are the same ones.
    """

    port: Port
    change: SplineEdit
    label: str
    merge: str = ""
    origins: tuple[int | None, ...] | None = None

    def apply(self, document: OpenDocument) -> Edited[None]:
        return Edited(
            self.label, None, change_points(document.graph, self.port, self.change, self.origins), merge=self.merge
        )


class KeyPoints(EditCommand[None], frozen=True):
    """Set keys of some points at the current frame, which the other points do not get."""

    port: Port
    numbers: tuple[int, ...]
    label: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        check_not_animated_outside(document, self.port)
        graph, frame = document.graph, document.time.frame
        points = points_at(graph, self.port, frame)
        for number in self.numbers:
            keys = find_point_keys(graph, self.port, number)
            keys = keys.insert(frame) if keys.keys else keys.set(frame, points[number])
            graph = set_point_keys(graph, self.port, number, keys)
        return Edited(self.label, None, graph)


class DropPointKeys(EditCommand[None], frozen=True):
    """Remove the keys that points have of their own: they follow those of all points again, or stay where they are."""

    port: Port
    numbers: tuple[int, ...]
    label: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        if graph.keyed_points.get(self.port, {}).keys().isdisjoint(self.numbers):
            raise GraphError(translate("none of these points has keys of its own"))
        for number in self.numbers:
            graph = drop_point_keys(graph, self.port, number, document.time.frame)
        return Edited(self.label, None, graph)
