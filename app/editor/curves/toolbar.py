"""The row of tools, the context menu, and the legend."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.edits.naming import called
from ...graph import Interpolation
from ..theme.style import u32, ui_scale, vec4
from ..toolkit.buttons import dropdown, entry, quiet, room_for, tip_of, tool
from ..toolkit.words import tip
from . import commands
from .paint import paint_key
from .state import Mode

if TYPE_CHECKING:
    from ..window.editor import Editor

LOOKS: tuple[Interpolation, ...] = ("constant", "linear", "smooth", "bezier")
_GAP, _APART = 2.0, 10.0
_MEANING = {
    "constant": "holds the value up to the next key",
    "linear": "goes straight to the next key",
    "smooth": "goes smoothly, never beyond a key",
    "bezier": "goes as the handles say",
}
_MOUSE = (
    ("Drag keys", "move them; Shift between frames"),
    ("Alt + drag, ends of the bar", "draw keys out or together"),
    ("Drag on nothing", "select with a box; Shift adds, Ctrl toggles"),
    ("Double click", "a key on the curve"),
    ("Wheel", "zoom; in curves Ctrl time alone, Shift values alone"),
    ("Middle drag", "pan"),
    ("Curves: Ctrl, Shift + drag", "along values alone, along time alone"),
    ("Alt + drag a handle", "turn it alone; Shift keeps it level"),
)


@dataclass(frozen=True)
class _Tool:
    width: float
    draw: Callable[[], object]
    apart: bool = False


def draw_toolbar(editor: Editor, room: float) -> None:
    """Draw the tools in one row; what does not fit is in the context menu, behind dots."""
    scale = ui_scale()
    tools = _tools(editor)
    more = room_for(icons.ICON_FA_ELLIPSIS) + _APART * scale
    first = True
    for place, one in enumerate(tools):
        gap = 0.0 if first else (_APART if one.apart else _GAP) * scale
        needed = gap + one.width + (more if place + 1 < len(tools) else 0.0)
        if needed > room:
            imgui.same_line(0.0, _APART * scale)
            dropdown(editor, icons.ICON_FA_ELLIPSIS, "button more keys", "More tools", lambda: keys_menu(editor))
            return
        if not first:
            imgui.same_line(0.0, gap)
        first = False
        room -= gap + one.width
        one.draw()


def _tools(editor: Editor) -> list[_Tool]:
    state = editor.curves
    some, square = commands.some(editor), imgui.get_frame_height()

    def mode(which: Mode, icon: str, label: str) -> _Tool:
        def draw() -> None:
            if quiet(editor, icon, f"button keys {which}", f"{label} (Tab)", lit=state.mode == which):
                state.mode = which

        return _Tool(square, draw)

    def menu(icon: str, name: str, doc: str, context: str, apart: bool = False) -> _Tool:
        return _Tool(
            room_for(icon),
            lambda: dropdown(editor, icon, f"button keys {name}", doc, lambda: listed(editor, context)),
            apart,
        )

    rows = "Selected nodes" if state.only_selected else "All values"
    width = max(map(room_for, (f"{icons.ICON_FA_FILTER}  Selected nodes", f"{icons.ICON_FA_FILTER}  All values")))
    found = [
        mode("sheet", icons.ICON_FA_BARS_STAGGERED, "Dope sheet"),
        mode("curves", icons.ICON_FA_BEZIER_CURVE, "Curves"),
        _Tool(
            width,
            lambda: dropdown(
                editor,
                f"{icons.ICON_FA_FILTER}  {rows}",
                "button keys filter",
                "Which values have a row",
                lambda: _filters(editor),
                lit=state.only_selected,
                width=width,
            ),
            True,
        ),
        _Tool(
            square,
            lambda: dropdown(
                editor,
                icons.ICON_FA_PLUS,
                "button keys add",
                "Key a value of the selected nodes",
                lambda: offered(editor),
            ),
        ),
    ]
    found += [_Tool(square, lambda look=look: _shape(editor, look, some), look == "constant") for look in LOOKS]
    found += [
        _Tool(square, lambda how=how: _ease(editor, how), how == "keys.ease_in")
        for how in ("keys.ease_in", "keys.ease", "keys.ease_out")
    ]
    found += [
        menu(
            f"Handles  {icons.ICON_FA_CARET_DOWN}",
            "handles",
            "How handles of selected keys turn",
            "keys handles",
            apart=True,
        ),
        menu(
            f"Outside  {icons.ICON_FA_CARET_DOWN}", "outside", "Before the first and after the last key", "keys outside"
        ),
        _Tool(square, lambda: tool(editor, icons.ICON_FA_MAGNET, "keys.snap"), True),
        _Tool(square, lambda: tool(editor, icons.ICON_FA_EXPAND, "keys.fit_all")),
        _Tool(
            square,
            lambda: dropdown(
                editor,
                icons.ICON_FA_CIRCLE_QUESTION,
                "button keys legend",
                "What the shapes mean, what the mouse does",
                lambda: legend(editor),
            ),
        ),
    ]
    return found


def _shape(editor: Editor, look: Interpolation, some: bool) -> None:
    action = editor.actions[f"keys.{look}"]
    if quiet(editor, " ", f"button keys.{look}", tip_of(editor, action), enabled=some):
        editor.actions.run(action.id, editor)
    left, top, right, bottom = editor.places[f"button keys.{look}"]
    ink = u32(editor.palette.text, 1.0 if some else 0.4)
    paint_key(imgui.get_window_draw_list(), (left + right) / 2, (top + bottom) / 2, 5.5 * ui_scale(), look, ink)


def _ease(editor: Editor, id: str) -> None:
    """A button with a small curve on it."""
    action = editor.actions[id]
    enabled = action.enabled(editor)
    if quiet(editor, " ", f"button {id}", tip_of(editor, action), enabled=enabled):
        editor.actions.run(id, editor)
    left, top, right, bottom = editor.places[f"button {id}"]
    pad = (right - left) * 0.26
    way = {
        "keys.ease_in": lambda t: math.sin(t * math.pi / 2),
        "keys.ease_out": lambda t: 1 - math.cos(t * math.pi / 2),
        "keys.ease": lambda t: (1 - math.cos(t * math.pi)) / 2,
    }[id]
    line: list[imgui.ImVec2Like] = [
        imgui.ImVec2(left + pad + (right - left - 2 * pad) * t, bottom - pad - (bottom - top - 2 * pad) * way(t))
        for t in (place / 12 for place in range(13))
    ]
    ink = u32(editor.palette.text, 1.0 if enabled else 0.4)
    imgui.get_window_draw_list().add_polyline(line, ink, 1.8 * ui_scale(), 0)


def _filters(editor: Editor) -> None:
    for label, only in (("All Values", False), ("Selected Nodes", True)):
        if imgui.menu_item(label, "", editor.curves.only_selected == only)[0]:
            editor.curves.only_selected = only


def listed(editor: Editor, context: str) -> None:
    """The actions of a context, as entries of the menu that is open."""
    for action in editor.actions.context(context):
        entry(editor, action)


def offered(editor: Editor) -> None:
    """Values of the selected nodes that can be keyed."""
    found = commands.animatable(editor)
    if not found:
        imgui.text_colored(vec4(editor.palette.dim), "Select a node whose values can be keyed")
    node = ""
    for port in found:
        if port.node != node:
            node = port.node
            imgui.separator_text(node)
        if imgui.menu_item(f"{called(editor.session.graph, port)}##{port}", "", False)[0]:
            editor.attempt(lambda port=port: editor.session.key(port))


def keys_menu(editor: Editor) -> None:
    """What can be done to chosen keys."""
    for label, context in (
        ("Interpolation", "keys interpolation"),
        ("Ease", "keys ease"),
        ("Handles", "keys handles"),
        ("Outside of Keys", "keys outside"),
    ):
        if imgui.begin_menu(label):
            listed(editor, context)
            imgui.end_menu()
    imgui.separator()
    listed(editor, "keys")
    imgui.separator()
    for id in ("keys.here", "keys.all", "keys.fit_all", "keys.fit_chosen", "keys.snap"):
        entry(editor, editor.actions[id])


def legend(editor: Editor) -> None:
    """What the shapes of keys mean."""
    scale, line = ui_scale(), imgui.get_text_line_height()
    for look in LOOKS:
        corner = imgui.get_cursor_screen_pos()
        paint_key(
            imgui.get_window_draw_list(),
            corner.x + 8 * scale,
            corner.y + line / 2,
            5.0 * scale,
            look,
            u32(editor.palette.text),
        )
        imgui.dummy((18 * scale, line))
        imgui.same_line()
        imgui.text(look.title())
        imgui.same_line(100 * scale)
        imgui.text_colored(vec4(editor.palette.dim), _MEANING[look])
    imgui.separator()
    for keys, act in _MOUSE:
        imgui.text(keys)
        imgui.same_line(210 * scale)
        imgui.text_colored(vec4(editor.palette.dim), act)


__all__ = ["draw_toolbar", "keys_menu", "legend", "listed", "offered", "tip"]
