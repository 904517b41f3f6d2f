"""Drawing on the canvas: transform, zoom, colors and text of one frame."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from halation.nodes import Kind
from imgui_bundle import imgui
from msgspec import Struct, field
from msgspec.structs import replace

from ..theme.fonts import Fonts
from ..theme.palette import PALETTES, RGB, Palette
from ..theme.style import mix, u32
from .geometry import CanvasTransform, Point, Rect
from .layout import HEADER

TEXT, SMALL, TITLE = 13.5, 12.0, 14.0
"""Font sizes in canvas units."""

_MEASURED = 48.0
"""The size at which widths of texts are measured: larger than what is drawn, so that rounding counts little."""

DETAILS_FROM = 0.45
"""The zoom below which values and names of sockets are left out: a picture then fills the node."""

READABLE = 11.0
"""Titles are no smaller than this, in pixels at UI scale 1, however far the canvas is zoomed out."""


class CanvasColors(Struct, frozen=True):
    """The colors of a theme, ready to draw with."""

    palette: Palette
    node: int
    node_muted: int
    outline: int
    field: int
    fill: int
    switch: int
    switch_on: int
    on_accent: int
    text: int
    dim: int
    faint: int
    accent: int
    accent_soft: int
    error: int
    warning: int
    canvas: int
    grid: int
    grid_strong: int
    picture: int
    shadow: tuple[tuple[float, int], ...]
    kinds: dict[Kind | None, int]
    kinds_dim: dict[Kind | None, int]

    headers: dict[str, int]
    headers_muted: dict[str, int]
    marks: dict[str, int]
    """Headers strong enough to be seen where they are small."""
    over: int
    """Text of less weight on a header."""

    def find_header_color(self, name: str, muted: bool = False) -> int:
        """The header color of a node category."""
        header_colors = self.headers_muted if muted else self.headers
        return header_colors.get(name) or header_colors[""]


@lru_cache(maxsize=4)
def make_canvas_colors(theme: str) -> CanvasColors:
    """The canvas colors of a theme, by its name."""
    p = make_node_palette(theme)
    dark = theme == "dark"
    kinds: dict[Kind | None, RGB] = {**p.kinds, None: p.dim}
    strength = 0.10 if dark else 0.055
    return CanvasColors(
        p,
        u32(p.node),
        u32(mix(p.node, p.canvas, 0.6)),
        u32(p.border if dark else mix(p.border, p.shadow, 0.25)),
        u32(p.field),
        u32(p.fill),
        u32(p.raised),
        u32(p.accent),
        u32(p.on_accent),
        u32(p.text),
        u32(p.dim),
        u32(p.dim, 0.6),
        u32(p.accent),
        u32(p.accent, 0.12),
        u32(p.error),
        u32(p.warning),
        u32(p.canvas),
        u32(p.grid),
        u32(mix(p.grid, p.dim, 0.16)),
        u32(mix(p.node, p.shadow, 0.35 if dark else 0.12)),
        tuple((grow, u32(p.shadow, strength)) for grow in (1.0, 3.0, 6.0)),
        {kind: u32(color) for kind, color in kinds.items()},
        {kind: u32(mix(color, p.canvas, 0.7)) for kind, color in kinds.items()},
        {name: u32(color) for name, color in p.categories.items()},
        {name: u32(mix(color, p.node, 0.6)) for name, color in p.categories.items()},
        {name: u32(mix(color, p.text, 0.3)) for name, color in p.categories.items()},
        u32(p.text, 0.6),
    )


@lru_cache(maxsize=4)
def make_node_palette(theme: str) -> Palette:
    """The palette of a theme with fields that stand out from nodes as they do from panels."""
    p = PALETTES[theme]
    return replace(p, field=mix(p.node, p.canvas, 0.62), hover=mix(p.node, p.dim, 0.28))


class TextCache(Struct):
    """Cached widths of texts, and texts cut to a width."""

    _widths: dict[tuple[bool, str], float] = field(default_factory=dict[tuple[bool, str], float])
    sketches: dict[str, Any] = field(default_factory=dict[str, Any])
    """Cached drawings of elements, by key."""
    _short: dict[tuple[bool, str, float], str] = field(default_factory=dict[tuple[bool, str, float], str])
    """Lines cut to a width, by the ratio of that width to the font size."""

    def measure(self, fonts: Fonts, text: str, size: float, bold: bool = False) -> float:
        """Measure the width of a line in the units of `size`."""
        relative_width = self._widths.get((bold, text))
        if relative_width is None:
            imgui.push_font(fonts.bold if bold else fonts.text, _MEASURED)
            relative_width = self._widths[bold, text] = imgui.calc_text_size(text).x / imgui.get_font_size()
            imgui.pop_font()
        return relative_width * size

    def shorten(self, fonts: Fonts, text: str, size: float, room: float, bold: bool = False) -> str:
        """Cut a line with an ellipsis where it does not fit in `room`."""
        if self.measure(fonts, text, size, bold) <= room:
            return text
        key = (bold, text, round(room / size, 2))
        shortened = self._short.get(key)
        if shortened is None:
            if len(self._short) > 4000:
                self._short.clear()
            length = len(text) - 1
            while length > 1 and self.measure(fonts, text[:length].rstrip() + "…", size, bold) > room:
                length -= 1
            shortened = self._short[key] = text[:length].rstrip() + "…"
        return shortened


class DrawContext(Struct):
    """Draws in canvas units onto the panel."""

    draw: imgui.ImDrawList
    to: CanvasTransform
    zoom: float
    ink: CanvasColors
    fonts: Fonts
    texts: TextCache
    visible: Rect
    """The part of the canvas that is visible."""
    title: float = 0.0
    """The size of titles in canvas units: it grows where they could not be read otherwise."""
    header: float = 0.0
    """The height of headers, which have room for their titles."""

    def __post_init__(self) -> None:
        self.title = max(TITLE, READABLE / self.zoom)
        self.header = max(HEADER, self.title * 1.45)

    def draw_text(self, x: float, y: float, color: int, text: str, size: float = TEXT, bold: bool = False) -> None:
        """Draw a line whose left end is at `x` and whose middle is at `y` (canvas units)."""
        to, s = self.to, self.to.scale
        font = self.fonts.bold if bold else self.fonts.text
        self.draw.add_text(font, size * s, (to.x + x * s, to.y + (y - size * 0.5) * s), color, text)

    def draw_right(self, x: float, y: float, color: int, text: str, size: float = TEXT) -> None:
        """Draw a line whose right end is at `x`."""
        self.draw_text(x - self.texts.measure(self.fonts, text, size), y, color, text, size)

    def shorten(self, text: str, room: float, size: float = TEXT, bold: bool = False) -> str:
        """Cut text to a width of `room` canvas units."""
        return self.texts.shorten(self.fonts, text, size, room, bold)

    def measure(self, text: str, size: float = TEXT, bold: bool = False) -> float:
        """Measure the width of a line in canvas units."""
        return self.texts.measure(self.fonts, text, size, bold)

    def project_corners(self, rect: Rect, grow: float = 0.0) -> tuple[Point, Point]:
        """A rectangle on the screen, `grow` units larger on each side."""
        to, s = self.to, self.to.scale
        return (
            (to.x + (rect[0] - grow) * s, to.y + (rect[1] - grow) * s),
            (to.x + (rect[2] + grow) * s, to.y + (rect[3] + grow) * s),
        )

    def project(self, rect: Rect) -> Rect:
        """A rectangle in pixels of the screen."""
        low, high = self.project_corners(rect)
        return *low, *high

    def fill_rect(self, rect: Rect, color: int, rounding: float = 0.0, grow: float = 0.0, flags: int = 0) -> None:
        """Draw a filled rectangle."""
        low, high = self.project_corners(rect, grow)
        self.draw.add_rect_filled(low, high, color, (rounding + grow) * self.to.scale, flags)

    def draw_outline(
        self, rect: Rect, color: int, rounding: float = 0.0, thickness: float = 1.0, grow: float = 0.0
    ) -> None:
        """Draw the outline of a rectangle; `thickness` is in pixels at UI scale 1."""
        low, high = self.project_corners(rect, grow)
        self.draw.add_rect(low, high, color, (rounding + grow) * self.to.scale, thickness * self.line)

    @property
    def line(self) -> float:
        """Pixels of a line of thickness 1: thinner when zoomed out, but always visible."""
        return max(self.to.scale, self.to.scale / self.zoom * 0.75)
