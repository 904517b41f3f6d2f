"""Actions of the graph canvas: nodes, links, groups, frames and layout."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from ...authoring.commands import (
    AddComment,
    AddFrame,
    AlignSelection,
    ArrangeElements,
    ExtractSelection,
    MakeGroup,
    MakeGroupLocal,
    ResetNode,
    SwapInputs,
    ToggleCollapse,
    ToggleMute,
    Ungroup,
)
from ...authoring.edits.elements import can_be_linked
from ...graph import Group
from ...language.translation import translate
from ..shared.action import Action
from ..shared.dialogs import Browse
from .pictures import reserve_pictures
from .view import Tool

if TYPE_CHECKING:
    from .context import CanvasContext

_ALIGNMENTS = (
    ("left", "Left"),
    ("right", "Right"),
    ("top", "Top"),
    ("bottom", "Bottom"),
    ("center x", "Horizontal Centers"),
    ("center y", "Vertical Centers"),
    ("distribute x", "Distribute Horizontally"),
    ("distribute y", "Distribute Vertically"),
)


def _has_selection(context: CanvasContext) -> bool:
    return bool(context.session.selection)


def _has_several(context: CanvasContext) -> bool:
    return len(context.session.selection) > 1


def _is_node(context: CanvasContext) -> bool:
    return context.session.active in context.session.graph.nodes


def _is_viewable(context: CanvasContext) -> bool:
    """True for a node, and for an input or output of the graph."""
    active = context.session.active
    return active in context.session.graph.nodes or active.port is not None


def _is_group(context: CanvasContext) -> bool:
    return isinstance(context.session.graph.nodes.get(context.session.active), Group)


def _is_borrowed_group(context: CanvasContext) -> bool:
    item = context.session.graph.nodes.get(context.session.active)
    return isinstance(item, Group) and bool(item.path)


def _save_group(context: CanvasContext) -> None:
    """Ask for a file, save the group in it, and link the group to it."""
    id = context.session.active

    def save(path: Path) -> None:
        context.log.attempt(lambda: context.session.files.save_group(id, path.with_suffix(".json"), link=True))

    context.dialogs.browse = Browse(translate("Save the group as"), "graph", save, saving=True, name=f"{id}.json")


def _open_group(context: CanvasContext) -> None:
    item = context.session.graph.nodes[context.session.active]
    assert isinstance(item, Group)
    context.documents.open_graph(Path(context.session.graph.folder, item.path))


def _replace(context: CanvasContext) -> None:
    context.canvas.replacing = context.session.active


def _open_search(context: CanvasContext) -> None:
    context.canvas.searching = True


def _add_frame(context: CanvasContext) -> None:
    at = None if context.session.selection else context.canvas.pointer
    context.session.apply(AddFrame(at=at, sizes=context.canvas.sizes))


def _rename(context: CanvasContext) -> None:
    context.canvas.renaming = context.session.active


def _make_tool_act(tool: Tool) -> Callable[[CanvasContext], object]:
    def set_tool(context: CanvasContext) -> None:
        context.canvas.tool = tool

    return set_tool


def _arrange(context: CanvasContext) -> None:
    """Lay out the selection and bring it into view, or lay everything out and show all of it."""
    session = context.session
    session.apply(ArrangeElements(reserve_pictures(context), context.canvas.find_pins()))
    arranged = [element for element in session.selection if can_be_linked(element, session.graph)]
    if len(arranged) > 1:
        context.canvas.reveal(arranged)
    else:
        context.canvas.fit()


def _make_align_action(side: str, label: str) -> Action[CanvasContext]:
    return Action(
        f"align.{side.replace(' ', '_')}",
        label,
        lambda context: context.session.apply(AlignSelection(side, context.canvas.sizes or {})),
        "Graph/Align",
        scope="graph",
        enabled=_has_several,
    )


GRAPH: tuple[Action[CanvasContext], ...] = (
    Action("node.add", "Add Node...", _open_search, "Graph", "Tab", "graph", contexts=frozenset({"canvas"})),
    Action(
        "node.mute",
        "Mute",
        lambda context: context.session.apply(ToggleMute()),
        "Graph",
        "M",
        "graph",
        _has_selection,
        contexts=frozenset({"node"}),
        doc="A muted node passes its first input through.",
        separated=True,
    ),
    Action(
        "node.collapse",
        "Collapse",
        lambda context: context.session.apply(ToggleCollapse()),
        "Graph",
        "H",
        "graph",
        _has_selection,
        contexts=frozenset({"node"}),
    ),
    Action(
        "node.view",
        "View",
        lambda context: context.session.views.show_element(context.session.active),
        "Graph",
        "V",
        "graph",
        _is_viewable,
        contexts=frozenset({"node"}),
        doc="Show this node in the viewer. Again: its next output.",
    ),
    Action(
        "node.view_b",
        "View as B",
        lambda context: context.session.views.show_element(context.session.active, "B"),
        "Graph",
        "Shift+V",
        "graph",
        _is_viewable,
        contexts=frozenset({"node"}),
        doc="Show this node on side B, to compare with it.",
    ),
    Action(
        "node.extract",
        "Extract from Chain",
        lambda context: context.session.apply(ExtractSelection()),
        "Graph",
        "Alt+X",
        "graph",
        _has_selection,
        contexts=frozenset({"node"}),
        doc="Take the selection out of its chain, and link the nodes before and after it.",
    ),
    Action(
        "node.swap",
        "Swap Inputs",
        lambda context: context.session.apply(SwapInputs(context.session.active)),
        "Graph",
        "Alt+S",
        "graph",
        _is_node,
        contexts=frozenset({"node"}),
    ),
    Action(
        "node.replace",
        "Replace...",
        _replace,
        "Graph",
        "Shift+S",
        "graph",
        _is_node,
        contexts=frozenset({"node"}),
        doc="Replace the node by one of another type; links stay where they fit.",
    ),
    Action(
        "node.reset",
        "Reset Values",
        lambda context: context.session.apply(ResetNode(context.session.active)),
        "Graph",
        enabled=_is_node,
        contexts=frozenset({"node"}),
    ),
    Action(
        "node.rename",
        "Rename...",
        _rename,
        "Graph",
        "F2",
        "graph",
        lambda context: bool(context.session.active),
        contexts=frozenset({"node"}),
    ),
    Action(
        "link.cut",
        "Cut Links",
        _make_tool_act("cut"),
        "Graph",
        scope="graph",
        contexts=frozenset({"canvas"}),
        doc="Drag a line across links to cut them, or Ctrl+right drag at any time.",
        separated=True,
    ),
    Action(
        "link.dots",
        "Put Dots on Links",
        _make_tool_act("dot"),
        "Graph",
        scope="graph",
        contexts=frozenset({"canvas"}),
        doc="Drag a line across links to put dots on them, or Shift+right drag at any time.",
    ),
    Action(
        "group.make",
        "Group",
        lambda context: context.session.apply(MakeGroup()),
        "Graph",
        "Ctrl+G",
        "graph",
        _has_selection,
        contexts=frozenset({"node"}),
        separated=True,
    ),
    Action(
        "group.ungroup",
        "Ungroup",
        lambda context: context.session.apply(Ungroup(context.session.active)),
        "Graph",
        "Ctrl+Shift+G",
        "graph",
        _is_group,
        contexts=frozenset({"node"}),
    ),
    Action(
        "group.enter",
        "Enter Group",
        lambda context: context.session.enter(context.session.active),
        "Graph",
        "Ctrl+Enter",
        "graph",
        _is_group,
        contexts=frozenset({"node"}),
    ),
    Action(
        "group.leave",
        "Leave Group",
        lambda context: context.session.leave(),
        "Graph",
        "Ctrl+Backspace",
        "graph",
        lambda context: bool(context.session.place),
        contexts=frozenset({"canvas"}),
    ),
    Action(
        "group.save",
        "Save Group As...",
        _save_group,
        "Graph",
        enabled=_is_group,
        contexts=frozenset({"group"}),
        doc="Save the group to its own file, for use in other graphs, and link it to that file.",
    ),
    Action(
        "group.local",
        "Make Group Local",
        lambda context: context.session.apply(MakeGroupLocal(context.session.active)),
        "Graph",
        enabled=_is_borrowed_group,
        contexts=frozenset({"group"}),
        doc="Copy the group into this graph, so that it can be edited here.",
    ),
    Action(
        "group.open",
        "Open Group File",
        _open_group,
        "Graph",
        enabled=_is_borrowed_group,
        contexts=frozenset({"group"}),
    ),
    Action(
        "frame.add",
        "Frame",
        _add_frame,
        "Graph",
        "Shift+F",
        "graph",
        contexts=frozenset({"node", "canvas"}),
        separated=True,
    ),
    Action(
        "comment.add",
        "Comment",
        lambda context: context.session.apply(AddComment(context.canvas.pointer, "")),
        "Graph",
        "Shift+C",
        "graph",
        contexts=frozenset({"canvas"}),
    ),
    Action(
        "layout.arrange",
        "Arrange",
        _arrange,
        "Graph",
        "L",
        "graph",
        contexts=frozenset({"canvas"}),
        doc="Lay out the selection, or everything, from left to right.",
        separated=True,
    ),
    *(_make_align_action(side, label) for side, label in _ALIGNMENTS),
    Action(
        "view.fit_all",
        "Fit All",
        lambda context: context.canvas.fit(),
        "Graph",
        "Home",
        "graph",
        contexts=frozenset({"canvas"}),
    ),
    Action(
        "view.fit_selection",
        "Fit Selection",
        lambda context: context.canvas.fit(context.session.selection),
        "Graph",
        "F",
        "graph",
    ),
)
