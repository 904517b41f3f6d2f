"""The page of a panel: what it is for, what the mouse does in it, and all of its actions with their shortcuts.

The actions are those of the menus, so that no page is out of date; only the paragraphs are written here.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui

from ...language.translation import mark, translate
from ..shared.window_commands import PanelTitle
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import close_button
from ..toolkit.dialogs import backdrop, dialog, escape_pressed
from ..toolkit.keys import display_shortcut
from ..toolkit.words import draw_wrapped, font

if TYPE_CHECKING:
    from ..shared.action import ListedAction
    from .context import DialogContext

_SIZE = 760.0, 680.0
_NAMES = 230.0

PARAGRAPHS: Mapping[PanelTitle, tuple[str, ...]] = MappingProxyType(
    {
        PanelTitle.VIEWER: (
            mark(
                "Shows a picture of the graph through a view of OpenColorIO. The wheel zooms to the "
                "pointer, the middle button moves the picture, and a right click opens the menu."
            ),
            mark(
                "The values of the selected node have handles on the picture. Ctrl+drag measures a "
                "rectangle, Ctrl+click sets a marker. The line below tells the pixel under the pointer, "
                "before the view."
            ),
        ),
        PanelTitle.GRAPH: (
            mark(
                "The nodes of the document and the links between them. A double click on empty space "
                "adds a node; drag from a socket to link it. The middle button moves the view, the wheel "
                "zooms."
            ),
            mark("Dropped files become nodes that read them. The ? in the corner explains the colors of links."),
        ),
        PanelTitle.ANIMATION: (
            mark(
                "The values that change over time, as a dope sheet or as curves. The diamond beside a "
                "value in the inspector sets its first key."
            ),
            mark("Drag keys to move them, with Alt to scale them in time. Escape cancels a drag."),
        ),
        PanelTitle.CODE: (
            mark(
                "The GLSL of a code node. Its function declares the sockets and values of the node. It "
                "is compiled a moment after the last key; an error is shown at its line, and the last "
                "good picture stays."
            ),
            mark("The ? lists the names and files that the code can use; a click inserts one."),
        ),
        PanelTitle.PROBLEMS: (
            mark(
                "What is wrong with the document, and what could be better. A click shows the node, a "
                "right click copies the sentence."
            ),
        ),
        PanelTitle.RENDERS: (
            mark(
                "Renders the graph into files, in a separate process, while you go on with your work. "
                "Frames are one frame, the range of the timeline, or a list such as 1-24x2,40."
            ),
            mark(
                "The triangle of a render plays its pictures in the viewer, the columns beside it "
                "compare it with another."
            ),
        ),
        PanelTitle.LOG: (mark("All messages since the start, the newest below. A right click copies one."),),
        PanelTitle.INSPECTOR: (
            mark(
                "The values of the selected node, or the controls and settings of the graph if nothing "
                "is selected. Drag a number, with Shift finely, or click it and type; arithmetic such as "
                "+1 or *2 works."
            ),
            mark(
                "A double click on a name resets its value. The diamond sets a key. A right click offers "
                "an expression, and makes the value a control of the graph."
            ),
        ),
        PanelTitle.SCOPES: (
            mark(
                "Histogram, waveform, parade and vectorscope of what the viewer shows, or of the "
                "scene-linear values. A region of interest in the viewer limits what is measured."
            ),
        ),
        PanelTitle.HISTORY: (mark("All steps of this session. A click goes to a step, back or forward."),),
        PanelTitle.PASSES: (
            mark(
                "The files that are read and the passes that run for the picture of the viewer, in their "
                "order: what each reads, the size and format of what it makes, and its time. A click "
                "selects its nodes."
            ),
        ),
    }
)
"""What each panel is for."""

_GROUPS: Mapping[PanelTitle, tuple[str, ...]] = MappingProxyType(
    {
        PanelTitle.VIEWER: ("viewer", "Viewer"),
        PanelTitle.GRAPH: ("graph", "Graph"),
        PanelTitle.ANIMATION: ("animation", "Time"),
        PanelTitle.CODE: ("Code",),
        PanelTitle.HISTORY: ("Edit",),
        PanelTitle.INSPECTOR: ("Edit",),
    }
)
"""The scopes and menus of a panel's actions."""


class PanelPage:
    """The page of the panel that `Dialogs.page` names."""

    def __init__(self, context: DialogContext) -> None:
        self._context = context

    def draw(self) -> None:
        """Draw the page, if it is open."""
        dialogs = self._context.dialogs
        if "panel" not in dialogs.open or dialogs.page is None:
            return
        close = backdrop(self._context, "panel")
        with dialog(self._context, "Panel", _SIZE):
            self._draw_page(dialogs.page)
            close = close_button(self._context, "close panel") or close or escape_pressed()
        if close:
            dialogs.open.discard("panel")

    def _draw_page(self, title: PanelTitle) -> None:
        palette = self._context.palette
        with font(self._context, "bold", 20.0):
            imgui.text_unformatted(translate(title))
        height = imgui.get_content_region_avail().y - imgui.get_frame_height_with_spacing()
        imgui.begin_child("page", ImVec2(0, height), imgui.ChildFlags_.nav_flattened.value)
        for paragraph in PARAGRAPHS[title]:
            draw_wrapped(palette.text, translate(paragraph))
            imgui.spacing()
        actions = self._list_actions(title)
        if actions:
            imgui.spacing()
            imgui.text_colored(vec4(palette.accent), translate("Actions"))
            self._draw_actions(actions)
        imgui.end_child()

    def _list_actions(self, title: PanelTitle) -> list[ListedAction]:
        groups = _GROUPS.get(title, ())
        actions = self._context.actions.all
        return [action for action in actions if action.scope in groups or action.menu.partition("/")[0] in groups]

    def _draw_actions(self, actions: list[ListedAction]) -> None:
        if not imgui.begin_table("actions", 2, int(imgui.TableFlags_.borders_inner_h)):
            return
        imgui.table_setup_column("name", imgui.TableColumnFlags_.width_fixed.value, _NAMES * ui_scale())
        imgui.table_setup_column("text", imgui.TableColumnFlags_.width_stretch.value)
        for action in actions:
            imgui.table_next_row()
            imgui.table_next_column()
            imgui.text_wrapped(translate(action.label).removesuffix("..."))
            imgui.table_next_column()
            keys = display_shortcut(self._context.actions.shortcut(action.id))
            draw_wrapped(self._context.palette.dim, "  ".join(filter(None, (keys, translate(action.doc)))))
        imgui.end_table()
