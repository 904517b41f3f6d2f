"""The one way to change a document: `apply(command)`, which adds a step to the history.

Everything else here changes only what is not part of the document: the group that the user is in (`place`), the
selection, and the files that are bound to inputs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypeVar

from ...errors import GraphError
from ...graph import INPUTS, Graph
from ...language.translation import translate
from ..commands.command import EditCommand, Edited
from ..edits import elements, folding, layout, routes
from ..edits.element_id import NO_ELEMENT, ElementId
from ..edits.folding import GroupPath
from ..edits.selection import SelectMode, combine_selection
from ..state.history import History, HistoryStep, Snapshot
from ..state.open_document import OpenDocument

T = TypeVar("T")


class UndoableDocument(OpenDocument):
    """An open document that commands change, step by step.

    Whatever makes no sense raises HalationError with one sentence and changes nothing.
    """

    # --- changes of the document -------------------------------------------------------------------------------------

    def apply(self, command: EditCommand[T]) -> T:
        """Apply a command as one step of the history; returns its outcome, such as the id of a new node."""
        edited = command.apply(self)
        shown = self.views.find_port() if edited.follows else None
        if edited.renamed is not None:
            self._follow_rename(*edited.renamed)
        if edited.root is not None:
            if edited.root != self.root:
                self._add_step(edited.label, self._show_root(edited.root), edited.merge)
        elif edited.graph is not None:
            self._apply_graph(edited, edited.graph)
        if edited.view is not None:
            self.views.show(edited.view)
        if shown is not None and shown in edited.follows:
            self.views.follow(edited.follows[shown])
        return edited.outcome

    def undo(self) -> None:
        """Undo the last step."""
        self.go_to(self.history.position - 1)

    def redo(self) -> None:
        """Redo the step that was undone last."""
        self.go_to(self.history.position + 1)

    def go_to(self, position: int) -> None:
        """Undo or redo until the first `position` steps are done."""
        self.seal()
        snapshot = self.history.go_to(position)
        if snapshot is not None:
            self._move_to(snapshot)

    def seal(self) -> None:
        """End merging: the next edit is a step of its own."""
        self.history.seal()

    def abandon(self, merge: str) -> None:
        """Undo an unfinished step and drop it from the history, as when a drag is cancelled."""
        before = self.history.abandon(merge)
        if before is not None:
            self._move_to(before)

    # --- where the user is, and what is seen -------------------------------------------------------------------------

    def select(self, elements: ElementId | Iterable[ElementId], mode: SelectMode = "replace") -> None:
        """Select elements, or change what is selected by them; unknown ones are left out."""
        self.seal()
        picked = [elements] if isinstance(elements, ElementId) else list(elements)
        self._select(*combine_selection(self.selection, self.active, picked, mode))

    def enter(self, id: str) -> None:
        """Show what is in a group."""
        folding.find_group(self.graph, id)
        self.go((*self.place, id))

    def leave(self, levels: int = 1) -> None:
        """Show the graph that the group is in, with the group selected."""
        self.go(self.place[: max(len(self.place) - levels, 0)])

    def go(self, place: GroupPath) -> None:
        """Show the graph at `place`. Raises GraphError if there is none."""
        folding.body_at(self.root, place)
        if place == self.place:
            return
        self.seal()
        group = ElementId(self.place[len(place)] if self.place[: len(place)] == place else "")
        self._move_to(Snapshot(self.root, place, frozenset({group} if group else ()), group))

    def bind(self, name: str, path: str | None) -> None:
        """Bind an input of the document to a file (`path` or `path:layer`), or to none; this is not saved."""
        if name not in self.root.inputs:
            raise GraphError(translate("the graph has no input '{name}' to bind a file to", name=name))
        self._bound.pop(name, None)
        if path:
            self._bound[name] = path
        self.revision += 1

    # --- another document --------------------------------------------------------------------------------------------

    def restart(self, root: Graph, path: Path | None = None, saved: Graph | None = None, title: str = "") -> None:
        """Open another document, which has no history. `files` knows where documents come from."""
        self.path, self.saved, self._title, self._bound = path, saved, title, {}
        self.history = History()
        self._memo.clear()
        self.time.reset()
        self.views.reset()
        self._move_to(Snapshot(root))

    def migrate(self, change: Callable[[Graph], Graph]) -> None:
        """Change the document, its whole history and the saved state in the same way; this is no undo step."""
        changed: dict[int, Graph] = {}

        def change_once(graph: Graph) -> Graph:
            if id(graph) not in changed:
                changed[id(graph)] = change(graph)
            return changed[id(graph)]

        root = change_once(self.root)
        saved = None if self.saved is None else change_once(self.saved)
        self.history.map_documents(change_once)
        self.saved = saved
        self._move_to(self._show_root(root))

    # --- inside ------------------------------------------------------------------------------------------------------

    def _apply_graph(self, edited: Edited[T], graph: Graph) -> None:
        """Replace the current graph as one step; if it is equal, only change the selection."""
        if graph == self.graph:
            if edited.select is not None:
                self._select(edited.select, self.active)
            return
        graph = layout.pin_places(routes.tidy_routes(graph), self.graph)
        root = folding.put_body(self.root, self.place, graph, edited.moves)
        folding.check_depth(root)
        keys = set(elements.list_elements(graph))
        chosen = [key for key in (self.selection if edited.select is None else edited.select) if key in keys]
        last = chosen[-1] if chosen else NO_ELEMENT
        active = last if edited.select is not None else self.active if self.active in keys else NO_ELEMENT
        self._add_step(edited.label, Snapshot(root, self.place, frozenset(chosen), active), edited.merge)

    def _add_step(self, label: str, after: Snapshot, merge: str = "") -> None:
        if not merge:
            self.seal()
        self.history.add(HistoryStep(label, self._snapshot, after, merge))
        self._move_to(after)

    def _move_to(self, snapshot: Snapshot) -> None:
        self._snapshot = snapshot
        self.revision += 1

    def _select(self, keys: Iterable[ElementId], active: ElementId) -> None:
        """Select elements that exist; the active one is `active` if it is among them, else the last."""
        existing = set(self.elements)
        chosen = [key for key in keys if key in existing]
        active = active if active in chosen else chosen[-1] if chosen else NO_ELEMENT
        if (frozenset(chosen), active) != (self.selection, self.active):
            self._move_to(Snapshot(self.root, self.place, frozenset(chosen), active))

    def _show_root(self, root: Graph) -> Snapshot:
        """Another document, shown as this one is, as far as it has the same groups and elements."""
        place = self.place
        while place and not folding.is_place(root, place):
            place = place[:-1]
        keys = set(elements.list_elements(folding.body_at(root, place))) if place == self.place else set()
        return Snapshot(root, place, self.selection & keys, self.active if self.active in keys else NO_ELEMENT)

    def _follow_rename(self, old: ElementId, new: ElementId) -> None:
        """Let views and bound files follow an element to its new name; the old one stays for when that is undone."""
        old_end, new_end = old.port, new.port
        if old_end and new_end and old_end.node == INPUTS and not self.place and old_end.socket in self._bound:
            self._bound[new_end.socket] = self._bound[old_end.socket]
        self.views.follow_rename(old, new)
