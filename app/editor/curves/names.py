"""The column of row names: fold nodes, select rows, set keys, hide channels."""

from __future__ import annotations

from typing import TYPE_CHECKING

from halation.nodes import Plain
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import AnimateValue, BakeKeys, ToggleKey
from ...authoring.edits.element_id import ElementId
from ...errors import HalationError
from ...graph import Keys, Port
from ...language.translation import mark, translate
from ..theme.style import mix, u32
from ..toolkit.labels import make_label
from ..toolkit.words import cut_end
from .frame import CurvesFrame, color_of, draw_small_text
from .hits import EntryCache
from .paint import paint_key
from .rows import CurveRow
from .shapes import read_channel

if TYPE_CHECKING:
    from .context import CurvesContext

_BUTTONS = int(imgui.ButtonFlags_.mouse_button_left) | int(imgui.ButtonFlags_.mouse_button_right)
_KEY, _LETTER = 20.0, 15.0
"""Widths at UI scale 1: of the diamond at the right, and of the letter of a channel."""


class NameColumn:
    """The column of names."""

    def __init__(self) -> None:
        self.menu_for: Port | None = None
        self._values: dict[Port, Plain | None] = {}
        self._inputs: tuple[object, ...] = ()

    def draw(self, frame: CurvesFrame, entries: EntryCache, bottom: float) -> bool:
        """Draw the names down to `bottom`; True if the user asks for the menu of a value."""
        draw, palette = imgui.get_window_draw_list(), frame.context.palette
        left, top, right, _ = frame.list
        imgui.set_cursor_screen_pos((left, top))
        pressed = imgui.invisible_button("##names", (max(right - left, 1.0), max(bottom - top, 1.0)), _BUTTONS)
        hovered = imgui.is_item_hovered()
        if hovered and imgui.get_io().mouse_wheel:
            frame.state.scroll -= imgui.get_io().mouse_wheel * frame.row_height * 2.0
        hovered_row = frame.row_at(frame.pointer[1]) if hovered and frame.pointer[1] < bottom else None
        menu_requested = False
        if hovered_row and imgui.is_mouse_clicked(imgui.MouseButton_.right):
            self.menu_for, menu_requested = hovered_row.port, hovered_row.port is not None
        elif hovered_row and pressed and not imgui.is_mouse_released(imgui.MouseButton_.right):
            self._click(frame, hovered_row, entries)
        draw.push_clip_rect((left, top), (right, bottom), True)
        for place, row in enumerate(frame.rows):
            y = frame.top + place * frame.row_height
            if y < bottom and y + frame.row_height > top:
                self._draw_row(frame, row, y, place, row is hovered_row)
        draw.pop_clip_rect()
        draw.add_line((right - 0.5, top), (right - 0.5, frame.list[3]), u32(palette.border))
        return menu_requested

    # --- the mouse ---------------------------------------------------------------------------------------------------

    def _click(self, frame: CurvesFrame, row: CurveRow, entries: EntryCache) -> None:
        state, context, scale = frame.state, frame.context, frame.scale
        left, _, right, _ = frame.list
        x = frame.pointer[0]
        io = imgui.get_io()
        if row.port is None:
            if x < left + 22.0 * scale or imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
                state.folded ^= {row.node}
            else:
                state.chosen_rows = state.chosen_rows ^ frozenset(row.ports) if io.key_ctrl else frozenset(row.ports)
            return
        port = row.port
        if x > right - _KEY * scale and not self._has_expression(row):
            context.log.attempt(lambda: context.session.apply(ToggleKey(port)))
            return
        letter = self._find_letter(frame, row, x)
        if letter is not None:
            state.hidden ^= {(port, letter)}
        elif io.key_shift and state.anchor:
            ports = [row.port for row in frame.rows if row.port]
            if state.anchor in ports:
                a, b = sorted((ports.index(state.anchor), ports.index(port)))
                state.chosen_rows = frozenset(ports[a : b + 1])
        elif io.key_ctrl:
            state.chosen_rows, state.anchor = state.chosen_rows ^ {port}, port
        else:
            state.chosen_rows, state.anchor = (frozenset() if state.chosen_rows == {port} else frozenset({port})), port

    def _find_letter(self, frame: CurvesFrame, row: CurveRow, x: float) -> int | None:
        if frame.is_sheet or not 1 < len(row.channels) <= 4:
            return None
        place = int((x - self._find_letters_start(frame, row)) // (_LETTER * frame.scale))
        return place if 0 <= place < len(row.channels) else None

    def _find_letters_start(self, frame: CurvesFrame, row: CurveRow) -> float:
        return frame.list[2] - (_KEY + _LETTER * len(row.channels) + 4.0) * frame.scale

    # --- painting ----------------------------------------------------------------------------------------------------

    def _draw_row(self, frame: CurvesFrame, row: CurveRow, y: float, place: int, hot: bool) -> None:
        draw, palette, scale = imgui.get_window_draw_list(), frame.context.palette, frame.scale
        left, _, right, _ = frame.list
        middle = y + frame.row_height * 0.5
        chosen = row.port in frame.state.chosen_rows
        if hot or chosen or row.port is None:
            color = u32(palette.accent, 0.16) if chosen else u32(palette.text, 0.07 if hot else 0.035)
            draw.add_rect_filled((left, y), (right, y + frame.row_height), color)
        name = f"keys row {row.port or row.node}"
        frame.context.places[name] = (left, y, right, y + frame.row_height)
        if row.port is None:
            icon = icons.ICON_FA_CARET_RIGHT if row.node in frame.state.folded else icons.ICON_FA_CARET_DOWN
            draw_small_text(frame, left + 10.0 * scale, middle, icon, palette.dim)
            self._draw_label(frame, left + 24.0 * scale, right - 6.0 * scale, middle, row.label, bold=True)
            return
        dot = color_of(frame.context, row, 0, self._count_values_above(frame, place))
        end = right - (_KEY + 6.0) * scale
        if not frame.is_sheet:
            if 1 < len(row.channels) <= 4:
                end = self._draw_channels(frame, row, middle)
            else:
                draw.add_circle_filled((left + 18.0 * scale, middle), 3.0 * scale, u32(dot), 12)
        end -= self._draw_value(frame, row, end, middle) if frame.is_sheet or not row.channels else 0.0
        self._draw_label(frame, left + 28.0 * scale, end - 6.0 * scale, middle, row.label)
        self._draw_diamond(frame, row, middle, hot)

    def _draw_label(
        self, frame: CurvesFrame, left: float, right: float, y: float, text: str, bold: bool = False
    ) -> None:
        fonts, palette = frame.context.fonts, frame.context.palette
        size = 14.0 * frame.scale
        imgui.push_font(fonts.bold if bold and fonts else None, size / imgui.get_style().font_scale_main)
        text = cut_end(text, max(right - left, 0.0))
        height = imgui.get_font_size()
        color = palette.text if bold else mix(palette.text, palette.dim, 0.3)
        imgui.get_window_draw_list().add_text((round(left), round(y - height * 0.52)), u32(color), text)
        imgui.pop_font()

    def _draw_channels(self, frame: CurvesFrame, row: CurveRow, y: float) -> float:
        """The letters of the channels in their colors; a hidden one is gray. Returns where they begin."""
        palette, start, scale = frame.context.palette, self._find_letters_start(frame, row), frame.scale
        assert row.port
        for channel, letter in enumerate(row.channels):
            hidden = (row.port, channel) in frame.state.hidden
            color = mix(palette.dim, palette.panel, 0.5) if hidden else color_of(frame.context, row, channel, 0)
            x = start + (channel + 0.5) * _LETTER * scale
            draw_small_text(frame, x, y, letter, color, align=0.5)
            frame.context.places[f"keys channel {row.port} {letter}"] = (
                x - _LETTER * 0.5 * scale,
                y - 8.0 * scale,
                x + _LETTER * 0.5 * scale,
                y + 8.0 * scale,
            )
        return start

    def _draw_value(self, frame: CurvesFrame, row: CurveRow, right: float, y: float) -> float:
        """Draw the current value, right-aligned. Returns its width."""
        assert row.port
        session = frame.context.session
        inputs = session.graph, session.root.settings, session.time.frame
        if inputs[:2] != self._inputs[:2] or inputs[2] != self._inputs[2]:
            self._values, self._inputs = {}, inputs
        if row.port not in self._values:
            try:
                self._values[row.port] = session.time.evaluate(row.port)
            except HalationError:
                self._values[row.port] = None
        value = self._values[row.port]
        if value is None:
            text = "?"
        elif isinstance(value, bool):
            text = "on" if value else "off"
        elif isinstance(value, tuple):
            text = (
                "  ".join(f"{read_channel(value, place):.2f}" for place in range(len(value))) if len(value) < 4 else ""
            )
        else:
            text = f"{value:.5g}" if isinstance(value, int | float) else str(value)
        return (
            draw_small_text(frame, right, y, text, frame.context.palette.dim, align=1.0) + 4.0 * frame.scale
            if text
            else 0.0
        )

    def _draw_diamond(self, frame: CurvesFrame, row: CurveRow, y: float, hot: bool) -> None:
        """Draw a diamond, filled if there is a key at the current frame; a click toggles the key."""
        assert row.port
        draw, palette, scale = imgui.get_window_draw_list(), frame.context.palette, frame.scale
        x = frame.list[2] - (_KEY * 0.5 + 2.0) * scale
        if self._has_expression(row):
            draw_small_text(frame, x, y, "=", palette.good, align=0.5)
            return
        half = 7.0 * scale
        frame.context.places[f"keys diamond {row.port}"] = (x - half, y - half, x + half, y + half)
        lit = hot and frame.pointer[0] > frame.list[2] - _KEY * scale
        if frame.context.session.time.find_key(row.port):
            paint_key(draw, x, y, 4.5 * scale, "linear", u32(palette.accent))
        else:
            color = u32(palette.accent if lit else palette.dim, 1.0 if lit else 0.7)
            draw.add_ngon((x, y), 4.8 * scale, color, 4, 1.2 * scale)

    def _has_expression(self, row: CurveRow) -> bool:
        return not isinstance(row.animation, Keys)

    def _count_values_above(self, frame: CurvesFrame, place: int) -> int:
        return sum(1 for row in frame.rows[:place] if row.port)


def draw_value_menu(context: CurvesContext, port: Port) -> None:
    """The context menu of a value."""
    session = context.session

    def draw_entry(icon: str, label: str, act: object, enabled: bool = True) -> None:
        if imgui.menu_item(make_label(f"{icon}  {translate(label)}", label), "", False, enabled)[0]:
            context.log.attempt(act)  # type: ignore[arg-type]

    animation = session.graph.animation.get(port)
    keyed = isinstance(animation, Keys)
    has_key = session.time.find_key(port) is not None
    draw_entry(
        icons.ICON_FA_KEY,
        mark("Remove Key") if has_key else mark("Set Key"),
        lambda: session.apply(ToggleKey(port)),
        keyed,
    )
    draw_entry(
        icons.ICON_FA_WAVE_SQUARE, mark("Bake to Keys"), lambda: session.apply(BakeKeys(port)), animation is not None
    )
    draw_entry(icons.ICON_FA_CROSSHAIRS, mark("Select Node"), lambda: session.select(ElementId.of_port(port)))
    imgui.separator()
    draw_entry(
        icons.ICON_FA_XMARK,
        mark("Remove Animation"),
        lambda: session.apply(AnimateValue(port, None, translate("Remove animation of {port}", port=port))),
        animation is not None,
    )
