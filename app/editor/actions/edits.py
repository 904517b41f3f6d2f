"""Actions on what is selected."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..shared.action import Action

if TYPE_CHECKING:
    from ..window.editor import Editor


def _some(editor: Editor) -> bool:
    return bool(editor.session.selection)


EDITS: tuple[Action, ...] = (
    Action(
        "edit.undo",
        "Undo",
        lambda e: e.session.undo(),
        "Edit",
        "Ctrl+Z",
        enabled=lambda e: e.session.history.can_undo,
        repeats=True,
    ),
    Action(
        "edit.redo",
        "Redo",
        lambda e: e.session.redo(),
        "Edit",
        "Ctrl+Shift+Z",
        enabled=lambda e: e.session.history.can_redo,
        repeats=True,
    ),
    Action(
        "edit.cut",
        "Cut",
        lambda e: e.clipboard.put(e.session.cut_out()),
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
        lambda e: e.clipboard.put(e.session.copy()),
        "Edit",
        "Ctrl+C",
        "graph",
        _some,
        contexts=frozenset({"node"}),
    ),
    Action(
        "edit.paste",
        "Paste",
        lambda e: e.session.paste(e.clipboard.get(), e.canvas.pointer),
        "Edit",
        "Ctrl+V",
        "graph",
        contexts=frozenset({"canvas"}),
    ),
    Action(
        "edit.duplicate",
        "Duplicate",
        lambda e: e.session.duplicate(),
        "Edit",
        "Ctrl+D",
        "graph",
        _some,
        contexts=frozenset({"node"}),
    ),
    Action(
        "edit.delete",
        "Delete",
        lambda e: e.session.delete(),
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
        lambda e: e.session.delete(heal=False),
        "Edit",
        "Shift+Delete",
        "graph",
        _some,
    ),
    Action(
        "select.all", "Select All", lambda e: e.session.select_all(), "Edit/Select", "Ctrl+A", "graph", separated=True
    ),
    Action("select.none", "Select None", lambda e: e.session.select_none(), "Edit/Select", "Ctrl+Shift+A", "graph"),
    Action("select.invert", "Invert Selection", lambda e: e.session.select_inverse(), "Edit/Select", "Ctrl+I", "graph"),
    Action(
        "select.upstream",
        "Select Upstream",
        lambda e: e.session.select_upstream(),
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
        lambda e: e.session.select_downstream(),
        "Edit/Select",
        "Shift+D",
        "graph",
        _some,
        contexts=frozenset({"node"}),
        doc="Everything that what is selected feeds.",
    ),
    Action(
        "select.linked", "Select Linked", lambda e: e.session.select_linked(), "Edit/Select", "Shift+L", "graph", _some
    ),
    Action(
        "edit.preferences",
        "Preferences...",
        lambda e: e.dialogs.open.add("preferences"),
        "Edit",
        "Ctrl+Comma",
        separated=True,
    ),
)
