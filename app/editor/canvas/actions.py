"""Actions on nodes, links and their places."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...graph import Group
from ..shared.action import Act, Action
from ..shared.dialogs import Browse
from ..workflows.documents import open_graph
from .pictures import with_room
from .view import Tool

if TYPE_CHECKING:
    from ..window.editor import Editor

_SIDES = (
    ("left", "Left"),
    ("right", "Right"),
    ("top", "Top"),
    ("bottom", "Bottom"),
    ("center x", "Centers in a Column"),
    ("center y", "Centers in a Row"),
    ("distribute x", "Spread Across"),
    ("distribute y", "Spread Down"),
)


def _some(editor: Editor) -> bool:
    return bool(editor.session.selection)


def _several(editor: Editor) -> bool:
    return len(editor.session.selection) > 1


def _node(editor: Editor) -> bool:
    return editor.session.active in editor.session.graph.nodes


def _group(editor: Editor) -> bool:
    return isinstance(editor.session.graph.nodes.get(editor.session.active), Group)


def _borrowed_group(editor: Editor) -> bool:
    item = editor.session.graph.nodes.get(editor.session.active)
    return isinstance(item, Group) and bool(item.path)


def _save_group(editor: Editor) -> None:
    """Ask for a file, and let the group come from it from now on."""
    id = editor.session.active

    def saved(path: Path) -> None:
        editor.attempt(lambda: editor.session.save_group(id, path.with_suffix(".json"), link=True))

    editor.dialogs.browse = Browse("Save the group as", "graph", saved, saving=True, name=f"{id}.json")


def _open_group(editor: Editor) -> None:
    item = editor.session.graph.nodes[editor.session.active]
    assert isinstance(item, Group)
    open_graph(editor, Path(editor.session.graph.folder, item.path))


def _replace(editor: Editor) -> None:
    editor.canvas.replacing = editor.session.active


def _search(editor: Editor) -> None:
    editor.canvas.searching = True


def _frame(editor: Editor) -> None:
    at = None if editor.session.selection else editor.canvas.pointer
    editor.session.add_frame(at=at, sizes=editor.canvas.sizes)


def _rename(editor: Editor) -> None:
    editor.canvas.renaming = editor.session.active


def _tool(tool: Tool) -> Act:
    def take(editor: Editor) -> None:
        editor.canvas.tool = tool

    return take


def _align(side: str, label: str) -> Action:
    return Action(
        f"align.{side.replace(' ', '_')}",
        label,
        lambda e: e.session.align(side, e.canvas.sizes or {}),
        "Graph/Align",
        scope="graph",
        enabled=_several,
    )


GRAPH: tuple[Action, ...] = (
    Action("node.add", "Add Node...", _search, "Graph", "Tab", "graph", contexts=frozenset({"canvas"})),
    Action(
        "node.mute",
        "Mute",
        lambda e: e.session.mute(),
        "Graph",
        "M",
        "graph",
        _some,
        contexts=frozenset({"node"}),
        doc="The node passes its first input through.",
        separated=True,
    ),
    Action(
        "node.collapse",
        "Collapse",
        lambda e: e.session.collapse(),
        "Graph",
        "H",
        "graph",
        _some,
        contexts=frozenset({"node"}),
    ),
    Action(
        "node.view",
        "View",
        lambda e: e.session.view_node(e.session.active),
        "Graph",
        "V",
        "graph",
        _node,
        contexts=frozenset({"node"}),
        doc="Show this node in the viewer; again shows its next output.",
    ),
    Action(
        "node.view_b",
        "View as B",
        lambda e: e.session.view_node(e.session.active, "B"),
        "Graph",
        "Shift+V",
        "graph",
        _node,
        contexts=frozenset({"node"}),
        doc="Compare with this node.",
    ),
    Action(
        "node.extract",
        "Extract from Chain",
        lambda e: e.session.extract(),
        "Graph",
        "Alt+X",
        "graph",
        _some,
        contexts=frozenset({"node"}),
        doc="Take the selection out of its chain, which closes behind it.",
    ),
    Action(
        "node.swap",
        "Swap Inputs",
        lambda e: e.session.swap_inputs(e.session.active),
        "Graph",
        "Alt+S",
        "graph",
        _node,
        contexts=frozenset({"node"}),
    ),
    Action(
        "node.replace",
        "Replace...",
        _replace,
        "Graph",
        "Shift+S",
        "graph",
        _node,
        contexts=frozenset({"node"}),
        doc="Another type of node in its place; links stay where they fit.",
    ),
    Action(
        "node.reset",
        "Reset Values",
        lambda e: e.session.reset_all(e.session.active),
        "Graph",
        enabled=_node,
        contexts=frozenset({"node"}),
    ),
    Action(
        "node.rename",
        "Rename...",
        _rename,
        "Graph",
        "F2",
        "graph",
        lambda e: bool(e.session.active),
        contexts=frozenset({"node"}),
    ),
    Action(
        "link.cut",
        "Cut Links",
        _tool("cut"),
        "Graph",
        scope="graph",
        contexts=frozenset({"canvas"}),
        doc="Drag a line across links; Ctrl and the right button do it at any time.",
        separated=True,
    ),
    Action(
        "link.dots",
        "Put Dots on Links",
        _tool("dot"),
        "Graph",
        scope="graph",
        contexts=frozenset({"canvas"}),
        doc="Drag a line across links; Shift and the right button do it at any time.",
    ),
    Action(
        "group.make",
        "Group",
        lambda e: e.session.make_group(),
        "Graph",
        "Ctrl+G",
        "graph",
        _some,
        contexts=frozenset({"node"}),
        separated=True,
    ),
    Action(
        "group.ungroup",
        "Ungroup",
        lambda e: e.session.ungroup(e.session.active),
        "Graph",
        "Ctrl+Shift+G",
        "graph",
        _group,
        contexts=frozenset({"node"}),
    ),
    Action(
        "group.enter",
        "Enter Group",
        lambda e: e.session.enter(e.session.active),
        "Graph",
        "Ctrl+Enter",
        "graph",
        _group,
        contexts=frozenset({"node"}),
    ),
    Action(
        "group.leave",
        "Leave Group",
        lambda e: e.session.leave(),
        "Graph",
        "Ctrl+Backspace",
        "graph",
        lambda e: bool(e.session.place),
        contexts=frozenset({"canvas"}),
    ),
    Action(
        "group.save",
        "Save Group As...",
        _save_group,
        "Graph",
        enabled=_group,
        contexts=frozenset({"group"}),
        doc="Write the group to a file of its own, for use in other graphs; from now on it comes from there.",
    ),
    Action(
        "group.local",
        "Make Group Local",
        lambda e: e.session.make_local(e.session.active),
        "Graph",
        enabled=_borrowed_group,
        contexts=frozenset({"group"}),
        doc="Keep the group in this graph, so that it can be changed here.",
    ),
    Action(
        "group.open", "Open Group's File", _open_group, "Graph", enabled=_borrowed_group, contexts=frozenset({"group"})
    ),
    Action(
        "frame.add",
        "Frame",
        _frame,
        "Graph",
        "Shift+F",
        "graph",
        contexts=frozenset({"node", "canvas"}),
        separated=True,
    ),
    Action(
        "comment.add",
        "Comment",
        lambda e: e.session.add_comment(e.canvas.pointer, ""),
        "Graph",
        "Shift+C",
        "graph",
        contexts=frozenset({"canvas"}),
    ),
    Action(
        "layout.arrange",
        "Arrange",
        lambda e: e.session.arrange(with_room(e)),
        "Graph",
        "L",
        "graph",
        contexts=frozenset({"canvas"}),
        doc="Lay out the selection, or everything, from left to right.",
        separated=True,
    ),
    *(_align(side, label) for side, label in _SIDES),
    Action(
        "view.fit_all", "Fit All", lambda e: e.canvas.fit(), "Graph", "Home", "graph", contexts=frozenset({"canvas"})
    ),
    Action("view.fit_selection", "Fit Selection", lambda e: e.canvas.fit(e.session.selection), "Graph", "F", "graph"),
)
