"""The command palette: a search over all commands."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui

from ...language.translation import translate
from ..shared.fuzzy import Match, split_matched
from ..theme.style import ui_scale, vec4
from ..toolkit.dialogs import backdrop, dialog, escape_pressed, takes_enter
from ..toolkit.fields import keep_typing
from ..toolkit.keys import display_shortcut
from ..toolkit.places import record
from ..toolkit.words import cut_end, draw_dim, font, tip
from .commands import Command, list_commands, rank_commands

if TYPE_CHECKING:
    from .context import PaletteContext

_ROWS = 12


class CommandPalette:
    """A search field and a list: arrows choose, Enter runs the command, Escape closes."""

    def __init__(self, context: PaletteContext) -> None:
        self._context = context
        self._query = ""
        self._chosen = 0
        self._offered: tuple[Command, ...] = ()
        self._recent = deque[str](maxlen=12)
        self._open = False

    def draw(self) -> None:
        """Draw the dialog, if it is open."""
        if "palette" not in self._context.dialogs.open:
            self._open = False
            return
        if not self._open:
            self._open, self._query, self._chosen, self._offered = True, "", 0, list_commands(self._context)
        matches = rank_commands(self._query, self._offered, self._recent)
        close = backdrop(self._context, "palette", 0.3)
        chosen: Command | None = None
        with dialog(self._context, "Command palette", (620, 0), top=0.18):
            self._draw_field()
            moved = self._move_by_arrows(len(matches))
            if matches and takes_enter():
                chosen = matches[self._chosen][0]
            chosen = self._draw_list(matches, moved) or chosen
            close = close or escape_pressed()
        if chosen is not None and not chosen.reason:
            self._run(chosen)
        if close or (chosen is not None and not chosen.reason):
            self._context.dialogs.open.discard("palette")

    def _run(self, command: Command) -> None:
        if command.id in self._recent:
            self._recent.remove(command.id)
        self._recent.append(command.id)
        self._context.dialogs.open.discard("palette")
        self._context.log.attempt(command.run)

    def _draw_field(self) -> None:
        keep_typing()
        imgui.set_next_item_width(-1)
        with font(self._context, "text", 18.0):
            hint = translate("Type a command, a node or a preset")
            changed, self._query = imgui.input_text_with_hint("##command", hint, self._query)
        record(self._context, "palette field")
        if changed:
            self._chosen = 0

    def _move_by_arrows(self, count: int) -> bool:
        step = imgui.is_key_pressed(imgui.Key.down_arrow) - imgui.is_key_pressed(imgui.Key.up_arrow)
        step += _ROWS * (imgui.is_key_pressed(imgui.Key.page_down) - imgui.is_key_pressed(imgui.Key.page_up))
        self._chosen = min(max(self._chosen + step, 0), max(count - 1, 0))
        return step != 0

    def _draw_list(self, matches: tuple[tuple[Command, Match], ...], moved: bool) -> Command | None:
        if not matches:
            draw_dim(self._context, translate("No command, node or preset matches."))
            return None
        height = imgui.get_text_line_height() + 8 * ui_scale()
        chosen: Command | None = None
        imgui.begin_child("commands", ImVec2(0, height * min(len(matches), _ROWS)), 0, int(imgui.WindowFlags_.no_nav))
        imgui.push_style_var(imgui.StyleVar_.item_spacing, ImVec2(0, 0))
        clipper = imgui.ListClipper()
        clipper.begin(len(matches), height)
        clipper.include_item_by_index(self._chosen)
        while clipper.step():
            for index in range(clipper.display_start, clipper.display_end):
                command, letters = matches[index]
                if self._draw_row(index, command, letters, height):
                    chosen = command
                if moved and index == self._chosen:
                    imgui.internal.scroll_to_item()
        clipper.end()
        imgui.pop_style_var()
        imgui.end_child()
        doc = matches[self._chosen][0].doc if self._chosen < len(matches) else ""
        draw_dim(self._context, cut_end(doc or " ", imgui.get_content_region_avail().x))
        tip(doc)
        return chosen

    def _draw_row(self, index: int, command: Command, letters: Match, height: float) -> bool:
        palette, scale = self._context.palette, ui_scale()
        start = imgui.get_cursor_pos()
        edge = start.x + imgui.get_content_region_avail().x
        clicked, _ = imgui.selectable(f"##{index}", index == self._chosen, 0, ImVec2(0, height))
        record(self._context, f"command {command.id}")
        if imgui.is_item_hovered() and imgui.get_io().mouse_delta != ImVec2(0, 0):
            self._chosen = index
        after = imgui.get_cursor_pos()
        line = start.y + (height - imgui.get_text_line_height()) / 2
        imgui.set_cursor_pos(ImVec2(start.x + 6 * scale, line))
        color = palette.dim if command.reason else palette.text
        for piece, matched in split_matched(command.label, letters.positions):
            with font(self._context, "bold" if matched else "text"):
                imgui.text_colored(vec4(palette.accent if matched and not command.reason else color), piece)
            imgui.same_line(0, 0)
        right = command.reason or display_shortcut(command.shortcut) or command.kind
        imgui.set_cursor_pos(ImVec2(edge - imgui.calc_text_size(right).x - 6 * scale, line))
        draw_dim(self._context, right)
        imgui.set_cursor_pos(after)
        return clicked
