"""Lists of points as flat numbers and as rows of a file, one for each point: those of splines and of strokes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any, cast

from msgspec import Struct

Row = tuple[float, ...]


class RowLayout(Struct, frozen=True):
    """What a row holds: x and y, then numbers that may be left out at its end, where they are `fill`."""

    length: int
    """The numbers of a point."""
    fill: float
    most: int
    """The most points of one list."""
    words: str
    """The numbers after x and y, in words."""

    def split(self, numbers: Row) -> tuple[Row, ...]:
        """All numbers of each point."""
        return tuple(numbers[at : at + self.length] for at in range(0, len(numbers), self.length))

    def join(self, points: Iterable[Row]) -> Row:
        """The flat numbers from rows of two and more numbers."""
        return tuple(part for point in points for part in (*point, *(self.fill,) * (self.length - len(point))))

    def list(self, numbers: Row) -> tuple[Row, ...]:
        """The rows of a file, without what may be left out."""
        return tuple(self._trim(point) for point in self.split(numbers))

    def read(self, setting: object) -> Row | None:
        """The flat numbers from the rows of a file, or from numbers that are flat already; None for others."""
        if not isinstance(setting, list | tuple) or not setting:
            return None
        parts = cast("tuple[Any, ...]", tuple(setting))  # pyright: ignore[reportUnknownArgumentType]
        if _are_numbers(parts):
            return tuple(map(float, parts)) if len(parts) % self.length == 0 else None
        if not all(isinstance(row, list | tuple) for row in parts):
            return None
        rows = [tuple(row) for row in cast("tuple[list[Any], ...]", parts)]
        if not all(2 <= length <= self.length for length in set(map(len, rows))):
            return None
        numbers = self.join(rows)
        return tuple(map(float, numbers)) if _are_numbers(numbers) else None

    def _trim(self, point: Row) -> Row:
        length = len(point)
        while length > 2 and point[length - 1] == self.fill:
            length -= 1
        return point[:length]


def _are_numbers(parts: Iterable[object]) -> bool:
    return set(map(type, parts)) <= {int, float} or all(
        isinstance(part, int | float) and not isinstance(part, bool) for part in parts
    )


SPLINE_ROWS = RowLayout(7, 0.0, 4096, "then up to five numbers for its tangents and its feather")
"""Points of a spline: x, y, the two tangents as offsets, and a feather. The most points are eight times the 500 of an
outline that is traced by hand point by point."""

STROKE_ROWS = RowLayout(3, 1.0, 4096, "and the pressure, which is 1 where it is left out")
"""Points of a stroke: x, y and pressure. A minute of drawing has about 3600 positions of the pointer."""

ROWS: Mapping[str, RowLayout] = MappingProxyType({"spline": SPLINE_ROWS, "stroke": STROKE_ROWS})
"""The layouts by the type of a value."""
