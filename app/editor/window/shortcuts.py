"""Runs the actions of pressed shortcuts."""

from __future__ import annotations

from collections.abc import Mapping

from imgui_bundle import imgui

from ..shared.action import Scope
from ..shared.window_commands import PanelTitle
from ..toolkit.keys import chord
from .editor import Editor


def note_scope(editor: Editor) -> None:
    """Keys go to the panel that the mouse was over last, or Ctrl+Tab led to; to be called between two frames."""
    if (walked := editor.interface.walked_panel) is not None:
        editor.scope = _SCOPES.get(walked, editor.scope)
    elif editor.canvas.hovered or editor.viewer.hovered or editor.curves.hovered:
        editor.scope = "graph" if editor.canvas.hovered else "viewer" if editor.viewer.hovered else "animation"


def run_shortcuts(editor: Editor) -> None:
    """Run the actions of the keys that were pressed in this frame.

    In a text field only those of the whole window run whose keys no text takes, such as `Ctrl+N`, one frame later: the
    field gives up the keyboard first, and what was typed counts.
    """
    if waiting := editor.waiting_action:
        editor.waiting_action = ""
        editor.code.flush()
        editor.actions.run(waiting)
    if editor.dialogs.any or imgui.is_popup_open("", _ANY_POPUP):
        editor.timeline.tapped = False
    elif imgui.get_io().want_text_input:
        editor.timeline.tapped = False
        _note_shortcut_in_text(editor)
    else:
        _run_pressed(editor)


def _run_pressed(editor: Editor) -> None:
    if imgui.is_key_pressed(imgui.Key.space, False):
        editor.timeline.tapped = not imgui.get_io().key_mods
    for button in range(3):
        editor.timeline.tapped &= not imgui.is_mouse_down(button)
    for action, text in editor.actions.list_shortcuts(editor.scope):
        if _is_pressed(editor, text, action.repeats):
            editor.actions.run(action.id)
            break
    for key in _TAKEN:
        imgui.internal.set_key_owner(key, _OURS)


def _note_shortcut_in_text(editor: Editor) -> None:
    for action, text in editor.actions.list_shortcuts(""):
        if _is_free_in_text(text) and imgui.shortcut(chord(text), _ROUTE):
            imgui.internal.clear_active_id()
            editor.waiting_action = action.id
            return


def _is_free_in_text(text: str) -> bool:
    """True for function keys, and for `Ctrl` with a key that text fields have no use for."""
    keys = chord(text)
    key = imgui.Key(keys & ~_MODIFIERS)
    is_function = int(imgui.Key.f1) <= key <= int(imgui.Key.f24)
    return is_function or (bool(keys & int(imgui.Key.mod_ctrl)) and key not in _OF_TEXT)


def _is_pressed(editor: Editor, text: str, repeats: bool) -> bool:
    keys = chord(text)
    key = imgui.Key(keys & ~_MODIFIERS)
    if key == imgui.Key.tab and _walks(editor):
        return False
    if key not in _TAKEN:
        return imgui.shortcut(keys, _ROUTE | _REPEAT if repeats else _ROUTE)
    if int(imgui.get_io().key_mods) != keys & _MODIFIERS:
        return False
    if key == imgui.Key.space and not keys & _MODIFIERS:  # held, it lets the mouse pan
        return editor.timeline.tapped and imgui.is_key_released(key)
    return imgui.is_key_pressed(key, repeats)


def _walks(editor: Editor) -> bool:
    """True if Tab walks through the fields of a panel: of any that has no other use for it, and of those that the
    keyboard led to. Over the graph it always opens the search.
    """
    walked = editor.interface.walked_panel
    if walked is not None:
        return walked != PanelTitle.GRAPH
    return editor.interface.pointed_panel not in _WITH_SCOPES


_ROUTE = int(imgui.InputFlags_.route_global)
_REPEAT = int(imgui.InputFlags_.repeat)
_ANY_POPUP = int(imgui.PopupFlags_.any_popup)
_MODIFIERS = sum(
    int(item) for item in (imgui.Key.mod_ctrl, imgui.Key.mod_shift, imgui.Key.mod_alt, imgui.Key.mod_super)
)
_SCOPES: Mapping[PanelTitle, Scope] = {
    PanelTitle.GRAPH: "graph",
    PanelTitle.VIEWER: "viewer",
    PanelTitle.ANIMATION: "animation",
}
"""Panels with shortcuts of their own."""

_WITH_SCOPES = (None, *_SCOPES)
"""These panels, and where there is no panel."""

_TAKEN = (imgui.Key.space, imgui.Key.left_arrow, imgui.Key.right_arrow, imgui.Key.up_arrow, imgui.Key.down_arrow)
"""Keys that the library would use for buttons, if actions did not take them."""

_OF_TEXT = (
    *(imgui.Key.a, imgui.Key.c, imgui.Key.v, imgui.Key.x, imgui.Key.y, imgui.Key.z),
    *(imgui.Key.space, imgui.Key.tab, imgui.Key.enter, imgui.Key.keypad_enter, imgui.Key.insert),
    *(imgui.Key.backspace, imgui.Key.delete, imgui.Key.home, imgui.Key.end, imgui.Key.page_up, imgui.Key.page_down),
    *(imgui.Key.left_arrow, imgui.Key.right_arrow, imgui.Key.up_arrow, imgui.Key.down_arrow),
)
"""Keys that edit text, or move in it, together with Ctrl."""

_OURS = 0x48414C41
"""The id under which the window owns keys: "HALA" in ASCII."""
