"""The dialog with all shortcuts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui

from ...language.translation import translate
from ..shared.action import ListedAction
from ..shared.shortcut_groups import MOUSE, balance_columns, condense_rows, group_actions
from ..theme.style import u32, ui_scale, vec4
from ..toolkit.buttons import close_button
from ..toolkit.dialogs import backdrop, dialog, escape_pressed
from ..toolkit.keys import display_shortcut
from ..toolkit.labels import translate_label
from ..toolkit.words import draw_dim, font

if TYPE_CHECKING:
    from .context import DialogContext

Blocks = Sequence[tuple[str, tuple[tuple[str, str], ...]]]
"""Blocks of the sheet: a title, and rows of keys and what they do."""

_WIDTH = 1340.0


class CheatSheet:
    """All shortcuts in columns, grouped by menu. They are changed in Preferences."""

    def __init__(self, context: DialogContext) -> None:
        self._context = context

    def draw(self) -> None:
        """Draw the dialog, if it is open."""
        if "shortcuts" not in self._context.dialogs.open:
            return
        close = backdrop(self._context, "shortcuts")
        with dialog(self._context, "Shortcuts", (_WIDTH, 0)):
            with font(self._context, "bold", 20.0):
                imgui.text_unformatted(translate("Shortcuts"))
            blocks = [
                *(
                    (translate(title, "menu"), _list_lines(self._context, actions))
                    for title, actions in group_actions(self._context.actions)
                ),
                (translate("Mouse"), _translate_rows(MOUSE)),
            ]
            room = imgui.get_content_region_avail().x
            count = max(int(room / (310 * ui_scale())), 1)
            columns = balance_columns(tuple(len(lines) + 2 for _, lines in blocks), count)
            _draw_columns(self._context, blocks, columns)
            if imgui.button(translate_label("Change shortcuts")):
                self._context.dialogs.open.add("preferences")
                close = True
            imgui.same_line()
            close = close_button(self._context, "close shortcuts") or close or escape_pressed()
            close = close or (imgui.is_key_pressed(imgui.Key.f1, False) and not imgui.is_window_appearing())
        if close:
            self._context.dialogs.open.discard("shortcuts")


def _draw_columns(context: DialogContext, blocks: Blocks, columns: Sequence[Sequence[int]]) -> None:
    """The columns; they scroll where they are longer than the window."""
    line = imgui.get_text_line_height_with_spacing()
    longest = max(sum(len(blocks[index][1]) + 2 for index in indices) for indices in columns) * line
    height = min(longest, imgui.get_main_viewport().size.y - 130 * ui_scale())
    flags = int(imgui.TableFlags_.sizing_stretch_same)
    if imgui.begin_child("columns", ImVec2(0, height)) and imgui.begin_table("sheet", len(columns), flags):
        for indices in columns:
            imgui.table_next_column()
            for index in indices:
                _draw_block(context, *blocks[index])
        imgui.end_table()
    imgui.end_child()


def _list_lines(context: DialogContext, actions: tuple[ListedAction, ...]) -> tuple[tuple[str, str], ...]:
    lines = (
        (display_shortcut(context.actions.shortcut(action.id)), translate(action.label).removesuffix("..."))
        for action in actions
    )
    return condense_rows(lines)


def _translate_rows(lines: Iterable[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    return tuple((translate(keys), translate(does)) for keys, does in lines)


def _draw_block(context: DialogContext, title: str, lines: tuple[tuple[str, str], ...]) -> None:
    scale = ui_scale()
    imgui.dummy(ImVec2(0, 4 * scale))
    imgui.text_colored(vec4(context.palette.accent), title)
    start = imgui.get_cursor_screen_pos()
    right = start.x + imgui.get_content_region_avail().x - 12 * scale
    imgui.get_window_draw_list().add_line(start, ImVec2(right, start.y), u32(context.palette.raised), scale)
    imgui.dummy(ImVec2(0, scale))
    left = imgui.get_cursor_pos_x()
    for keys, label in lines:
        imgui.text_unformatted(label)
        imgui.same_line()
        imgui.set_cursor_pos_x(left + (right - start.x) - imgui.calc_text_size(keys).x)
        draw_dim(context, keys)
