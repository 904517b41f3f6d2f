"""Keymaps: the shortcuts that users of another program have in their hands.

A keymap says what differs from the shortcuts that the actions declare, "" for none; all others stay. It is complete:
an action that has a shortcut in Halation has one in each keymap, and no key has two meanings in one panel. Where a key
of the other program takes that of an action which that program does not know, the action gets a neighboring one.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

NUKE: Mapping[str, str] = MappingProxyType(
    {
        "edit.redo": "Ctrl+Y",
        "edit.preferences": "Shift+S",
        "edit.duplicate": "Alt+C",
        "file.render": "F5",
        "view.maximize": "Space",
        "view.fit_all": "H",
        "view.thumbnails": "Alt+P",
        "time.play": "Ctrl+Space",
        "time.first": "Home",
        "time.last": "End",
        "time.previous_key": "Ctrl+LeftArrow",
        "time.next_key": "Ctrl+RightArrow",
        "time.whole": "Alt+U",
        "node.mute": "D",
        "node.rename": "N",
        "node.extract": "Ctrl+Shift+X",
        "node.swap": "Shift+X",
        "node.replace": "Shift+R",
        "node.collapse": "Shift+H",
        "comment.add": "Shift+N",
        "frame.add": "Alt+B",
        "link.dots": "Period",
        "group.ungroup": "Ctrl+Alt+G",
        "select.linked": "Ctrl+Alt+A",
        "viewer.luminance": "Y",
        "viewer.region": "Alt+W",
        "viewer.gizmos": "Q",
        "viewer.other": "Shift+W",
        "viewer.frame_scene": "Shift+F",
        "keys.constant": "K",
        "keys.bezier": "C",
        "keys.smooth": "Z",
        "keys.free": "X",
        "keys.here": "Shift+K",
        "keys.snap": "Alt+S",
    }
)
"""Nuke: Foundry's tables of hotkeys for the Node Graph, the Viewer and the Curve Editor."""

BLENDER: Mapping[str, str] = MappingProxyType(
    {
        "help.palette": "F3",
        "view.full_screen": "Ctrl+Alt+Space",
        "edit.delete": "Ctrl+X",
        "edit.delete_break": "X",
        "edit.cut": "Ctrl+Shift+X",
        "edit.duplicate": "Shift+D",
        "select.all": "A",
        "select.none": "Alt+A",
        "select.upstream": "L",
        "select.downstream": "Shift+L",
        "select.linked": "Ctrl+L",
        "layout.arrange": "Shift+R",
        "node.add": "Shift+A",
        "node.extract": "Alt+D",
        "group.enter": "Tab",
        "group.ungroup": "Ctrl+Alt+G",
        "frame.add": "Ctrl+J",
        "view.fit_selection": "KeypadDecimal",
        "time.in": "Ctrl+Home",
        "time.out": "Ctrl+End",
        "viewer.fit": "Home",
        "viewer.frame_scene": "Shift+Home",
        "viewer.remove_light": "X",
        "keys.here": "I",
        "keys.all": "A",
        "keys.none": "Alt+A",
        "keys.fit_all": "Home",
        "keys.fit_chosen": "KeypadDecimal",
        "keys.duplicate": "Shift+D",
        "keys.delete": "X",
    }
)
"""Blender: the default keymap of the node editor, the image editor and the graph editor. Ctrl+X dissolves a node there
as Delete does here; X breaks its links."""

FUSION: Mapping[str, str] = MappingProxyType(
    {
        "edit.redo": "Ctrl+Y",
        "help.palette": "Ctrl+Shift+P",
        "file.render": "Ctrl+R",
        "node.add": "Shift+Space",
        "node.mute": "Ctrl+P",
        "node.view": "1",
        "node.view_b": "2",
        "group.enter": "Ctrl+E",
        "view.fit_all": "Ctrl+F",
        "time.first": "Ctrl+LeftArrow",
        "time.last": "Ctrl+RightArrow",
        "time.previous_key": "Alt+LeftBracket",
        "time.next_key": "Alt+RightBracket",
        "viewer.fit": "Ctrl+F",
        "viewer.actual": "Ctrl+1",
        "viewer.wipe": "Slash",
        "viewer.other": "Period",
        "keys.linear": "Shift+L",
        "keys.smooth": "Shift+S",
        "keys.constant": "Shift+I",
        "keys.ease_in": "Shift+E",
        "keys.snap": "Shift+G",
        "keys.fit_all": "Ctrl+F",
        **{f"viewer.recall.{number}": f"Alt+{number}" for number in range(1, 10)},
        **{f"viewer.assign.{number}": f"Ctrl+Alt+{number}" for number in range(1, 10)},
    }
)
"""Fusion: the hotkeys of flow, views, time and splines. 1 and 2 show a tool on the left and the right view."""

KEYMAPS: Mapping[str, Mapping[str, str]] = MappingProxyType(
    {"halation": MappingProxyType({}), "nuke": NUKE, "blender": BLENDER, "fusion": FUSION}
)
"""All keymaps by their name in the preferences."""
