"""Commands for the points of a spline, which may have keys: each key has all points."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from operator import add
from typing import cast

from halation.nodes import Row, join_points, split_points
from msgspec import structs

from ...graph import Key, Keys, Port
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited
from .values import SetValues

SplineEdit = Callable[[tuple[Row, ...]], Iterable[Row]]
"""What an edit makes of the points of a spline."""


class MovePoints(EditCommand[None], frozen=True):
    """Set the points of a spline, or, where they have keys, a key at the current frame.

    With `ripples` all keys follow: what is added at this frame is added to each of them.
    """

    port: Port
    points: tuple[Row, ...]
    """As many as there are."""
    label: str
    merge: str = ""
    ripples: bool = False

    def apply(self, document: OpenDocument) -> Edited[None]:
        keys = document.graph.animation.get(self.port)
        if not self.ripples or not isinstance(keys, Keys):
            return SetValues({self.port: join_points(self.points)}, self.label, self.merge).apply(document)
        before = split_points(cast("Row", keys.evaluate(document.time.frame)))
        offsets = [
            tuple(b - a for a, b in zip(old, new, strict=True)) for old, new in zip(before, self.points, strict=True)
        ]

        def shift(points: tuple[Row, ...]) -> Iterable[Row]:
            return (tuple(map(add, point, offset)) for point, offset in zip(points, offsets, strict=True))

        return ChangePoints(self.port, shift, self.label, self.merge).apply(document)


class ChangePoints(EditCommand[None], frozen=True):
    """Change the points of a spline in the same way in all of its keys, or where it has none."""

    port: Port
    change: SplineEdit
    label: str
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        keys = graph.animation.get(self.port)
        if isinstance(keys, Keys):
            changed = structs.replace(keys, keys=tuple(map(self._change_key, keys.keys)))
            return Edited(self.label, None, graph.animate(self.port, changed), merge=self.merge)
        points = self._change(cast("Row", graph.value(self.port)))
        return Edited(self.label, None, graph.set(self.port, points), merge=self.merge)

    def _change_key(self, key: Key) -> Key:
        points = self._change(cast("Row", key.value))
        if len(points) != len(cast("Row", key.value)):
            return structs.replace(key, value=points, left=(), right=())  # handles have a number for each channel
        return structs.replace(key, value=points)

    def _change(self, numbers: Row) -> Row:
        return join_points(tuple(round(part, 6) for part in point) for point in self.change(split_points(numbers)))
