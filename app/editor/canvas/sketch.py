"""A cached drawing of a node: shapes and words relative to its corner."""

from __future__ import annotations

from msgspec import Struct, field

from .brush import TEXT, CanvasColors, DrawContext
from .geometry import Rect

Corner = tuple[float, float]


class Sketch(Struct):
    """Shapes and words in canvas units; shapes come first, words on top."""

    brush: DrawContext
    fills: list[tuple[float, float, float, float, int, float, int]] = field(default_factory=list)
    frames: list[tuple[float, float, float, float, int, float]] = field(default_factory=list)
    circles: list[tuple[float, float, float, int]] = field(default_factory=list)
    triangles: list[tuple[Corner, Corner, Corner, int]] = field(default_factory=list)
    words: list[tuple[float, float, float, int, str]] = field(default_factory=list)

    @property
    def ink(self) -> CanvasColors:
        """The canvas colors."""
        return self.brush.ink

    def fill_rect(self, rect: Rect, color: int, rounding: float = 0.0, flags: int = 0) -> None:
        """Add a filled rectangle."""
        self.fills.append((*rect, color, rounding, flags))

    def draw_outline(self, rect: Rect, color: int, rounding: float = 0.0) -> None:
        """Add the outline of a rectangle."""
        self.frames.append((*rect, color, rounding))

    def draw_circle(self, x: float, y: float, radius: float, color: int) -> None:
        """Add a filled circle."""
        self.circles.append((x, y, radius, color))

    def draw_triangle(self, a: Corner, b: Corner, c: Corner, color: int) -> None:
        """Add a filled triangle."""
        self.triangles.append((a, b, c, color))

    def draw_text(self, x: float, y: float, color: int, text: str, size: float = TEXT) -> None:
        """Add a line whose left end is at `x` and whose middle is at `y`."""
        self.words.append((x, y - size * 0.5, size, color, text))

    def draw_right(self, x: float, y: float, color: int, text: str, size: float = TEXT) -> None:
        """Add a line whose right end is at `x`."""
        self.draw_text(x - self.measure(text, size), y, color, text, size)

    def shorten(self, text: str, room: float, size: float = TEXT) -> str:
        """Cut text to a width of `room`."""
        return self.brush.shorten(text, room, size)

    def measure(self, text: str, size: float = TEXT) -> float:
        """Measure the width of a line."""
        return self.brush.measure(text, size)

    def draw(self, brush: DrawContext, x: float, y: float) -> None:
        """Draw the sketch with its corner at a canvas position."""
        draw, s = brush.draw, brush.to.scale
        left, top = brush.to.to_screen(x, y)
        for x0, y0, x1, y1, color, rounding, flags in self.fills:
            draw.add_rect_filled(
                (left + x0 * s, top + y0 * s), (left + x1 * s, top + y1 * s), color, rounding * s, flags
            )
        for x0, y0, x1, y1, color, rounding in self.frames:
            draw.add_rect((left + x0 * s, top + y0 * s), (left + x1 * s, top + y1 * s), color, rounding * s, brush.line)
        for a, b, radius, color in self.circles:
            draw.add_circle_filled((left + a * s, top + b * s), radius * s, color)
        for (ax, ay), (bx, by), (cx, cy), color in self.triangles:
            draw.add_triangle_filled(
                (left + ax * s, top + ay * s), (left + bx * s, top + by * s), (left + cx * s, top + cy * s), color
            )
        font = brush.fonts.text
        for a, b, size, color, text in self.words:
            draw.add_text(font, size * s, (left + a * s, top + b * s), color, text)
