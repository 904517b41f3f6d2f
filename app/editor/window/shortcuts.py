"""Keys to actions."""

from __future__ import annotations

from imgui_bundle import imgui

from ..editor import Editor
from ..keys import chord


def note_scope(editor: Editor) -> None:
    """Keys go to the panel that the mouse was over last; to be called between two frames."""
    if editor.canvas.hovered or editor.viewer.hovered or editor.curves.hovered:
        editor.scope = "graph" if editor.canvas.hovered else "viewer" if editor.viewer.hovered else "animation"


def run_shortcuts(editor: Editor) -> None:
    """Do what the keys pressed in this frame ask for; keys that go into a text field do nothing else."""
    if editor.dialogs.any or imgui.get_io().want_text_input or imgui.is_popup_open("", _ANY_POPUP):
        return
    for action in editor.actions.all:
        text = editor.actions.shortcut(action.id)
        flags = _ROUTE | _REPEAT if action.repeats else _ROUTE
        if text and action.scope in ("", editor.scope) and imgui.shortcut(chord(text), flags):
            editor.actions.run(action.id, editor)
            return


_ROUTE = int(imgui.InputFlags_.route_global)
_REPEAT = int(imgui.InputFlags_.repeat)
_ANY_POPUP = int(imgui.PopupFlags_.any_popup)
