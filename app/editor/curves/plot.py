"""Draws curves: keys with their handles, extrapolation dimmer, expressions dashed."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import compress
from operator import not_

from imgui_bundle import ImVec2, imgui

from ...graph import Interpolation, Port
from ..theme.style import mix, u32
from ..toolkit.plane import Plane, View, ticks
from .bundle import Bundle, BundleBuilder
from .frame import CurvesFrame, color_of, draw_small_text
from .hits import Mark, Tip
from .paint import KEY, paint_key
from .rows import CurveRow, Lane
from .shapes import ExpressionSamples, Pieces, cut_dashes

ScreenPoints = list[imgui.ImVec2Like]


MAX_DISTINCT_KEYS = 400
"""With more visible keys than this, all are drawn alike: their shapes are then too close to recognize."""


class CurvePaths:
    """Curve pieces on the screen: straight lines and cubics. Few Python objects hold all of the many pieces."""

    def __init__(self, screen: Pieces, bent: list[bool], cuts: list[int], lanes: list[tuple[Lane, bool]]) -> None:
        flat = list(map(ImVec2, screen[..., 0].ravel().tolist(), screen[..., 1].ravel().tolist()))
        self._points = flat[0::4], flat[1::4], flat[2::4], flat[3::4]
        self._bent, self._cuts, self._lanes = bent, cuts, lanes

    def draw(
        self, draw: imgui.ImDrawList, inks: Mapping[Lane, tuple[int, int]], lit: Lane | None, scale: float
    ) -> None:
        """Draw the pieces in the colors of their lanes, dimmer outside of the keys."""
        to, bend, stroke = draw.path_line_to, draw.path_bezier_cubic_curve_to, draw.path_stroke
        starts, first_handles, second_handles, ends = self._points
        for (lane, beyond), begin, stop in zip(self._lanes, self._cuts, self._cuts[1:], strict=False):
            if begin == stop:
                continue
            to(starts[begin])
            pieces = zip(
                first_handles[begin:stop],
                second_handles[begin:stop],
                ends[begin:stop],
                self._bent[begin:stop],
                strict=True,
            )
            for first, second, end, bends in pieces:
                if bends:
                    bend(first, second, end)
                else:
                    to(end)
            stroke(inks[lane][beyond], (2.5 if lane == lit and not beyond else 1.6) * scale)


class Plot:
    """The curves of all visible values, with cached positions on the screen."""

    def __init__(self) -> None:
        self.samples = ExpressionSamples()
        self._builder = BundleBuilder()
        self._bundle = Bundle()
        self._visible = self._bundle.project(Plane(View(), (0.0, 0.0, 1.0, 1.0)))
        self._bundle_inputs: tuple[object, ...] = ()
        self._visible_inputs: tuple[object, ...] = ()
        self._chosen_inputs: tuple[object, ...] = ()
        self._ink_inputs: tuple[object, ...] = ()
        self._paths: list[CurvePaths] = []
        self._dashes: list[tuple[Lane, ScreenPoints]] = []
        self._keys: tuple[list[float], list[float], list[Interpolation], list[int]] = [], [], [], []
        """The visible keys: places, shapes, and the numbers of their channels."""
        self._chosen: list[bool] = []
        self._inks: dict[Lane, tuple[int, int]] = {}

    def update(self, frame: CurvesFrame, rows: tuple[CurveRow, ...]) -> None:
        """Update curves and keys on the screen; unchanged parts come from the caches."""
        hidden = frozenset(frame.state.hidden)
        if not _is_same(self._bundle_inputs[:1], (rows,)) or self._bundle_inputs[1:] != (hidden,):
            self._bundle_inputs = rows, hidden
            self._bundle = self._builder.make(rows, hidden)
        graph = frame.graph
        inputs = self._bundle, graph.animation, graph.nodes, graph.controls, frame.context.session.root.settings
        view_inputs = frame.plane, frame.scale
        if not _is_same(self._visible_inputs[:5], inputs) or self._visible_inputs[5:] != view_inputs:
            self._visible_inputs = *inputs, *view_inputs
            self._project(frame, rows)
        spots = frame.state.spots
        visible = self._visible
        if not _is_same(self._chosen_inputs, (self._bundle, spots)):
            self._chosen_inputs = self._bundle, spots
            self._chosen = [not spots.isdisjoint(key_spots) for key_spots in self._bundle.spots] if spots else []
        frame.list_marks, frame.count, frame.find_lane = visible.list_marks, len(visible.key_indices), visible.find_lane
        frame.find_mark = lambda x, y, reach: visible.find_mark(x, y, reach, spots)

    def _project(self, frame: CurvesFrame, rows: tuple[CurveRow, ...]) -> None:
        """Project curves and keys to the screen."""
        bundle = self._bundle
        visible = self._visible = bundle.project(frame.plane)
        lane_indices, ends, bent, cuts = bundle.project_outside(frame.plane)
        self._paths = [
            CurvePaths(ends, bent.tolist(), cuts, [(bundle.lanes[lane_index], True) for lane_index in lane_indices]),
            CurvePaths(visible.screen, visible.bent.tolist(), visible.cuts, [(lane, False) for lane in bundle.lanes]),
        ]
        looks = [bundle.looks[key] for key in visible.key_indices.tolist()]
        self._keys = visible.xs.tolist(), visible.ys.tolist(), looks, bundle.key_of[visible.key_indices].tolist()
        self._dashes = [
            dash
            for row in rows
            if row.port and row.keys is None
            for channel in range(len(row.channels) or 1)
            if (row.port, channel) not in frame.state.hidden
            for dash in self._make_dashes(frame, row.port, channel)
        ]

    def _make_dashes(self, frame: CurvesFrame, port: Port, channel: int) -> list[tuple[Lane, ScreenPoints]]:
        plane, view, scale = frame.plane, frame.plane.view, frame.scale
        lane_dashes: list[tuple[Lane, ScreenPoints]] = []
        lane = port, channel
        settings = frame.context.session.root.settings
        for line in self.samples.sample_lines(frame.graph, settings, port, channel, view.first, view.last):
            line[:, 0] = plane.rect[0] + (line[:, 0] - view.first) * plane.across
            line[:, 1] = (plane.rect[3] - (line[:, 1] - view.low) * plane.up).clip(-1e6, 1e6)
            for dash in cut_dashes(line, 6.0 * scale, 4.0 * scale):
                lane_dashes.append((lane, list(map(ImVec2, *dash.T.tolist()))))
        return lane_dashes

    # --- painting ----------------------------------------------------------------------------------------------------

    def paint(self, frame: CurvesFrame, rows: tuple[CurveRow, ...], hot: Mark | Tip | None, lit: Lane | None) -> None:
        """Draw the grid of values, the curves, and on top of them keys and handles.

        Keys that are selected are drawn last. With very many keys all have one shape, which draws them much faster:
        shapes could not be told apart then.
        """
        draw, scale = imgui.get_window_draw_list(), frame.scale
        inks = self._choose_inks(frame, rows)
        for ways in self._paths:
            ways.draw(draw, inks, lit, scale)
        for lane, dash in self._dashes:
            draw.add_polyline(dash, inks[lane][0], 1.6 * scale, 0)
        self._paint_tips(frame)
        palette, size = frame.context.palette, KEY * scale * 0.85
        colors = [inks[lane][0] for lane in self._bundle.lanes]
        chosen = [self._chosen[key] for key in self._visible.key_indices.tolist()] if self._chosen else None
        if chosen is None and len(colors) and len(self._keys[0]) > MAX_DISTINCT_KEYS:
            mark = draw.add_ngon_filled
            for x, y, _, of in zip(*self._keys, strict=True):
                mark((x, y), size, colors[of], 4)
        elif chosen is None:
            for x, y, look, of in zip(*self._keys, strict=True):
                paint_key(draw, x, y, size, look, colors[of])
        else:
            for x, y, look, of in compress(zip(*self._keys, strict=True), map(not_, chosen)):
                paint_key(draw, x, y, size, look, colors[of])
            ring, ink = u32(palette.canvas), u32(palette.accent)
            for x, y, look, _ in compress(zip(*self._keys, strict=True), chosen):
                draw.add_circle_filled((x, y), size * 1.75, ring, 16)
                paint_key(draw, x, y, size * 1.2, look, ink)
        if hot:
            draw.add_circle((hot.x, hot.y), size * 1.9, u32(palette.accent, 0.9), 20, 1.5 * scale)

    def _choose_inks(self, frame: CurvesFrame, rows: tuple[CurveRow, ...]) -> dict[Lane, tuple[int, int]]:
        """The colors of curves inside and outside of their keys."""
        inputs = frame.rows, rows, frame.context.palette
        if not _is_same(self._ink_inputs, inputs):
            self._ink_inputs, self._inks = inputs, {}
            visible_ports = {row.port for row in rows}
            for place, row in enumerate(row for row in frame.rows if row.port):
                for channel in range(len(row.channels) or 1):
                    if row.port and row.port in visible_ports:
                        color = color_of(frame.context, row, channel, place)
                        self._inks[row.port, channel] = u32(color), u32(color, 0.32)
        return self._inks

    def paint_grid(self, frame: CurvesFrame) -> None:
        """Lines of values."""
        draw, palette, plane = imgui.get_window_draw_list(), frame.context.palette, frame.plane
        left, _, right, _ = plane.rect
        strong, faint = u32(mix(palette.grid, palette.dim, 0.22)), u32(mix(palette.canvas, palette.grid, 0.9))
        zero = u32(mix(palette.grid, palette.dim, 0.55))
        for tick in ticks(plane.view.low, plane.view.high, plane.up, 36.0 * frame.scale):
            y = round(plane.y(tick.at)) + 0.5
            draw.add_line((left, y), (right, y), zero if abs(tick.at) < 1e-12 else strong if tick.label else faint)

    def paint_labels(self, frame: CurvesFrame) -> None:
        """The numbers of the lines of values, over the curves."""
        draw, palette, plane, scale = imgui.get_window_draw_list(), frame.context.palette, frame.plane, frame.scale
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
            draw_small_text(frame, left + 6.0 * scale, y, tick.label, palette.dim)

    def _paint_tips(self, frame: CurvesFrame) -> None:
        draw, palette, scale = imgui.get_window_draw_list(), frame.context.palette, frame.scale
        line, fill = u32(palette.text, 0.55), u32(palette.text)
        for tip in frame.tips:
            draw.add_line(tip.root, (tip.x, tip.y), line, 1.25 * scale)
            draw.add_circle_filled((tip.x, tip.y), 3.5 * scale, fill, 12)
            draw.add_circle_filled((tip.x, tip.y), 1.9 * scale, u32(palette.canvas), 10)


def _is_same(before: tuple[object, ...], after: tuple[object, ...]) -> bool:
    return len(before) == len(after) and all(a is b for a, b in zip(before, after, strict=True))
