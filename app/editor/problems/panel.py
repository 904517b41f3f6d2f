"""The Problems panel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...language.translation import translate, translate_plural
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import align_right, quiet_button
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from ..toolkit.words import ICONS, draw_dim, draw_empty_panel, draw_wrapped, font, level_color, tip
from .findings import ListedProblem, list_problems, show_element

if TYPE_CHECKING:
    from .context import ProblemsContext


def _copy_label() -> str:
    return f"{icons.ICON_FA_COPY}  {translate('Copy')}"


class ProblemsPanel:
    """The list of problems; a click goes to the node."""

    def __init__(self, context: ProblemsContext) -> None:
        self._context = context

    def draw(self) -> None:
        """Draw into the current window."""
        problems = list_problems(self._context)
        if not problems:
            draw_empty_panel(
                self._context,
                icons.ICON_FA_CIRCLE_CHECK,
                translate("No problems"),
                translate("Errors and warnings appear here."),
            )
            return
        imgui.align_text_to_frame_padding()
        draw_dim(
            self._context,
            translate_plural("{count} problem", "{count} problems", len(problems)),
        )
        align_right(_copy_label())
        if quiet_button(self._context, _copy_label(), "copy problems", translate("Copy all as text")):
            self._context.clipboard.put("\n".join(problem_text(finding) for finding in problems))
        if imgui.begin_child("problems", child_flags=imgui.ChildFlags_.nav_flattened.value):
            for index, finding in enumerate(problems):
                imgui.push_id(index)
                self._draw_row(index, finding)
                imgui.pop_id()
        imgui.end_child()

    def _draw_row(self, index: int, finding: ListedProblem) -> None:
        """Draw one problem: first a row that takes clicks, then the text over it, from the same corner.

        The empty item at the end tells the interface library that the cursor was moved on purpose.
        """
        scale, style = ui_scale(), imgui.get_style()
        indent = 26 * scale
        room = imgui.get_content_region_avail().x - indent - 6 * scale
        title = finding.where.replace("/", " / ")
        lines = imgui.calc_text_size(finding.sentence, wrap_width=room).y
        height = lines + (imgui.get_text_line_height_with_spacing() if title else 0) + 2 * style.frame_padding.y
        start = imgui.get_cursor_pos()
        if imgui.selectable("##row", False, 0, ImVec2(0, height))[0] and finding.where:
            self._context.log.attempt(lambda: show_element(self._context, finding.where))
        record(self._context, f"problem {index}")
        if finding.where:
            tip(translate("Click to show the node"))
        if imgui.begin_popup_context_item("menu"):
            if imgui.menu_item(make_label(_copy_label(), "copy"), "", False)[0]:
                self._context.clipboard.put(problem_text(finding))
            imgui.end_popup()
        after = imgui.get_cursor_pos()
        imgui.set_cursor_pos(ImVec2(start.x + 4 * scale, start.y + style.frame_padding.y))
        imgui.text_colored(vec4(level_color(self._context.palette, finding.level)), ICONS[finding.level])
        imgui.set_cursor_pos(ImVec2(start.x + indent, start.y + style.frame_padding.y))
        imgui.begin_group()
        imgui.push_text_wrap_pos(start.x + indent + room)
        if title:
            with font(self._context, "bold"):
                imgui.text_unformatted(title)
        draw_wrapped(self._context.palette.text, finding.sentence)
        imgui.pop_text_wrap_pos()
        imgui.end_group()
        imgui.set_cursor_pos(after)
        imgui.dummy(ImVec2(0, 0))
        if finding.detail:
            _draw_detail(self._context, finding.detail, f"detail {index}")


def _draw_detail(context: ProblemsContext, detail: str, name: str) -> None:
    """Draw a traceback, to copy it into a bug report."""
    opened = imgui.tree_node(translate_label("Details for a bug report"))
    record(context, name)
    if not opened:
        return
    if quiet_button(context, _copy_label(), f"copy {name}", translate("Copy the details")):
        context.clipboard.put(detail)
    with font(context, "mono", 13.0):
        draw_wrapped(context.palette.dim, detail.rstrip())
    imgui.tree_pop()


def problem_text(finding: ListedProblem) -> str:
    """A problem as text for the clipboard."""
    head = f"{finding.where}: " if finding.where else ""
    return f"{head}{finding.sentence}" + (f"\n{finding.detail}" if finding.detail else "")
