"""The Animation panel: tools, names of rows, ruler, and below it keys or curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...graph import Keys
from ..theme.style import u32, ui_scale
from ..toolkit.buttons import dropdown
from ..toolkit.plane import Plane, View
from ..toolkit.words import draw_empty_panel
from . import commands
from .frame import BAR, LIST, ROW, RULER, TOOLBAR, CurvesFrame, small
from .gestures import KeyBox, Scale, Seek
from .hits import Entries, Mark, nearest, sheet_marks, tips
from .key_fields import KeyFields
from .mouse import CurvesMouse, hot_of
from .names import Names, value_menu
from .paint import paint_bar, paint_box, paint_now, paint_ruler, paint_time
from .plot import Plot
from .rows import CurveRow
from .sheet import SheetPainter
from .toolbar import draw_toolbar, keys_menu, offered

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

    title = "Animation"

    def __init__(self, context: CurvesContext) -> None:
        self._context = context
        self._mouse = CurvesMouse()
        self._entries = Entries()
        self._sheet = SheetPainter()
        self._plot = Plot()
        self._names = Names()
        self._fields = KeyFields()
        self._place: tuple[object, ...] = ()
        self._grouped: list[list[Mark]] = []
        self._untouched: View | None = None
        """The view that showed everything."""
        self._of: tuple[object, tuple[int, int]] = None, (0, 0)

    def draw(self) -> None:
        """Draw into the current window."""
        state, session, scale = self._context.curves, self._context.session, ui_scale()
        start, size = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()
        state.hovered = imgui.is_window_hovered(_ANY_TIME | int(imgui.HoveredFlags_.child_windows))
        if min(size.x, size.y) < 16 or self._context.fonts is None:
            return
        state.tidy(session.graph)
        if not session.graph.animation:
            self._nothing()
            return
        self._enter()
        imgui.set_cursor_screen_pos((start.x + 8 * scale, start.y + 5 * scale))
        draw_toolbar(self._context, size.x - 16 * scale)
        frame = self._frame((start.x, start.y + TOOLBAR * scale, start.x + size.x, start.y + size.y))
        if frame.plane.rect[3] - frame.plane.rect[1] > 8 and frame.plane.rect[2] - frame.plane.rect[0] > 8:
            self._draw(frame)

    def _enter(self) -> None:
        """Another graph is shown whole."""
        place = self._context.session.path, self._context.session.place
        if place != self._place:
            self._place = place
            self._context.curves.fit()

    # --- where things are --------------------------------------------------------------------------------------------

    def _frame(self, area: tuple[float, float, float, float]) -> CurvesFrame:
        state, session, scale = self._context.curves, self._context.session, ui_scale()
        left, top, right, bottom = map(round, area)
        rows = state.rows(session.graph, session.selection)
        middle = left + round(min(LIST * scale, (right - left) * 0.4))
        ruler, bar = top + round(RULER * scale), top + round((RULER + BAR) * scale)
        if self._grown() and self._mouse.gesture is None:
            state.fit()
        if state.wanted and bottom > bar:
            state.view = commands.fitted(self._context, self._plot.samples)
            self._untouched = state.view if state.wanted == "all" else None
            state.wanted = ""
        room = max(len(rows) * round(ROW * scale) - (bottom - bar), 0.0)
        state.scroll = min(max(state.scroll, 0.0), room)
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

    def _grown(self) -> bool:
        """True if there are new keys outside of a view that shows everything and that the user has not moved."""
        state, session = self._context.curves, self._context.session
        of = session.graph.animation, session.frames
        if state.view != self._untouched or (self._of[0] is of[0] and self._of[1] == of[1]):
            return False
        self._of = of
        every = [keys.frames for keys in of[0].values() if isinstance(keys, Keys) and keys.keys]
        ends = [of[1], *((frames[0], frames[-1]) for frames in every)]
        return any(first < state.view.first or last > state.view.last for first, last in ends)

    # --- drawing -----------------------------------------------------------------------------------------------------

    def _draw(self, frame: CurvesFrame) -> None:
        context, state, rect = frame.context, frame.state, frame.plane.rect
        left, top, right, bottom = frame.ruler[0], frame.ruler[1], rect[2], rect[3]
        imgui.set_cursor_screen_pos((left, top))
        imgui.push_item_flag(int(imgui.ItemFlags_.no_nav), True)
        imgui.invisible_button("##keys", (right - left, bottom - top), _BUTTONS)
        imgui.pop_item_flag()
        frame.over = imgui.is_item_hovered()
        context.places["keys area"], context.places["keys ruler"] = rect, frame.ruler
        shown = state.curves(frame.rows)
        self._see(frame, shown)
        self._mouse.update(frame)
        if frame.plane.view != state.view or self._mouse.gesture:
            frame = self._frame((frame.list[0], frame.ruler[1], right, bottom))
            shown = state.curves(frame.rows)
            self._see(frame, shown)
        draw = imgui.get_window_draw_list()
        hot = hot_of(self._mouse)
        draw.push_clip_rect(rect[:2], rect[2:], True)
        paint_time(frame)
        if frame.sheet:
            self._sheet.paint(frame, self._grouped, self._mouse.mark)
        else:
            self._plot.grid(frame)
            self._plot.paint(frame, shown, hot, self._mouse.lane)
            self._plot.labels(frame)
        if isinstance(self._mouse.gesture, KeyBox):
            paint_box(frame, (*frame.back(self._mouse.gesture.start), *frame.at))
        draw.pop_clip_rect()
        paint_ruler(frame)
        paint_bar(frame, "bar" if isinstance(self._mouse.gesture, Scale) else self._mouse.part)
        paint_now(frame, isinstance(self._mouse.gesture, Seek) or self._mouse.part == "now")
        draw.add_line((left, rect[1]), (right, rect[1]), u32(context.palette.border))
        self._left(frame)
        self._menus(frame)
        self._record(frame)

    def _see(self, frame: CurvesFrame, shown: tuple[CurveRow, ...]) -> None:
        """Find what is where."""
        if frame.sheet:
            self._grouped = sheet_marks(
                frame.rows, frame.graph.animation, self._entries, frame.plane, frame.top, frame.high
            )
            flat = [mark for marks in self._grouped for mark in marks]
            frame.marks, frame.count = lambda: flat, len(flat)
            frame.near = lambda x, y, reach: nearest(flat, x, y, reach)
            return
        self._plot.see(frame, shown)
        ports = {row.port for row in shown}
        spots = [spot for spot in frame.state.spots if spot[0] in ports]
        frame.tips = tips(frame.graph.animation, spots, frame.state.hidden, frame.plane)

    def _left(self, frame: CurvesFrame) -> None:
        """The names, and the numbers of the key that is chosen."""
        draw, palette = imgui.get_window_draw_list(), frame.context.palette
        left, _, right, bottom = frame.list
        draw.add_rect_filled((left, frame.ruler[1]), (right, bottom), u32(palette.panel))
        draw.add_line((right - 0.5, frame.ruler[1]), (right - 0.5, bottom), u32(palette.border))
        middle = (frame.ruler[1] + frame.plane.rect[1]) * 0.5
        small(frame, left + 10.0 * frame.scale, middle, _count(frame), palette.dim)
        high = self._fields.height(frame)
        end = bottom - high
        if self._names.draw(frame, self._entries, end):
            imgui.open_popup("value of keys")
        if high:
            draw.add_line((left, end), (right, end), u32(palette.border))
        self._fields.draw(frame, end)

    def _menus(self, frame: CurvesFrame) -> None:
        if self._mouse.menu:
            imgui.open_popup("menu of keys")
        if imgui.begin_popup("menu of keys"):
            keys_menu(frame.context)
            imgui.end_popup()
        if imgui.begin_popup("value of keys"):
            if self._names.menu_for:
                value_menu(frame.context, self._names.menu_for)
            imgui.end_popup()

    def _record(self, frame: CurvesFrame) -> None:
        """Where keys and handles are."""
        places, size = frame.context.places, 4.0 * frame.scale
        for mark in frame.marks() if frame.count <= 200 else ():
            if frame.sheet and len({spot[0] for spot in mark.spots}) > 1:
                continue
            port, at, channel = min(mark.spots, key=lambda spot: spot[2])
            name = f"key {port} {at:g}" if frame.sheet else f"key {port} {at:g} {channel}"
            places[name] = (mark.x - size, mark.y - size, mark.x + size, mark.y + size)
        for tip in frame.tips:
            places[f"handle {tip.port} {tip.frame:g} {tip.channel} {tip.side}"] = (
                tip.x - size,
                tip.y - size,
                tip.x + size,
                tip.y + size,
            )

    def _nothing(self) -> None:
        draw_empty_panel(
            self._context,
            icons.ICON_FA_BEZIER_CURVE,
            "Nothing moves yet",
            "A value that has keys changes over time. Click the diamond beside a value in the Inspector, go to another "
            "frame and change the value: the second key makes itself.",
        )
        label = f"{icons.ICON_FA_PLUS}  Key a value"
        width = imgui.calc_text_size(label).x + 2 * imgui.get_style().frame_padding.x
        imgui.set_cursor_pos_x(max((imgui.get_window_width() - width) * 0.5, 0.0))
        dropdown(
            self._context,
            label,
            "button keys add",
            "Values of the selected nodes",
            lambda: offered(self._context),
            lit=True,
        )


def _count(frame: CurvesFrame) -> str:
    """How much there is, or is chosen."""
    if frame.state.spots:
        return f"{commands.spoken(frame.state.spots).replace('a key', '1 key')} selected"
    values = sum(row.port is not None for row in frame.rows)
    return "1 value" if values == 1 else f"{values} values" if values else "Folded, or of nodes not selected"
