"""Hints in the status line: what the mouse and keys do in the panel under the mouse."""

from __future__ import annotations

from ..shared.window_commands import PanelTitle
from ..toolkit.keys import display_shortcut
from ..viewer.context import ViewerContext
from ..viewer.lights import can_add
from ..viewer.mattes import picks
from .editor import Editor

Hint = tuple[str, str]
"""Keys or a button, and what they do."""


def list_hints(editor: Editor, context: ViewerContext, panel: str) -> tuple[Hint, ...]:
    """The hints for a panel, the most useful ones first."""
    viewer, canvas = editor.viewer, editor.canvas
    if panel == PanelTitle.VIEWER:
        if viewer.picking:
            return ("Click", "pick from the picture"), ("Right click", "cancel")
        if viewer.drawing_region:
            return (("Drag", "draw the region"),)
        if viewer.orbits:
            return (
                ("Drag", "orbit"),
                ("Shift+drag", "move the scene"),
                ("Wheel", "nearer"),
                ("Space+drag", "move the picture"),
                (key_text(editor, "viewer.frame_scene"), "frame the scene"),
            )
        if picks(context):
            return ("Click", "select or deselect an object"), ("Drag", "move the picture"), ("Wheel", "zoom")
        if can_add(context):
            return (
                ("Drag", "move a light"),
                ("Alt+drag or wheel", "nearer or farther"),
                ("Shift+drag", "onto a surface"),
                ("Double click", "add a light"),
                (key_text(editor, "viewer.remove_light"), "remove the light"),
            )
    if panel == PanelTitle.GRAPH and canvas.tool:
        return ("Drag", "across links"), ("Escape", "cancel")
    return tuple(
        (key_text(editor, keys), does) for keys, does in _HINTS.get(panel, _ANYWHERE) if key_text(editor, keys)
    )


def key_text(editor: Editor, keys: str) -> str:
    """`keys`, or the current shortcut if they name an action."""
    return display_shortcut(editor.actions.shortcut(keys)) if "." in keys else keys


_HINTS: dict[str, tuple[Hint, ...]] = {
    PanelTitle.GRAPH: (
        ("node.add", "add a node"),
        ("Drag a socket", "link"),
        ("Middle drag", "move the view"),
        ("Wheel", "zoom"),
        ("Right click", "menu"),
        ("Ctrl+Right drag", "cut links"),
    ),
    PanelTitle.VIEWER: (
        ("Wheel", "zoom"),
        ("Middle drag", "move the picture"),
        ("viewer.fit", "fit"),
        ("viewer.wipe", "wipe"),
        ("Ctrl+drag", "measure"),
        ("Ctrl+click", "marker"),
        ("Right click", "menu"),
    ),
    PanelTitle.INSPECTOR: (
        ("Drag", "change (Shift: fine)"),
        ("Click", "type, also +1 or *2"),
        ("Double click a name", "reset"),
        ("Right click", "more"),
    ),
    "Timeline": (
        ("Drag", "go to a frame"),
        ("time.play", "play"),
        ("Wheel", "zoom"),
        ("Middle drag", "scroll"),
        ("Drag a corner", "set the playback range"),
        ("Right click", "more"),
    ),
    PanelTitle.SCOPES: (("viewer.region", "measure a part of the picture"),),
    PanelTitle.HISTORY: (("Click", "go to a step"),),
    PanelTitle.PASSES: (("Click", "select its nodes"),),
    PanelTitle.PROBLEMS: (("Click", "show the node"), ("Right click", "copy")),
    PanelTitle.LOG: (("Right click", "copy"),),
}
_ANYWHERE = (("help.palette", "find any command"), ("help.manual", "manual page"), ("help.shortcuts", "all shortcuts"))
