"""Hints in the status line: what the mouse and keys do in the panel under the mouse."""

from __future__ import annotations

from ...language.translation import mark, translate
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
            return (translate("Click"), translate("pick from the picture")), (
                translate("Right click"),
                translate("cancel"),
            )
        if viewer.drawing_region:
            return ((translate("Drag"), translate("draw the region")),)
        if viewer.orbits:
            return (
                (translate("Drag"), translate("orbit")),
                (translate("Shift+drag"), translate("move the scene")),
                (translate("Wheel"), translate("nearer")),
                (translate("Space+drag"), translate("move the picture")),
                (key_text(editor, "viewer.frame_scene"), translate("frame the scene")),
            )
        if picks(context):
            return (
                (translate("Click"), translate("select or deselect an object")),
                (translate("Drag"), translate("move the picture")),
                (translate("Wheel"), translate("zoom")),
            )
        if can_add(context):
            return (
                (translate("Drag"), translate("move a light")),
                (translate("Alt+drag or wheel"), translate("nearer or farther")),
                (translate("Shift+drag"), translate("onto a surface")),
                (translate("Double click"), translate("add a light")),
                (key_text(editor, "viewer.remove_light"), translate("remove the light")),
            )
    if panel == PanelTitle.GRAPH and canvas.tool:
        return (translate("Drag"), translate("across links")), (translate("Escape"), translate("cancel"))
    return tuple(
        (key_text(editor, keys), translate(does))
        for keys, does in _HINTS.get(panel, _ANYWHERE)
        if key_text(editor, keys)
    )


def key_text(editor: Editor, keys: str) -> str:
    """`keys`, or the current shortcut if they name an action."""
    return display_shortcut(editor.actions.shortcut(keys)) if "." in keys else translate(keys)


_HINTS: dict[str, tuple[Hint, ...]] = {
    PanelTitle.GRAPH: (
        ("node.add", mark("add a node")),
        (mark("Drag a socket"), mark("link")),
        (mark("Middle drag"), mark("move the view")),
        (mark("Wheel"), mark("zoom")),
        (mark("Right click"), mark("menu")),
        (mark("Ctrl+Right drag"), mark("cut links")),
    ),
    PanelTitle.VIEWER: (
        (mark("Wheel"), mark("zoom")),
        (mark("Middle drag"), mark("move the picture")),
        ("viewer.fit", mark("fit")),
        ("viewer.wipe", mark("wipe")),
        (mark("Ctrl+drag"), mark("measure")),
        (mark("Ctrl+click"), mark("marker")),
        (mark("Right click"), mark("menu")),
    ),
    PanelTitle.INSPECTOR: (
        (mark("Drag"), mark("change (Shift: fine)")),
        (mark("Click"), mark("type, also +1 or *2")),
        (mark("Double click a name"), mark("reset")),
        (mark("Right click"), mark("more")),
    ),
    "Timeline": (
        (mark("Drag"), mark("go to a frame")),
        ("time.play", mark("play")),
        (mark("Wheel"), mark("zoom")),
        (mark("Middle drag"), mark("scroll")),
        (mark("Drag a corner"), mark("set the playback range")),
        (mark("Right click"), mark("more")),
    ),
    PanelTitle.SCOPES: (("viewer.region", mark("measure a part of the picture")),),
    PanelTitle.HISTORY: ((mark("Click"), mark("go to a step")),),
    PanelTitle.PASSES: ((mark("Click"), mark("select its nodes")),),
    PanelTitle.PROBLEMS: ((mark("Click"), mark("show the node")), (mark("Right click"), mark("copy"))),
    PanelTitle.LOG: ((mark("Right click"), mark("copy")),),
}
_ANYWHERE = (
    ("help.palette", mark("find any command")),
    ("help.manual", mark("manual page")),
    ("help.shortcuts", mark("all shortcuts")),
)
