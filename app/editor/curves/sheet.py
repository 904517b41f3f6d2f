"""Draws the dope sheet: a row of keys for every value."""

from __future__ import annotations

from imgui_bundle import imgui

from ...graph import Expression, Keys, Port
from ..theme.style import mix, u32
from ..toolkit.words import cut_end
from .frame import SMALL, CurvesFrame, small
from .hits import Mark
from .paint import KEY, paint_key
from .rows import CurveRow


class SheetPainter:
    """Remembers what of the rows does not change."""

    def __init__(self) -> None:
        self._held: dict[Port, tuple[Keys, tuple[tuple[float, float], ...]]] = {}

    def paint(self, frame: CurvesFrame, marks: list[list[Mark]], hot: Mark | None) -> None:
        """Draw all rows that are seen."""
        draw, palette, scale = imgui.get_window_draw_list(), frame.context.palette, frame.scale
        left, top, right, bottom = frame.plane.rect
        band, chosen_band = u32(palette.text, 0.035), u32(palette.accent, 0.07)
        line = u32(mix(palette.canvas, palette.grid, 0.8))
        for place, row in enumerate(frame.rows):
            y = frame.top + place * frame.high
            if y > bottom or y + frame.high < top:
                continue
            if row.port is None or row.port in frame.state.shown:
                color = band if row.port is None else chosen_band
                draw.add_rect_filled((left, y), (right, y + frame.high), color)
            draw.add_line((left, y + frame.high), (right, y + frame.high), line)
            if row.port and isinstance(row.animation, Expression):
                self._expression(frame, row.animation, y)
            elif row.keys:
                self._spans(frame, row, row.keys, y + frame.high * 0.5)
        spots = frame.state.spots
        plain, summary = u32(mix(palette.text, palette.canvas, 0.12)), u32(mix(palette.dim, palette.canvas, 0.25))
        chosen, part = u32(palette.accent), u32(mix(palette.accent, palette.canvas, 0.4))
        size = KEY * scale
        for place, found in enumerate(marks):
            row = frame.rows[place]
            for mark in found:
                if row.port is None:
                    color = chosen if mark.spots <= spots else summary if spots.isdisjoint(mark.spots) else part
                    paint_key(draw, mark.x, mark.y, size * 0.8, None, color)
                else:
                    paint_key(draw, mark.x, mark.y, size, mark.look, plain if spots.isdisjoint(mark.spots) else chosen)
        if hot:
            draw.add_circle((hot.x, hot.y), size * 1.75, u32(palette.accent, 0.9), 20, 1.5 * scale)

    def _spans(self, frame: CurvesFrame, row: CurveRow, keys: Keys, y: float) -> None:
        """From the first key to the last; thicker where the value stays the same."""
        assert row.port
        if len(keys.keys) < 2:
            return
        known = self._held.get(row.port)
        if known is None or known[0] is not keys:
            known = self._held[row.port] = keys, _held(keys)
        draw, plane, palette = imgui.get_window_draw_list(), frame.plane, frame.context.palette
        draw.add_line((plane.x(keys.frames[0]), y), (plane.x(keys.frames[-1]), y), u32(palette.dim, 0.35), frame.scale)
        thick, high = u32(palette.dim, 0.32), 2.5 * frame.scale
        for start, end in known[1]:
            draw.add_rect_filled((plane.x(start), y - high), (plane.x(end), y + high), thick)

    def _expression(self, frame: CurvesFrame, expression: Expression, y: float) -> None:
        """A bar with the text, cut to fit."""
        draw, palette, scale = imgui.get_window_draw_list(), frame.context.palette, frame.scale
        left, _, right, _ = frame.plane.rect
        ink = palette.error if expression.fault else palette.good
        low, high = (left - 8.0, y + 3.0 * scale), (right + 8.0, y + frame.high - 3.0 * scale)
        draw.add_rect_filled(low, high, u32(ink, 0.14))
        draw.add_rect(low, high, u32(ink, 0.45))
        room = (right - left - 16.0 * scale) * imgui.get_font_size() / (SMALL * scale)
        text = cut_end(f"= {expression.text}", room)
        small(frame, left + 8.0 * scale, y + frame.high * 0.5, text, mix(ink, palette.text, 0.45))


def _held(keys: Keys) -> tuple[tuple[float, float], ...]:
    return tuple(
        (start.frame, end.frame)
        for start, end in zip(keys.keys, keys.keys[1:], strict=False)
        if start.interpolation == "constant" or start.value == end.value or not start.parts
    )
