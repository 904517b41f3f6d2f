"""The Animation panel: tools, names of rows, ruler, and below it keys or curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...graph import Keys
from ...language.translation import translate, translate_plural
from ..theme.style import u32, ui_scale
from ..toolkit.buttons import dropdown
from ..toolkit.plane import Plane, View
from ..toolkit.words import draw_empty_panel
from . import commands
from .frame import BAR, LIST, ROW, RULER, TOOLBAR, CurvesFrame, draw_small_text
from .gestures import KeyBox, KeyScale, Seek
from .hits import EntryCache, Mark, find_nearest, find_sheet_marks, find_tips
from .key_fields import KeyFields
from .mouse import CurvesMouse, find_hot
from .names import NameColumn, draw_value_menu
from .paint import paint_background, paint_bar, paint_box, paint_current_frame, paint_ruler
from .plot import Plot
from .rows import CurveRow
from .sheet import SheetPainter
from .toolbar import draw_animatable, draw_keys_menu, draw_toolbar

if TYPE_CHECKING:
    from .context import CurvesContext

_ANY_TIME = int(imgui.HoveredFlags_.allow_when_blocked_by_active_item)
_BUTTONS = (
    int(imgui.ButtonFlags_.mouse_button_left)
    | int(imgui.ButtonFlags_.mouse_button_right)
    | int(imgui.ButtonFlags_.mouse_button_middle)
)


class AnimationPanel:
    """A dope sheet and a curve editor over one time line."""

    def __init__(self, context: CurvesContext) -> None:
        self._context = context
        self._mouse = CurvesMouse()
        self._entries = EntryCache()
        self._sheet = SheetPainter()
        self._plot = Plot()
        self._names = NameColumn()
        self._fields = KeyFields()
        self._graph_place: tuple[object, ...] = ()
        self._marks_by_row: list[list[Mark]] = []
        self._fitted_view: View | None = None
        """The view after the last automatic fit."""
        self._fitted_inputs: tuple[object, tuple[int, int]] = None, (0, 0)

    def draw(self) -> None:
        """Draw into the current window."""
        state, session, scale = self._context.curves, self._context.session, ui_scale()
        start, size = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()
        state.hovered = imgui.is_window_hovered(_ANY_TIME | int(imgui.HoveredFlags_.child_windows))
        if min(size.x, size.y) < 16 or self._context.fonts is None:
            return
        state.tidy(session.graph)
        if not session.graph.animation:
            self._draw_empty()
            return
        self._fit_new_graph()
        imgui.set_cursor_screen_pos((start.x + 8 * scale, start.y + 5 * scale))
        draw_toolbar(self._context, size.x - 16 * scale)
        frame = self._make_frame((start.x, start.y + TOOLBAR * scale, start.x + size.x, start.y + size.y))
        if frame.plane.rect[3] - frame.plane.rect[1] > 8 and frame.plane.rect[2] - frame.plane.rect[0] > 8:
            self._draw(frame)

    def _fit_new_graph(self) -> None:
        """Fit the view when another graph is open."""
        place = self._context.session.path, self._context.session.place
        if place != self._graph_place:
            self._graph_place = place
            self._context.curves.fit()

    # --- where things are --------------------------------------------------------------------------------------------

    def _make_frame(self, area: tuple[float, float, float, float]) -> CurvesFrame:
        state, session, scale = self._context.curves, self._context.session, ui_scale()
        left, top, right, bottom = map(round, area)
        rows = state.list_rows(session.graph, session.selection)
        middle = left + round(min(LIST * scale, (right - left) * 0.4))
        ruler, bar = top + round(RULER * scale), top + round((RULER + BAR) * scale)
        if self._has_keys_outside_view() and self._mouse.gesture is None:
            state.fit()
        if state.pending_fit and bottom > bar:
            state.view = commands.fit_view(self._context, self._plot.samples)
            self._fitted_view = state.view if state.pending_fit == "all" else None
            state.pending_fit = ""
        max_scroll = max(len(rows) * round(ROW * scale) - (bottom - bar), 0.0)
        state.scroll = min(max(state.scroll, 0.0), max_scroll)
        mouse = imgui.get_mouse_pos()
        return CurvesFrame(
            self._context,
            rows,
            Plane(state.view, (middle, bar, right, bottom)),
            (left, bar, middle, bottom),
            (middle, top, right, ruler),
            (middle, ruler, right, bar),
            scale,
            (mouse.x, mouse.y),
        )

    def _has_keys_outside_view(self) -> bool:
        """True if there are new keys outside of a view that shows everything and that the user has not moved."""
        state, session = self._context.curves, self._context.session
        inputs = session.graph.animation, session.time.frames
        if state.view != self._fitted_view or (
            self._fitted_inputs[0] is inputs[0] and self._fitted_inputs[1] == inputs[1]
        ):
            return False
        self._fitted_inputs = inputs
        frames_by_value = [keys.frames for keys in inputs[0].values() if isinstance(keys, Keys) and keys.keys]
        ranges = [inputs[1], *((frames[0], frames[-1]) for frames in frames_by_value)]
        return any(first < state.view.first or last > state.view.last for first, last in ranges)

    # --- drawing -----------------------------------------------------------------------------------------------------

    def _draw(self, frame: CurvesFrame) -> None:
        """Handle the mouse, then draw. The mouse may move the view or the keys: then everything is placed again before
        it is drawn, or the picture would be one frame behind the hand.
        """
        context, state, rect = frame.context, frame.state, frame.plane.rect
        left, top, right, bottom = frame.ruler[0], frame.ruler[1], rect[2], rect[3]
        imgui.set_cursor_screen_pos((left, top))
        imgui.push_item_flag(int(imgui.ItemFlags_.no_nav), True)
        imgui.invisible_button("##keys", (right - left, bottom - top), _BUTTONS)
        imgui.pop_item_flag()
        frame.hovered = imgui.is_item_hovered()
        context.places["keys area"], context.places["keys ruler"] = rect, frame.ruler
        curve_rows = state.list_curve_rows(frame.rows)
        self._find_marks(frame, curve_rows)
        self._mouse.update(frame)
        if frame.plane.view != state.view or self._mouse.gesture:
            frame = self._make_frame((frame.list[0], frame.ruler[1], right, bottom))
            curve_rows = state.list_curve_rows(frame.rows)
            self._find_marks(frame, curve_rows)
        draw = imgui.get_window_draw_list()
        hot = find_hot(self._mouse)
        draw.push_clip_rect(rect[:2], rect[2:], True)
        paint_background(frame)
        if frame.is_sheet:
            self._sheet.paint(frame, self._marks_by_row, self._mouse.mark)
        else:
            self._plot.paint_grid(frame)
            self._plot.paint(frame, curve_rows, hot, self._mouse.lane)
            self._plot.paint_labels(frame)
        if isinstance(self._mouse.gesture, KeyBox):
            paint_box(frame, (*frame.to_screen(self._mouse.gesture.start), *frame.pointer))
        draw.pop_clip_rect()
        paint_ruler(frame)
        paint_bar(frame, "bar" if isinstance(self._mouse.gesture, KeyScale) else self._mouse.part)
        paint_current_frame(frame, isinstance(self._mouse.gesture, Seek) or self._mouse.part == "now")
        draw.add_line((left, rect[1]), (right, rect[1]), u32(context.palette.border))
        self._draw_left_column(frame)
        self._draw_menus(frame)
        self._record_places(frame)

    def _find_marks(self, frame: CurvesFrame, curve_rows: tuple[CurveRow, ...]) -> None:
        """Find the marks of keys and handles on the screen."""
        if frame.is_sheet:
            self._marks_by_row = find_sheet_marks(
                frame.rows, frame.graph.animation, self._entries, frame.plane, frame.top, frame.row_height
            )
            flat = [mark for marks in self._marks_by_row for mark in marks]
            frame.list_marks, frame.count = lambda: flat, len(flat)
            frame.find_mark = lambda x, y, reach: find_nearest(flat, x, y, reach)
            return
        self._plot.update(frame, curve_rows)
        ports = {row.port for row in curve_rows}
        spots = [spot for spot in frame.state.spots if spot[0] in ports]
        frame.tips = find_tips(frame.graph.animation, spots, frame.state.hidden, frame.plane)

    def _draw_left_column(self, frame: CurvesFrame) -> None:
        """The row names, and the fields of the selected key."""
        draw, palette = imgui.get_window_draw_list(), frame.context.palette
        left, _, right, bottom = frame.list
        draw.add_rect_filled((left, frame.ruler[1]), (right, bottom), u32(palette.panel))
        draw.add_line((right - 0.5, frame.ruler[1]), (right - 0.5, bottom), u32(palette.border))
        middle = (frame.ruler[1] + frame.plane.rect[1]) * 0.5
        draw_small_text(frame, left + 10.0 * frame.scale, middle, _describe_count(frame), palette.dim)
        high = self._fields.measure_height(frame)
        end = bottom - high
        if self._names.draw(frame, self._entries, end):
            imgui.open_popup("value of keys")
        if high:
            draw.add_line((left, end), (right, end), u32(palette.border))
        self._fields.draw(frame, end)

    def _draw_menus(self, frame: CurvesFrame) -> None:
        if self._mouse.menu:
            imgui.open_popup("menu of keys")
        if imgui.begin_popup("menu of keys"):
            draw_keys_menu(frame.context)
            imgui.end_popup()
        if imgui.begin_popup("value of keys"):
            if self._names.menu_for:
                draw_value_menu(frame.context, self._names.menu_for)
            imgui.end_popup()

    def _record_places(self, frame: CurvesFrame) -> None:
        """Record where keys and handles are."""
        places, size = frame.context.places, 4.0 * frame.scale
        for mark in frame.list_marks() if frame.count <= 200 else ():
            if frame.is_sheet and len({spot[0] for spot in mark.spots}) > 1:
                continue
            port, at, channel = min(mark.spots, key=lambda spot: spot[2])
            name = f"key {port} {at:g}" if frame.is_sheet else f"key {port} {at:g} {channel}"
            places[name] = (mark.x - size, mark.y - size, mark.x + size, mark.y + size)
        for tip in frame.tips:
            places[f"handle {tip.port} {tip.frame:g} {tip.channel} {tip.side}"] = (
                tip.x - size,
                tip.y - size,
                tip.x + size,
                tip.y + size,
            )

    def _draw_empty(self) -> None:
        draw_empty_panel(
            self._context,
            icons.ICON_FA_BEZIER_CURVE,
            translate("No value is animated yet"),
            translate(
                "A value that has keys changes over time. Click the diamond beside a value in the "
                "Inspector, go to another frame and change the value: the second key is set "
                "automatically."
            ),
        )
        label = f"{icons.ICON_FA_PLUS}  {translate('Animate a value')}"
        width = imgui.calc_text_size(label).x + 2 * imgui.get_style().frame_padding.x
        imgui.set_cursor_pos_x(max((imgui.get_window_width() - width) * 0.5, 0.0))
        dropdown(
            self._context,
            label,
            "button keys add",
            translate("Values of the selected nodes"),
            lambda: draw_animatable(self._context),
            lit=True,
        )


def _describe_count(frame: CurvesFrame) -> str:
    """The number of values, or of selected keys."""
    if frame.state.spots:
        count = len({(port, at) for port, at, _ in frame.state.spots})
        return translate_plural("{count} key selected", "{count} keys selected", count)
    values = sum(row.port is not None for row in frame.rows)
    if not values:
        return translate("Hidden: collapsed, or of nodes that are not selected")
    return translate_plural("{count} value", "{count} values", values)
