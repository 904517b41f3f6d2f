"""The layout of the Animation panel in one frame of the window."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from imgui_bundle import imgui
from msgspec import Struct

from ...graph import Graph, Keys, Port
from ..theme.palette import RGB
from ..theme.style import mix, u32
from ..toolkit.plane import Plane, Rect
from .hits import Mark, Tip
from .rows import CurveRow, Lane
from .state import CurvesState

if TYPE_CHECKING:
    from .context import CurvesContext

TOOLBAR, LIST, RULER, BAR, ROW = 36.0, 224.0, 34.0, 12.0, 22.0
"""Sizes at UI scale 1: the tools, the names of rows, the ruler, the bar of the selection, and a row."""

SMALL = 12.5
"""The font size of axes."""


class CurvesFrame(Struct):
    """Where the parts of the panel are, and what is in them."""

    context: CurvesContext
    rows: tuple[CurveRow, ...]
    plane: Plane
    """Time and values on the part with the keys."""
    list: Rect
    ruler: Rect
    bar: Rect
    scale: float
    pointer: tuple[float, float]
    """The mouse, on the screen."""
    hovered: bool = False
    """True while nothing lies between the mouse and the part with keys, ruler and bar."""
    list_marks: Callable[[], Sequence[Mark]] = tuple
    """All visible keys."""
    find_mark: Callable[[float, float, float], Mark | None] = lambda x, y, reach: None
    """The key within reach of a point of the screen."""
    find_lane: Callable[[float, float, float], Lane | None] = lambda x, y, reach: None
    """The curve that passes within reach of a point of the screen."""
    count: int = 0
    """The number of visible keys."""
    tips: Sequence[Tip] = ()

    @property
    def state(self) -> CurvesState:
        """What the panel shows."""
        return self.context.curves

    @property
    def graph(self) -> Graph:
        """The open graph."""
        return self.context.session.graph

    @property
    def is_sheet(self) -> bool:
        """True in the dope sheet."""
        return self.state.mode == "sheet"

    @property
    def top(self) -> float:
        """Where the first row begins."""
        return self.plane.rect[1] - self.state.scroll

    @property
    def row_height(self) -> float:
        """The height of a row in pixels."""
        return round(ROW * self.scale)

    def row_at(self, y: float) -> CurveRow | None:
        """The row at a height of the screen."""
        place = int((y - self.top) // self.row_height)
        return self.rows[place] if y >= self.plane.rect[1] and 0 <= place < len(self.rows) else None

    def from_screen(self, at: tuple[float, float] | None = None) -> tuple[float, float]:
        """Frame and value at a place of the screen; in the dope sheet, pixels down the rows instead of a value."""
        x, y = at or self.pointer
        return self.plane.frame(x), y - self.top if self.is_sheet else self.plane.value(y)

    def to_screen(self, where: tuple[float, float]) -> tuple[float, float]:
        """The place on the screen of a result of `from_screen`."""
        return self.plane.x(where[0]), where[1] + self.top if self.is_sheet else self.plane.y(where[1])


def contains(rect: Rect, at: tuple[float, float]) -> bool:
    """True if a point is in a rectangle."""
    return rect[0] <= at[0] < rect[2] and rect[1] <= at[1] < rect[3]


def color_of(context: CurvesContext, row: CurveRow, channel: int, place: int) -> RGB:
    """The color of a curve: red, green and blue for channels, for numbers one of five in turn."""
    palette = context.palette
    if row.channels:
        lanes: tuple[RGB, ...] = (
            ((0.93, 0.42, 0.42), (0.45, 0.78, 0.44), (0.45, 0.64, 0.98))
            if palette.is_dark
            else ((0.78, 0.16, 0.16), (0.13, 0.50, 0.16), (0.12, 0.33, 0.80))
        )
        return lanes[channel] if channel < 3 else mix(palette.text, palette.panel, 0.3)
    kinds = list(palette.kinds.values())
    return kinds[(3, 0, 2, 4, 5)[place % 5]]


def draw_small_text(
    frame: CurvesFrame, x: float, y: float, text: str, color: RGB, alpha: float = 1.0, align: float = 0.0
) -> float:
    """A line of small letters: its left end (or with `align` 1 its right one) at `x`, its middle at `y`. Its width."""
    fonts = frame.context.fonts
    font, size = (fonts.text if fonts else imgui.get_font()), SMALL * frame.scale
    wide = imgui.calc_text_size(text).x * size / imgui.get_font_size()
    lines = imgui.get_window_draw_list()
    lines.add_text(font, size, (round(x - wide * align), round(y - size * 0.52)), u32(color, alpha), text)
    return wide


def find_keys(graph: Graph, port: Port | None) -> Keys | None:
    """The keys of a value, or None."""
    animation = graph.animation.get(port) if port else None
    return animation if isinstance(animation, Keys) else None
