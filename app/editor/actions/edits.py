"""Actions on the selection."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...authoring.commands import CutSelection, DeleteSelection, DuplicateSelection, PasteText
from ...authoring.edits.clipboard import copy_elements
from ...authoring.edits.selection import find_downstream, find_linked, find_upstream, invert_selection
from ..shared.action import Action

if TYPE_CHECKING:
    from .context import EditContext


def _some(context: EditContext) -> bool:
    return bool(context.session.selection)


EDITS: tuple[Action[EditContext], ...] = (
    Action(
        "edit.undo",
        "Undo",
        lambda context: context.session.undo(),
        "Edit",
        "Ctrl+Z",
        enabled=lambda context: context.session.history.can_undo,
        repeats=True,
    ),
    Action(
        "edit.redo",
        "Redo",
        lambda context: context.session.redo(),
        "Edit",
        "Ctrl+Shift+Z",
        enabled=lambda context: context.session.history.can_redo,
        repeats=True,
    ),
    Action(
        "edit.cut",
        "Cut",
        lambda context: context.clipboard.put(context.session.apply(CutSelection())),
        "Edit",
        "Ctrl+X",
        "graph",
        _some,
        contexts=frozenset({"node"}),
        separated=True,
    ),
    Action(
        "edit.copy",
        "Copy",
        lambda context: context.clipboard.put(copy_elements(context.session.graph, context.session.selection)),
        "Edit",
        "Ctrl+C",
        "graph",
        _some,
        contexts=frozenset({"node"}),
    ),
    Action(
        "edit.paste",
        "Paste",
        lambda context: context.session.apply(PasteText(context.clipboard.get(), context.canvas.pointer)),
        "Edit",
        "Ctrl+V",
        "graph",
        contexts=frozenset({"canvas"}),
    ),
    Action(
        "edit.duplicate",
        "Duplicate",
        lambda context: context.session.apply(DuplicateSelection()),
        "Edit",
        "Ctrl+D",
        "graph",
        _some,
        contexts=frozenset({"node"}),
    ),
    Action(
        "edit.delete",
        "Delete",
        lambda context: context.session.apply(DeleteSelection()),
        "Edit",
        "Delete",
        "graph",
        _some,
        contexts=frozenset({"node", "frame"}),
        doc="Delete the selection, and link the nodes before and after it.",
    ),
    Action(
        "edit.delete_break",
        "Delete and Break Links",
        lambda context: context.session.apply(DeleteSelection(heal=False)),
        "Edit",
        "Shift+Delete",
        "graph",
        _some,
    ),
    Action(
        "select.all",
        "Select All",
        lambda context: context.session.select(context.session.elements, "extend"),
        "Edit/Select",
        "Ctrl+A",
        "graph",
        separated=True,
    ),
    Action(
        "select.none",
        "Select None",
        lambda context: context.session.select(()),
        "Edit/Select",
        "Ctrl+Shift+A",
        "graph",
    ),
    Action(
        "select.invert",
        "Invert Selection",
        lambda context: context.session.select(invert_selection(context.session.elements, context.session.selection)),
        "Edit/Select",
        "Ctrl+I",
        "graph",
    ),
    Action(
        "select.upstream",
        "Select Upstream",
        lambda context: context.session.select(
            find_upstream(context.session.graph, context.session.selection), "extend"
        ),
        "Edit/Select",
        "Shift+U",
        "graph",
        _some,
        contexts=frozenset({"node"}),
        doc="Select everything that the selection depends on.",
    ),
    Action(
        "select.downstream",
        "Select Downstream",
        lambda context: context.session.select(
            find_downstream(context.session.graph, context.session.selection), "extend"
        ),
        "Edit/Select",
        "Shift+D",
        "graph",
        _some,
        contexts=frozenset({"node"}),
        doc="Select everything that depends on the selection.",
    ),
    Action(
        "select.linked",
        "Select Linked",
        lambda context: context.session.select(find_linked(context.session.graph, context.session.selection), "extend"),
        "Edit/Select",
        "Shift+L",
        "graph",
        _some,
    ),
    Action(
        "edit.preferences",
        "Preferences...",
        lambda context: context.dialogs.open.add("preferences"),
        "Edit",
        "Ctrl+Comma",
        separated=True,
    ),
)
