"""Records where widgets are on the screen."""

from __future__ import annotations

from typing import Protocol

from imgui_bundle import imgui

from ..theme.fonts import Fonts
from ..theme.palette import Palette

Rect = tuple[float, float, float, float]
"""Left, top, right, bottom in screen pixels."""


class WidgetSurface(Protocol):
    """What widgets are drawn on, such as the context of a panel: it has the colors and records the places."""

    @property
    def palette(self) -> Palette: ...

    @property
    def places(self) -> dict[str, Rect]: ...


class TextSurface(WidgetSurface, Protocol):
    """A surface with the fonts of the window."""

    @property
    def fonts(self) -> Fonts | None: ...


def item_rect() -> Rect:
    """The rectangle of the last widget."""
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    return low.x, low.y, high.x, high.y


def record(surface: WidgetSurface, name: str) -> None:
    """Record the place of the last widget under a name."""
    surface.places[name] = item_rect()


def place(width: float, height: float = 0.0) -> Rect:
    """The rectangle at the cursor; a field is as high as any framed widget."""
    start = imgui.get_cursor_screen_pos()
    return start.x, start.y, start.x + max(width, 1.0), start.y + (height or imgui.get_frame_height())


def union(first: Rect, second: Rect) -> Rect:
    """The smallest rectangle around two rectangles."""
    return min(first[0], second[0]), min(first[1], second[1]), max(first[2], second[2]), max(first[3], second[3])
