"""Draws the dope sheet: a row of keys for every value."""

from __future__ import annotations

from imgui_bundle import imgui

from ...graph import Expression, Keys, Port
from ..theme.style import mix, u32
from ..toolkit.words import cut_end
from .frame import SMALL, CurvesFrame, draw_small_text
from .hits import Mark
from .paint import KEY, paint_key
from .rows import CurveRow


class SheetPainter:
    """Paints the rows of keys; caches which spans hold their value."""

    def __init__(self) -> None:
        self._holds: dict[Port, tuple[Keys, tuple[tuple[float, float], ...]]] = {}

    def paint(self, frame: CurvesFrame, marks: list[list[Mark]], hot: Mark | None) -> None:
        """Draw all visible rows."""
        draw, palette, scale = imgui.get_window_draw_list(), frame.context.palette, frame.scale
        left, top, right, bottom = frame.plane.rect
        band, chosen_band = u32(palette.text, 0.035), u32(palette.accent, 0.07)
        line = u32(mix(palette.canvas, palette.grid, 0.8))
        for place, row in enumerate(frame.rows):
            y = frame.top + place * frame.row_height
            if y > bottom or y + frame.row_height < top:
                continue
            if row.port is None or row.port in frame.state.chosen_rows:
                color = band if row.port is None else chosen_band
                draw.add_rect_filled((left, y), (right, y + frame.row_height), color)
            draw.add_line((left, y + frame.row_height), (right, y + frame.row_height), line)
            if row.port and isinstance(row.animation, Expression):
                self._paint_expression(frame, row.animation, y)
            elif row.keys:
                self._paint_spans(frame, row, row.keys, y + frame.row_height * 0.5)
        spots = frame.state.spots
        plain, summary = u32(mix(palette.text, palette.canvas, 0.12)), u32(mix(palette.dim, palette.canvas, 0.25))
        chosen, part = u32(palette.accent), u32(mix(palette.accent, palette.canvas, 0.4))
        size = KEY * scale
        for place, row_marks in enumerate(marks):
            row = frame.rows[place]
            for mark in row_marks:
                if row.port is None:
                    color = chosen if mark.spots <= spots else summary if spots.isdisjoint(mark.spots) else part
                    paint_key(draw, mark.x, mark.y, size * 0.8, None, color)
                else:
                    paint_key(draw, mark.x, mark.y, size, mark.look, plain if spots.isdisjoint(mark.spots) else chosen)
        if hot:
            draw.add_circle((hot.x, hot.y), size * 1.75, u32(palette.accent, 0.9), 20, 1.5 * scale)

    def _paint_spans(self, frame: CurvesFrame, row: CurveRow, keys: Keys, y: float) -> None:
        """From the first key to the last; thicker where the value stays the same."""
        assert row.port
        if len(keys.keys) < 2:
            return
        holds = self._holds.get(row.port)
        if holds is None or holds[0] is not keys:
            holds = self._holds[row.port] = keys, _find_holds(keys)
        draw, plane, palette = imgui.get_window_draw_list(), frame.plane, frame.context.palette
        draw.add_line((plane.x(keys.frames[0]), y), (plane.x(keys.frames[-1]), y), u32(palette.dim, 0.35), frame.scale)
        thick, high = u32(palette.dim, 0.32), 2.5 * frame.scale
        for start, end in holds[1]:
            draw.add_rect_filled((plane.x(start), y - high), (plane.x(end), y + high), thick)

    def _paint_expression(self, frame: CurvesFrame, expression: Expression, y: float) -> None:
        """A bar with the text, cut to fit."""
        draw, palette, scale = imgui.get_window_draw_list(), frame.context.palette, frame.scale
        left, _, right, _ = frame.plane.rect
        ink = palette.error if expression.fault else palette.good
        low, high = (left - 8.0, y + 3.0 * scale), (right + 8.0, y + frame.row_height - 3.0 * scale)
        draw.add_rect_filled(low, high, u32(ink, 0.14))
        draw.add_rect(low, high, u32(ink, 0.45))
        room = (right - left - 16.0 * scale) * imgui.get_font_size() / (SMALL * scale)
        text = cut_end(f"= {expression.text}", room)
        draw_small_text(frame, left + 8.0 * scale, y + frame.row_height * 0.5, text, mix(ink, palette.text, 0.45))


def _find_holds(keys: Keys) -> tuple[tuple[float, float], ...]:
    return tuple(
        (start.frame, end.frame)
        for start, end in zip(keys.keys, keys.keys[1:], strict=False)
        if start.interpolation == "constant" or start.value == end.value or not start.channels
    )
