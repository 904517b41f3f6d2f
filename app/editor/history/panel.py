"""The History panel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...language.translation import translate
from ..theme.palette import RGB
from ..theme.style import mix, u32, ui_scale, vec4
from ..toolkit.labels import make_label
from ..toolkit.places import record
from ..toolkit.words import draw_empty_panel

if TYPE_CHECKING:
    from .context import HistoryContext


class HistoryPanel:
    """The undo steps, oldest first; a click goes there. Undone steps stay until the next edit."""

    def __init__(self, context: HistoryContext) -> None:
        self._context = context
        self._seen = (0, 0)

    def draw(self) -> None:
        """Draw into the current window."""
        history = self._context.session.history
        if not history.steps:
            icon = icons.ICON_FA_CLOCK_ROTATE_LEFT
            draw_empty_panel(
                self._context,
                icon,
                translate("No changes yet"),
                translate("Changes appear here. Click one to go back to it."),
            )
            return
        labels = (translate("As opened"), *history.steps)
        moved, self._seen = self._seen != (len(labels), history.position), (len(labels), history.position)
        clipper = imgui.ListClipper()
        clipper.begin(len(labels), imgui.get_text_line_height_with_spacing())
        if moved:
            clipper.include_item_by_index(history.position)
        while clipper.step():
            for index in range(clipper.display_start, clipper.display_end):
                self._draw_row(index, labels[index])
                if moved and index == history.position:
                    imgui.set_scroll_here_y(0.5)
        clipper.end()

    def _draw_row(self, index: int, label: str) -> None:
        palette, position = self._context.palette, self._context.session.history.position
        current, undone = index == position, index > position
        color = mix(palette.dim, palette.panel, 0.35) if undone else palette.text
        imgui.push_style_color(imgui.Col_.text, vec4(palette.accent if current else color))
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + 20 * ui_scale())
        if imgui.selectable(make_label(label, str(index)), current)[0] and not current:
            self._context.log.attempt(lambda: self._context.session.go_to(index))
        imgui.pop_style_color()
        record(self._context, f"history {index}")
        _draw_mark(self._context, palette.accent if current else color, first=index == 0)


def _draw_mark(context: HistoryContext, color: RGB, first: bool) -> None:
    """Draw a dot left of the last item, joined with the one above."""
    low, high, scale = imgui.get_item_rect_min(), imgui.get_item_rect_max(), ui_scale()
    x, y, lines = low.x - 10 * scale, (low.y + high.y) / 2, imgui.get_window_draw_list()
    if not first:
        above = y - imgui.get_text_line_height_with_spacing() + 5 * scale
        lines.add_line(ImVec2(x, above), ImVec2(x, y - 5 * scale), u32(context.palette.raised), 2 * scale)
    lines.add_circle_filled(ImVec2(x, y), 3.5 * scale, u32(color))
