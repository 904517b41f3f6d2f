"""The top of the inspector: kind, name, description and problems of an element."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from halation.nodes import Node, Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.edits.coding import LANGUAGES
from ...authoring.edits.element_id import ElementId
from ...graph import Group, Item, Problem
from ...graph.rules import UNFINISHED_NODE, UNLINKED_INPUT
from ...language.translation import translate
from ..fields.fields import Fields
from ..fields.text_field import text_field
from ..shared.declared_words import describe_type, head_type
from ..theme.palette import RGB
from ..theme.style import EM, u32, ui_scale
from ..toolkit.places import item_rect, place
from ..toolkit.words import font, tip, write

if TYPE_CHECKING:
    from .rows import Rows

_NAME = Value("name", "text", "")


def draw_heading(
    rows: Rows, kind: str, color: RGB, buttons: Callable[[], object] | None = None, count: int = 0
) -> None:
    """Draw the kind of element in its color on the canvas, with space for `count` buttons."""
    room = rows.width - count * (imgui.get_frame_height() + 2.0 * ui_scale())
    rect = place(room)
    imgui.dummy((max(room, 1.0), rect[3] - rect[1]))
    bar, scale = 4.0 * ui_scale(), ui_scale()
    imgui.get_window_draw_list().add_rect_filled(
        (rect[0], rect[1] + 3 * scale), (rect[0] + bar, rect[3] - 3 * scale), u32(color), bar / 2
    )
    with font(rows.context, "bold", EM * 1.06):
        write((rect[0] + bar + 7 * scale, rect[1], rect[2], rect[3]), kind, rows.palette.text)
    if buttons:
        imgui.same_line(0.0, 0.0)
        imgui.push_style_var(imgui.StyleVar_.item_spacing, (2.0 * scale, imgui.get_style().item_spacing.y))
        buttons()
        imgui.pop_style_var()


def draw_name_field(
    rows: Rows, fields: Fields, key: str, name: str, then: Callable[[str], object], doc: str = ""
) -> None:
    """Draw the editable name of an element."""
    rows.name(f"{key} name", translate("name", "value"), doc=doc)
    edit = text_field(fields, f"{key} name", name, _NAME, rows.field())
    rows.record(f"{key} name")
    if edit:
        rows.act(lambda: then(str(edit.value)))


def draw_explanation(rows: Rows, doc: str, open: bool) -> bool:
    """Draw the first line of a docstring; a click shows the rest. True while all of it is shown."""
    if not doc:
        return False
    first, _, rest = doc.partition("\n")
    text = doc if open else f"{first} {icons.ICON_FA_ELLIPSIS}" if rest.strip() else first
    rows.note(_join_lines(text))
    if rest.strip():
        tip("" if open else _join_lines(doc))
        if imgui.is_item_hovered():
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
        if imgui.is_item_clicked():
            open = not open
        rows.context.places["doc"] = item_rect()
    return open


def draw_faults(rows: Rows, element: ElementId) -> None:
    """Draw the problems of an element: those of the graph, and errors while rendering."""
    context = rows.context
    path = "/".join((*context.session.place, element))
    problems = context.session.problems.get(element, ())
    for problem in problems:
        color = rows.palette.error if problem.severity == "error" else rows.palette.warning
        rows.note(problem.sentence, color, icon=icons.ICON_FA_TRIANGLE_EXCLAMATION)
    rendered = context.preview.faults.get(path, "")
    if rendered and not any(_tells(problem, rendered) for problem in problems):
        rows.note(rendered, rows.palette.error, icon=icons.ICON_FA_TRIANGLE_EXCLAMATION)


def _tells(problem: Problem, rendered: str) -> bool:
    """True if a problem of the graph says what an error while rendering says: itself, or which link is missing."""
    is_link = problem.rule in (UNLINKED_INPUT, UNFINISHED_NODE) and f"'{problem.socket}'" in rendered
    return is_link or rendered == problem.sentence


def title_of(item: Item) -> str:
    """The title of a node's type."""
    if isinstance(item, Node):
        return head_type(item.title)
    return translate("Group", "element") if isinstance(item, Group) else LANGUAGES.get(item.type, item.type)


def doc_of(item: Item) -> str:
    """The docstring of a node type."""
    return "\n\n".join(describe_type(type(item))) if isinstance(item, Node) else ""


def _join_lines(doc: str) -> str:
    """Paragraphs without the line breaks and marks inside them."""
    return "\n\n".join(" ".join(part.split()) for part in doc.replace("`", "").split("\n\n"))
