"""Context menus of the canvas, built from the table of actions."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui
from msgspec import Struct

from ...authoring.commands import AddDot, CutLinks, Disconnect, EditFrame, ExposeValue, HideControl, ResetValue
from ...authoring.edits.element_id import ElementId
from ...authoring.edits.naming import value_label
from ...authoring.edits.values import find_control, is_default
from ...graph import Group, Port
from ...language.translation import mark, translate
from ..shared.action import ListedAction
from ..toolkit.buttons import entry
from ..toolkit.keys import display_shortcut
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from .geometry import Point
from .scene import EMPTY, Hit

if TYPE_CHECKING:
    from .context import CanvasContext

_POPUP = "on the canvas"


class CanvasMenus(Struct):
    """The context menu for the clicked element."""

    context: CanvasContext
    is_open: bool = False
    _hit: Hit = EMPTY
    _at: Point = (0.0, 0.0)
    _opening: bool = False

    def begin(self, hit: Hit, at: Point) -> None:
        """Open the menu for what is under the mouse, at a canvas position."""
        self._hit, self._at, self._opening = hit, at, True

    def draw(self) -> None:
        """Draw the menu, if it is open."""
        if self._opening:
            imgui.open_popup(_POPUP)
            self._opening = False
            self.context.canvas.pointer = self._at
        self.is_open = imgui.begin_popup(_POPUP)
        if not self.is_open:
            return
        session, hit = self.context.session, self._hit
        if hit.part == "link" and hit.port:
            target = hit.port
            _draw_item(self.context, mark("Add a dot"), lambda: session.apply(AddDot(target, self._at)))
            _draw_item(self.context, mark("Cut this link"), lambda: session.apply(CutLinks((target,))))
        elif hit.part == "pin" and hit.port:
            self._draw_pin_items(hit.port, hit.output)
        elif hit.part == "field" and hit.port:
            self._draw_field_items(hit.port)
            imgui.separator()
        if hit.part == "empty":
            label = f"{icons.ICON_FA_MAGNIFYING_GLASS}  {translate('Search to add ...')}"
            if imgui.menu_item(label, _find_shortcut(self.context, "node.add"), False)[0]:
                self.context.canvas.searching = True
            record(self.context, "menu search")
            imgui.separator()
        kind = hit.key.kind
        if hit.key.is_note:
            if imgui.menu_item(
                translate_label("Rename ...") if kind == "frame" else translate_label("Edit text ..."), "", False
            )[0]:
                self.context.canvas.renaming = hit.key
            if kind == "frame":
                _draw_colors(self.context, hit.key)
        for action in self.context.actions.in_menu(_find_menu(hit)):
            if action.id != "node.add":
                _draw_action(self.context, action)
        if isinstance(self.context.session.graph.nodes.get(hit.key), Group):
            for action in self.context.actions.in_menu("group"):
                _draw_action(self.context, action)
        if self.context.session.code_files.find_code(hit.key) is not None:
            for action in self.context.actions.in_menu("code"):
                _draw_action(self.context, action)
        imgui.end_popup()

    def _draw_pin_items(self, port: Port, output: bool) -> None:
        session = self.context.session
        if output:
            _draw_item(self.context, mark("View"), lambda: session.views.show(port))
            _draw_item(self.context, mark("View as B"), lambda: session.views.show(port, "B"))
            fed = [target for target, source in session.graph.links.items() if source == port]
            _draw_item(self.context, mark("Cut its links"), lambda: session.apply(CutLinks(fed)), bool(fed))
        else:
            _draw_item(
                self.context, mark("Cut its link"), lambda: session.apply(Disconnect(port)), port in session.graph.links
            )
            if port.node in session.graph.nodes and port in session.graph.links:
                _draw_item(self.context, mark("Add a dot"), lambda: session.apply(AddDot(port, self._at)))

    def _draw_field_items(self, port: Port) -> None:
        session = self.context.session
        _draw_item(
            self.context,
            mark("Reset {socket}"),
            lambda: session.apply(ResetValue(port)),
            not is_default(session.graph, port),
            socket=value_label(session.graph, port),
        )
        control = find_control(session.graph, port)
        if control:
            _draw_item(
                self.context,
                mark("Hide the control '{control}'"),
                lambda: session.apply(HideControl(control)),
                control=control,
            )
        else:
            _draw_item(self.context, mark("Show as a control of the graph"), lambda: session.apply(ExposeValue(port)))


def _find_menu(hit: Hit) -> str:
    if hit.part in ("link", "pin"):
        return hit.part
    if hit.part == "empty":
        return "canvas"
    return hit.key.kind if hit.key.is_decor else "node"


def _draw_colors(context: CanvasContext, frame: ElementId) -> None:
    """Colors for a frame: those of headers, so that frames and nodes look alike."""
    for index, color in enumerate(dict.fromkeys(context.palette.categories.values())):
        if index % 7:
            imgui.same_line()
        if imgui.color_button(f"##frame color {index}", (*color, 1.0), int(imgui.ColorEditFlags_.no_tooltip)):
            context.log.attempt(lambda color=color: context.session.apply(EditFrame(frame, color=color)))
    imgui.separator()


def _draw_action(context: CanvasContext, action: ListedAction) -> None:
    if action.separated:
        imgui.separator()
    entry(context, action)


def _find_shortcut(context: CanvasContext, id: str) -> str:
    text = context.actions.shortcut(id)
    return display_shortcut(text) if text else ""


def _draw_item(
    context: CanvasContext, label: str, act: Callable[[], object], enabled: bool = True, **places: str
) -> None:
    if imgui.menu_item(make_label(translate(label, **places), label), "", False, enabled)[0]:
        context.log.attempt(act)
    record(context, f"menu {label.format(**places)}")
