"""Draws curves: keys with their handles, what lies beyond them dimmer, expressions dashed."""

from __future__ import annotations

from functools import partial

from imgui_bundle import ImVec2, imgui

from ...graph import Keys, Port
from ..theme.style import mix, u32
from .frame import Frame, color_of, small
from .hits import Lanes, Mark, Tip, line_at
from .paint import KEY, paint_key
from .plane import ticks
from .rows import Lane, Row
from .shapes import Pieces, Samples, dashes, on_screen, outside, pieces, points, within

Drawn = list[imgui.ImVec2Like]
Step = ImVec2 | tuple[ImVec2, ImVec2, ImVec2]
"""A straight way to a point, or a bent one by two handles."""


class Plot:
    """Knows the curves of all values that are shown, and their points on the screen as long as nothing moves."""

    def __init__(self) -> None:
        self.samples = Samples()
        self._pieces: dict[Lane, tuple[Keys, Pieces]] = {}
        self._of: tuple[object, ...] = ()
        self._paths: list[tuple[Lane, bool, ImVec2, list[Step]]] = []
        self._dashes: list[tuple[Lane, Drawn]] = []
        self._whole: list[tuple[Lane, Pieces]] = []
        self._keys = Lanes()
        self._marks: list[tuple[Lane, list[Mark]]] = []
        self._flat: list[Mark] = []
        self._inks: tuple[tuple[object, ...], dict[Lane, tuple[int, int]]] = ((), {})

    def see(self, frame: Frame, rows: tuple[Row, ...]) -> None:
        """Find curves and keys on the screen; nothing is made anew while nothing has changed."""
        graph, settings = frame.graph, frame.editor.session.settings
        of = (graph.animation, graph.nodes, graph.controls, settings, rows)
        also = (frame.plane, frozenset(frame.state.hidden), frame.scale)
        before = self._of
        if len(before) != 8 or any(a is not b for a, b in zip(of, before[:5], strict=True)) or before[5:] != also:
            self._of = (*of, *also)
            self._make(frame, rows)
            self._marks = self._keys.marks(rows, frame.state.hidden, frame.plane)
            self._flat = [mark for _, marks in self._marks for mark in marks]
        frame.lanes, frame.marks, frame.lane_at = self._marks, self._flat, partial(self.lane_at, frame)

    def lane_at(self, frame: Frame, x: float, y: float, reach: float) -> Lane | None:
        """The curve that passes closest to a point, within reach."""
        first, last = frame.plane.frame(x - reach), frame.plane.frame(x + reach)
        near = [(lane, found) for lane, whole in self._whole if len(found := within(whole, first, last))]
        lines = points([found for _, found in near], frame.plane)
        return line_at(((lane, line) for (lane, _), line in zip(near, lines, strict=True)), x, y, reach)

    def _make(self, frame: Frame, rows: tuple[Row, ...]) -> None:
        view, plane = frame.plane.view, frame.plane
        lanes: list[tuple[Lane, bool]] = []
        shapes: list[Pieces] = []
        self._dashes, self._whole = [], []
        for row in rows:
            if row.port is None:
                continue
            for channel in range(len(row.channels) or 1):
                lane = row.port, channel
                if lane in frame.state.hidden:
                    continue
                if row.keys is None:
                    self._dashes += self._dashed(frame, row.port, channel)
                    continue
                inner = self._inner(lane, row.keys)
                self._whole.append((lane, inner))
                before, after = outside(row.keys, channel, inner, view.first, view.last)
                lanes += [(lane, False), (lane, True), (lane, True)]
                shapes += [inner, before, after]
        shapes = [within(shape, view.first, view.last) for shape in shapes]
        screen, bent = on_screen(shapes, plane)
        flat = list(map(ImVec2, screen[..., 0].ravel().tolist(), screen[..., 1].ravel().tolist()))
        curved = bent.tolist()
        self._paths, place = [], 0
        for (lane, beyond), shape in zip(lanes, shapes, strict=True):
            count = len(shape)
            if count:
                self._paths.append((lane, beyond, flat[4 * place], [
                    (flat[4 * one + 1], flat[4 * one + 2], flat[4 * one + 3]) if curved[one] else flat[4 * one + 3]
                    for one in range(place, place + count)
                ]))
            place += count

    def _inner(self, lane: Lane, keys: Keys) -> Pieces:
        known = self._pieces.get(lane)
        if known is None or known[0] is not keys:
            known = self._pieces[lane] = keys, pieces(keys, lane[1])
        return known[1]

    def _dashed(self, frame: Frame, port: Port, channel: int) -> list[tuple[Lane, Drawn]]:
        plane, view, scale = frame.plane, frame.plane.view, frame.scale
        found: list[tuple[Lane, Drawn]] = []
        settings = frame.editor.session.settings
        for line in self.samples.line(frame.graph, settings, port, channel, view.first, view.last):
            line[:, 0] = plane.rect[0] + (line[:, 0] - view.first) * plane.across
            line[:, 1] = (plane.rect[3] - (line[:, 1] - view.low) * plane.up).clip(-1e6, 1e6)
            found += [
                ((port, channel), list(map(ImVec2, *dash.T.tolist())))
                for dash in dashes(line, 6.0 * scale, 4.0 * scale)
            ]
        return found

    # --- painting ----------------------------------------------------------------------------------------------------

    def paint(self, frame: Frame, rows: tuple[Row, ...], hot: Mark | Tip | None, lit: Lane | None) -> None:
        """Draw the grid of values, the curves, and on top of them keys and handles."""
        draw, scale = imgui.get_window_draw_list(), frame.scale
        inks = self._colors(frame, rows)
        to, bend, stroke = draw.path_line_to, draw.path_bezier_cubic_curve_to, draw.path_stroke
        for lane, beyond, begin, steps in self._paths:
            to(begin)
            for step in steps:
                if type(step) is tuple:
                    bend(*step)
                else:
                    to(step)
            stroke(inks[lane][beyond], (2.5 if lane == lit and not beyond else 1.6) * scale)
        for lane, dash in self._dashes:
            draw.add_polyline(dash, inks[lane][0], 1.6 * scale, 0)
        self._tips(frame)
        spots, palette = frame.state.spots, frame.editor.palette
        chosen, ring = u32(palette.accent), u32(palette.canvas)
        size = KEY * scale * 0.85
        on_top: list[Mark] = []
        for lane, marks in frame.lanes:
            ink = inks[lane][0]
            for mark in marks:
                if spots and not spots.isdisjoint(mark.spots):
                    on_top.append(mark)
                else:
                    paint_key(draw, mark.x, mark.y, size, mark.look, ink)
        for mark in on_top:
            draw.add_circle_filled((mark.x, mark.y), size * 1.75, ring, 16)
            paint_key(draw, mark.x, mark.y, size * 1.2, mark.look, chosen)
        if hot:
            draw.add_circle((hot.x, hot.y), size * 1.9, u32(palette.accent, 0.9), 20, 1.5 * scale)

    def _colors(self, frame: Frame, rows: tuple[Row, ...]) -> dict[Lane, tuple[int, int]]:
        """What curves are drawn with inside and outside of their keys."""
        of = frame.rows, rows, frame.editor.palette
        if len(self._inks[0]) != 3 or any(a is not b for a, b in zip(of, self._inks[0], strict=True)):
            shown = {row.port for row in rows}
            found: dict[Lane, tuple[int, int]] = {}
            for place, row in enumerate(row for row in frame.rows if row.port):
                for channel in range(len(row.channels) or 1):
                    if row.port and row.port in shown:
                        color = color_of(frame.editor, row, channel, place)
                        found[row.port, channel] = u32(color), u32(color, 0.32)
            self._inks = of, found
        return self._inks[1]

    def grid(self, frame: Frame) -> None:
        """Lines of values."""
        draw, palette, plane = imgui.get_window_draw_list(), frame.editor.palette, frame.plane
        left, _, right, _ = plane.rect
        strong, faint = u32(mix(palette.grid, palette.dim, 0.22)), u32(mix(palette.canvas, palette.grid, 0.9))
        zero = u32(mix(palette.grid, palette.dim, 0.55))
        for tick in ticks(plane.view.low, plane.view.high, plane.up, 36.0 * frame.scale):
            y = round(plane.y(tick.at)) + 0.5
            draw.add_line((left, y), (right, y), zero if abs(tick.at) < 1e-12 else strong if tick.label else faint)

    def labels(self, frame: Frame) -> None:
        """The numbers of the lines of values, over the curves."""
        draw, palette, plane, scale = imgui.get_window_draw_list(), frame.editor.palette, frame.plane, frame.scale
        left, top, _, bottom = plane.rect
        ground, half = u32(palette.canvas, 0.82), 8.0 * scale
        for tick in ticks(plane.view.low, plane.view.high, plane.up, 36.0 * scale):
            y = round(plane.y(tick.at)) + 0.5
            if not tick.label or y < top + half or y > bottom - half:
                continue
            wide = imgui.calc_text_size(tick.label).x * 0.8
            draw.add_rect_filled(
                (left + 2.0 * scale, y - half), (left + 10.0 * scale + wide, y + half), ground, 3.0 * scale
            )
            small(frame, left + 6.0 * scale, y, tick.label, palette.dim)

    def _tips(self, frame: Frame) -> None:
        draw, palette, scale = imgui.get_window_draw_list(), frame.editor.palette, frame.scale
        line, fill = u32(palette.text, 0.55), u32(palette.text)
        for tip in frame.tips:
            draw.add_line(tip.root, (tip.x, tip.y), line, 1.25 * scale)
            draw.add_circle_filled((tip.x, tip.y), 3.5 * scale, fill, 12)
            draw.add_circle_filled((tip.x, tip.y), 1.9 * scale, u32(palette.canvas), 10)
