"""Actions on what is selected."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..shared.action import Action

if TYPE_CHECKING:
    from .context import EditContext


def _some(context: EditContext) -> bool:
    return bool(context.session.selection)


EDITS: tuple[Action, ...] = (
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
        lambda context: context.clipboard.put(context.session.cut_out()),
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
        lambda context: context.clipboard.put(context.session.copy()),
        "Edit",
        "Ctrl+C",
        "graph",
        _some,
        contexts=frozenset({"node"}),
    ),
    Action(
        "edit.paste",
        "Paste",
        lambda context: context.session.paste(context.clipboard.get(), context.canvas.pointer),
        "Edit",
        "Ctrl+V",
        "graph",
        contexts=frozenset({"canvas"}),
    ),
    Action(
        "edit.duplicate",
        "Duplicate",
        lambda context: context.session.duplicate(),
        "Edit",
        "Ctrl+D",
        "graph",
        _some,
        contexts=frozenset({"node"}),
    ),
    Action(
        "edit.delete",
        "Delete",
        lambda context: context.session.delete(),
        "Edit",
        "Delete",
        "graph",
        _some,
        contexts=frozenset({"node", "frame"}),
        doc="Remove what is selected; what fed it is linked to what it fed.",
    ),
    Action(
        "edit.delete_break",
        "Delete and Break Links",
        lambda context: context.session.delete(heal=False),
        "Edit",
        "Shift+Delete",
        "graph",
        _some,
    ),
    Action(
        "select.all",
        "Select All",
        lambda context: context.session.select_all(),
        "Edit/Select",
        "Ctrl+A",
        "graph",
        separated=True,
    ),
    Action(
        "select.none",
        "Select None",
        lambda context: context.session.select_none(),
        "Edit/Select",
        "Ctrl+Shift+A",
        "graph",
    ),
    Action(
        "select.invert",
        "Invert Selection",
        lambda context: context.session.select_inverse(),
        "Edit/Select",
        "Ctrl+I",
        "graph",
    ),
    Action(
        "select.upstream",
        "Select Upstream",
        lambda context: context.session.select_upstream(),
        "Edit/Select",
        "Shift+U",
        "graph",
        _some,
        contexts=frozenset({"node"}),
        doc="Everything that feeds what is selected.",
    ),
    Action(
        "select.downstream",
        "Select Downstream",
        lambda context: context.session.select_downstream(),
        "Edit/Select",
        "Shift+D",
        "graph",
        _some,
        contexts=frozenset({"node"}),
        doc="Everything that what is selected feeds.",
    ),
    Action(
        "select.linked",
        "Select Linked",
        lambda context: context.session.select_linked(),
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
