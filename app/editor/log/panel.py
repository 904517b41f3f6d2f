"""The Log panel."""

from __future__ import annotations

from time import localtime, strftime
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...authoring.log import Level, LogEntry
from ...language.translation import mark, translate
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import align_right, quiet_button
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from ..toolkit.words import ICONS, draw_dim, draw_empty_panel, draw_wrapped, font, level_color

if TYPE_CHECKING:
    from .context import LogContext

_LEVELS: tuple[tuple[Level, str], ...] = (
    ("info", mark("All")),
    ("warning", mark("Warnings")),
    ("error", mark("Errors")),
)
_ORDER: tuple[Level, ...] = ("info", "warning", "error")


class LogPanel:
    """The messages since the editor was opened, with their time, oldest first."""

    def __init__(self, context: LogContext) -> None:
        self._context = context
        self._least: Level = "info"

    def draw(self) -> None:
        """Draw into the current window."""
        entries = [
            entry for entry in self._context.log.entries if _ORDER.index(entry.level) >= _ORDER.index(self._least)
        ]
        self._draw_toolbar(entries)
        if not entries:
            title = {
                "info": translate("No messages yet"),
                "warning": translate("No warnings or errors yet"),
                "error": translate("No errors yet"),
            }[self._least]
            sentence = translate("Messages stay here until they are cleared.")
            draw_empty_panel(self._context, icons.ICON_FA_FILE_LINES, title, sentence)
            return
        if imgui.begin_child("entries", child_flags=imgui.ChildFlags_.nav_flattened.value):
            at_end = imgui.get_scroll_y() >= imgui.get_scroll_max_y() - 1
            for index, entry in enumerate(entries):
                imgui.push_id(index)
                _draw_row(self._context, index, entry)
                imgui.pop_id()
            if at_end:
                imgui.set_scroll_here_y(1.0)
        imgui.end_child()

    def _draw_toolbar(self, entries: list[LogEntry]) -> None:
        for level, label in _LEVELS:
            palette = self._context.palette
            chosen = level == self._least
            imgui.push_style_color(imgui.Col_.button, vec4(palette.raised, 1.0 if chosen else 0.0))
            imgui.push_style_color(imgui.Col_.text, vec4(palette.text if chosen else palette.dim))
            if imgui.button(translate_label(label)):
                self._least = level
            imgui.pop_style_color(2)
            record(self._context, f"log {level}")
            imgui.same_line(0, 2 * ui_scale())
        align_right(icons.ICON_FA_COPY, icons.ICON_FA_TRASH)
        if quiet_button(
            self._context, icons.ICON_FA_COPY, "copy log", translate("Copy listed messages"), enabled=bool(entries)
        ):
            self._context.clipboard.put("\n".join(_text(entry) for entry in entries))
        imgui.same_line()
        has_entries = bool(self._context.log.entries)
        if quiet_button(
            self._context, icons.ICON_FA_TRASH, "clear log", translate("Clear all messages"), enabled=has_entries
        ):
            self._context.log.entries.clear()


def _draw_row(context: LogContext, index: int, entry: LogEntry) -> None:
    scale = ui_scale()
    with font(context, "mono", 14.0):
        draw_dim(context, strftime("%H:%M:%S", localtime(entry.at)))
    imgui.same_line(0, 8 * scale)
    imgui.text_colored(vec4(level_color(context.palette, entry.level)), ICONS[entry.level])
    imgui.same_line(0, 6 * scale)
    imgui.begin_group()
    draw_wrapped(context.palette.text, entry.sentence)
    record(context, f"log entry {index}")
    if imgui.begin_popup_context_item("menu"):
        if imgui.menu_item(make_label(f"{icons.ICON_FA_COPY}  {translate('Copy')}", "copy"), "", False)[0]:
            context.clipboard.put(_text(entry))
        imgui.end_popup()
    if entry.detail and imgui.tree_node(translate_label("Details for a bug report")):
        with font(context, "mono", 13.0):
            draw_wrapped(context.palette.dim, entry.detail.rstrip())
        imgui.tree_pop()
    imgui.end_group()
    imgui.dummy(ImVec2(0, 0))


def _text(entry: LogEntry) -> str:
    detail = f"\n{entry.detail}" if entry.detail else ""
    return f"{strftime('%H:%M:%S', localtime(entry.at))} {entry.level}: {entry.sentence}{detail}"
