"""A draw list that writes down what is drawn, in place of one of ImGui: shapes with their points and widths.

What the editor draws for itself can so be tested without a window: where it is, that it moves with its panel, and that
it grows with the interface.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

Point = tuple[float, float]


@dataclass(frozen=True)
class Shape:
    """One call: its kind, the points and lengths that it was given, its color or ints, and its text."""

    kind: str
    points: tuple[Point, ...]
    lengths: tuple[float, ...] = ()
    color: int = 0
    text: str = ""

    def change(self, factor: float, shift: Point) -> Shape:
        """The shape on an interface that is larger by a factor and then moved."""
        points = tuple((x * factor + shift[0], y * factor + shift[1]) for x, y in self.points)
        return Shape(self.kind, points, tuple(length * factor for length in self.lengths), self.color, self.text)


@dataclass
class DrawnShapes:
    """Stands in for a draw list. `em` is the size of text: a letter is half as wide."""

    em: float = 16.0
    shapes: list[Shape] = field(default_factory=list)

    def add_line(self, start: Any, end: Any, color: int, width: float = 1.0) -> None:
        self._add("line", (start, end), (width,), color)

    def add_rect(self, start: Any, end: Any, color: int, rounding: float = 0.0, width: float = 1.0) -> None:
        self._add("rect", (start, end), (rounding, width), color)

    def add_rect_filled(self, start: Any, end: Any, color: int, rounding: float = 0.0, flags: int = 0) -> None:
        self._add("filled rect", (start, end), (rounding,), color, str(flags))

    def add_circle(self, at: Any, radius: float, color: int, segments: int = 0, thickness: float = 1.0) -> None:
        assert segments == 0 or segments >= 10, "a circle of few segments has corners"
        self._add("circle", (at,), (radius, thickness), color)

    def add_circle_filled(self, at: Any, radius: float, color: int, segments: int = 0) -> None:
        assert segments == 0 or segments >= 10, "a disk of few segments has corners"
        self._add("disk", (at,), (radius,), color)

    def add_ngon_filled(self, at: Any, radius: float, color: int, count: int) -> None:
        self._add("ngon", (at,), (radius,), color, str(count))

    def add_ngon(self, at: Any, radius: float, color: int, count: int, width: float = 1.0) -> None:
        self._add("outlined ngon", (at,), (radius, width), color, str(count))

    def add_ellipse(
        self, at: Any, radii: Any, color: int, turn: float = 0.0, segments: int = 0, width: float = 1.0
    ) -> None:
        self._add("ellipse", (at,), (*radii, width), color, f"{turn} {segments}")

    def path_elliptical_arc_to(self, at: Any, radii: Any, turn: float, start: float, end: float) -> None:
        self._add("arc", (at,), tuple(radii), 0, f"{turn} {start:.6f} {end:.6f}")

    def path_stroke(self, color: int, width: float) -> None:
        self._add("stroke", (), (width,), color)

    def add_text(self, *words: Any, wrap_width: float = 0.0) -> None:
        if isinstance(words[1], int):
            words = (None, self.em, *words)
        _, size, at, color, text, *wrap = words
        self._add("text", (at,), (size, *wrap, wrap_width)[:2], color, text)

    def add_convex_poly_filled(self, points: Any, color: int) -> None:
        self._add("polygon", tuple(points), (), color)

    def add_quad_filled(self, a: Any, b: Any, c: Any, d: Any, color: int) -> None:
        self._add("quad", (a, b, c, d), (), color)

    def add_triangle_filled(self, a: Any, b: Any, c: Any, color: int) -> None:
        self._add("triangle", (a, b, c), (), color)

    def add_bezier_cubic(self, a: Any, b: Any, c: Any, d: Any, color: int, width: float) -> None:
        self._add("curve", (a, b, c, d), (width,), color)

    def add_image_rounded(self, picture: Any, low: Any, high: Any, first: Any, last: Any, *words: Any) -> None:
        color, rounding = words
        self._add("picture", (low, high), (rounding,), color, f"{first} {last}")

    def push_clip_rect(self, low: Any, high: Any, inside: bool) -> None:
        self._add("clip", (low, high), (), 0, str(inside))

    def pop_clip_rect(self) -> None:
        self._add("unclip", (), (), 0)

    def measure(self, text: str, wrap_width: float = 0.0) -> Any:
        """The size of a text."""
        wide, rows = 0.5 * self.em * len(text), 1
        if wrap_width:
            rows = -(-wide // wrap_width)
            wide = min(wide, wrap_width)
        return SimpleNamespace(x=wide, y=self.em * rows)

    def list_kinds(self, *kinds: str) -> list[Shape]:
        """The shapes of some kinds."""
        return [shape for shape in self.shapes if shape.kind in kinds]

    def _add(self, kind: str, points: tuple[Any, ...], lengths: tuple[float, ...], color: int, text: str = "") -> None:
        assert 0 <= color < 1 << 32, "a color has four bytes"
        pairs = tuple((float(at[0]), float(at[1])) for at in points)
        self.shapes.append(Shape(kind, pairs, tuple(map(float, lengths)), color, text))
