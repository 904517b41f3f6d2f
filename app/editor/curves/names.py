"""The names of rows at the left: fold, choose, key, hide a channel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from halation.nodes import Plain
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import AnimateValue, BakeKeys, ToggleKey
from ...errors import HalationError
from ...graph import Keys, Port
from ..theme.style import mix, u32
from ..toolkit.words import cut_end
from .frame import CurvesFrame, color_of, small
from .hits import Entries
from .paint import paint_key
from .rows import CurveRow
from .shapes import number

if TYPE_CHECKING:
    from .context import CurvesContext

_BUTTONS = int(imgui.ButtonFlags_.mouse_button_left) | int(imgui.ButtonFlags_.mouse_button_right)
_KEY, _LETTER = 20.0, 15.0
"""Widths at UI scale 1: of the diamond at the right, and of the letter of a channel."""


class Names:
    """The column of names."""

    def __init__(self) -> None:
        self.menu_for: Port | None = None
        self._values: dict[Port, Plain | None] = {}
        self._of: tuple[object, ...] = ()

    def draw(self, frame: CurvesFrame, entries: Entries, bottom: float) -> bool:
        """Draw them down to `bottom`; True if the menu of a value is asked for."""
        draw, palette = imgui.get_window_draw_list(), frame.context.palette
        left, top, right, _ = frame.list
        imgui.set_cursor_screen_pos((left, top))
        pressed = imgui.invisible_button("##names", (max(right - left, 1.0), max(bottom - top, 1.0)), _BUTTONS)
        over = imgui.is_item_hovered()
        if over and imgui.get_io().mouse_wheel:
            frame.state.scroll -= imgui.get_io().mouse_wheel * frame.high * 2.0
        row = frame.row_at(frame.at[1]) if over and frame.at[1] < bottom else None
        asked = False
        if row and imgui.is_mouse_clicked(imgui.MouseButton_.right):
            self.menu_for, asked = row.port, row.port is not None
        elif row and pressed and not imgui.is_mouse_released(imgui.MouseButton_.right):
            self._click(frame, row, entries)
        draw.push_clip_rect((left, top), (right, bottom), True)
        for place, one in enumerate(frame.rows):
            y = frame.top + place * frame.high
            if y < bottom and y + frame.high > top:
                self._row(frame, one, y, place, one is row)
        draw.pop_clip_rect()
        draw.add_line((right - 0.5, top), (right - 0.5, frame.list[3]), u32(palette.border))
        return asked

    # --- the mouse ---------------------------------------------------------------------------------------------------

    def _click(self, frame: CurvesFrame, row: CurveRow, entries: Entries) -> None:
        state, context, scale = frame.state, frame.context, frame.scale
        left, _, right, _ = frame.list
        x = frame.at[0]
        io = imgui.get_io()
        if row.port is None:
            if x < left + 22.0 * scale or imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
                state.folded ^= {row.node}
            else:
                state.shown = state.shown ^ frozenset(row.ports) if io.key_ctrl else frozenset(row.ports)
            return
        port = row.port
        if x > right - _KEY * scale and not self._expressed(row):
            context.log.attempt(lambda: context.session.apply(ToggleKey(port)))
            return
        letter = self._letter_at(frame, row, x)
        if letter is not None:
            state.hidden ^= {(port, letter)}
        elif io.key_shift and state.anchor:
            ports = [one.port for one in frame.rows if one.port]
            if state.anchor in ports:
                a, b = sorted((ports.index(state.anchor), ports.index(port)))
                state.shown = frozenset(ports[a : b + 1])
        elif io.key_ctrl:
            state.shown, state.anchor = state.shown ^ {port}, port
        else:
            state.shown, state.anchor = (frozenset() if state.shown == {port} else frozenset({port})), port

    def _letter_at(self, frame: CurvesFrame, row: CurveRow, x: float) -> int | None:
        if frame.sheet or not 1 < len(row.channels) <= 4:
            return None
        place = int((x - self._letters(frame, row)) // (_LETTER * frame.scale))
        return place if 0 <= place < len(row.channels) else None

    def _letters(self, frame: CurvesFrame, row: CurveRow) -> float:
        return frame.list[2] - (_KEY + _LETTER * len(row.channels) + 4.0) * frame.scale

    # --- painting ----------------------------------------------------------------------------------------------------

    def _row(self, frame: CurvesFrame, row: CurveRow, y: float, place: int, hot: bool) -> None:
        draw, palette, scale = imgui.get_window_draw_list(), frame.context.palette, frame.scale
        left, _, right, _ = frame.list
        middle = y + frame.high * 0.5
        chosen = row.port in frame.state.shown
        if hot or chosen or row.port is None:
            color = u32(palette.accent, 0.16) if chosen else u32(palette.text, 0.07 if hot else 0.035)
            draw.add_rect_filled((left, y), (right, y + frame.high), color)
        name = f"keys row {row.port or row.node}"
        frame.context.places[name] = (left, y, right, y + frame.high)
        if row.port is None:
            icon = icons.ICON_FA_CARET_RIGHT if row.node in frame.state.folded else icons.ICON_FA_CARET_DOWN
            small(frame, left + 10.0 * scale, middle, icon, palette.dim)
            self._label(frame, left + 24.0 * scale, right - 6.0 * scale, middle, row.label, bold=True)
            return
        dot = color_of(frame.context, row, 0, self._order(frame, place))
        end = right - (_KEY + 6.0) * scale
        if not frame.sheet:
            if 1 < len(row.channels) <= 4:
                end = self._channels(frame, row, middle)
            else:
                draw.add_circle_filled((left + 18.0 * scale, middle), 3.0 * scale, u32(dot), 12)
        end -= self._value(frame, row, end, middle) if frame.sheet or not row.channels else 0.0
        self._label(frame, left + 28.0 * scale, end - 6.0 * scale, middle, row.label)
        self._diamond(frame, row, middle, hot)

    def _label(self, frame: CurvesFrame, left: float, right: float, y: float, text: str, bold: bool = False) -> None:
        fonts, palette = frame.context.fonts, frame.context.palette
        size = 14.0 * frame.scale
        imgui.push_font(fonts.bold if bold and fonts else None, size / imgui.get_style().font_scale_main)
        text = cut_end(text, max(right - left, 0.0))
        height = imgui.get_font_size()
        color = palette.text if bold else mix(palette.text, palette.dim, 0.3)
        imgui.get_window_draw_list().add_text((round(left), round(y - height * 0.52)), u32(color), text)
        imgui.pop_font()

    def _channels(self, frame: CurvesFrame, row: CurveRow, y: float) -> float:
        """The letters of the channels in their colors; a hidden one is grey. Returns where they begin."""
        palette, start, scale = frame.context.palette, self._letters(frame, row), frame.scale
        assert row.port
        for channel, letter in enumerate(row.channels):
            hidden = (row.port, channel) in frame.state.hidden
            color = mix(palette.dim, palette.panel, 0.5) if hidden else color_of(frame.context, row, channel, 0)
            x = start + (channel + 0.5) * _LETTER * scale
            small(frame, x, y, letter, color, align=0.5)
            frame.context.places[f"keys channel {row.port} {letter}"] = (
                x - _LETTER * 0.5 * scale,
                y - 8.0 * scale,
                x + _LETTER * 0.5 * scale,
                y + 8.0 * scale,
            )
        return start

    def _value(self, frame: CurvesFrame, row: CurveRow, right: float, y: float) -> float:
        """What the value is now, right-aligned. Returns its width."""
        assert row.port
        session = frame.context.session
        of = session.graph, session.settings, session.frame
        if of[:2] != self._of[:2] or of[2] != self._of[2]:
            self._values, self._of = {}, of
        if row.port not in self._values:
            try:
                self._values[row.port] = session.value_now(row.port)
            except HalationError:
                self._values[row.port] = None
        value = self._values[row.port]
        if value is None:
            text = "?"
        elif isinstance(value, bool):
            text = "on" if value else "off"
        elif isinstance(value, tuple):
            text = "  ".join(f"{number(value, place):.2f}" for place in range(len(value))) if len(value) < 4 else ""
        else:
            text = f"{value:.5g}" if isinstance(value, int | float) else str(value)
        return small(frame, right, y, text, frame.context.palette.dim, align=1.0) + 4.0 * frame.scale if text else 0.0

    def _diamond(self, frame: CurvesFrame, row: CurveRow, y: float, hot: bool) -> None:
        """Filled where there is a key at the current frame; a click makes or removes it."""
        assert row.port
        draw, palette, scale = imgui.get_window_draw_list(), frame.context.palette, frame.scale
        x = frame.list[2] - (_KEY * 0.5 + 2.0) * scale
        if self._expressed(row):
            small(frame, x, y, "=", palette.good, align=0.5)
            return
        half = 7.0 * scale
        frame.context.places[f"keys diamond {row.port}"] = (x - half, y - half, x + half, y + half)
        lit = hot and frame.at[0] > frame.list[2] - _KEY * scale
        if frame.context.session.key_at(row.port):
            paint_key(draw, x, y, 4.5 * scale, "linear", u32(palette.accent))
        else:
            color = u32(palette.accent if lit else palette.dim, 1.0 if lit else 0.7)
            draw.add_ngon((x, y), 4.8 * scale, color, 4, 1.2 * scale)

    def _expressed(self, row: CurveRow) -> bool:
        return not isinstance(row.animation, Keys)

    def _order(self, frame: CurvesFrame, place: int) -> int:
        return sum(1 for row in frame.rows[:place] if row.port)


def value_menu(context: CurvesContext, port: Port) -> None:
    """The context menu of a value."""
    session = context.session

    def entry(icon: str, label: str, act: object, enabled: bool = True) -> None:
        if imgui.menu_item(f"{icon}  {label}", "", False, enabled)[0]:
            context.log.attempt(act)  # type: ignore[arg-type]

    animation = session.animation(port)
    keyed = isinstance(animation, Keys)
    has = session.key_at(port) is not None
    entry(icons.ICON_FA_KEY, "Remove Key" if has else "Set Key", lambda: session.apply(ToggleKey(port)), keyed)
    entry(icons.ICON_FA_WAVE_SQUARE, "Bake to Keys", lambda: session.apply(BakeKeys(port)), animation is not None)
    entry(icons.ICON_FA_CROSSHAIRS, "Select Node", lambda: session.select([port.node]))
    imgui.separator()
    entry(
        icons.ICON_FA_XMARK,
        "Remove Animation",
        lambda: session.apply(AnimateValue(port, None, f"Remove animation of {port}")),
        animation is not None,
    )
