"""The state of a session, and how an edit becomes a step of its history."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from halation.nodes import Node, catalogue

from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Group, Problem
from ...lint.live import find_remarks, recheck_remarks
from ..edits import elements, folding, layout, routes
from ..edits.elements import Place
from ..state.history import History, HistoryStep, Snapshot

T = TypeVar("T")


class State:
    """A document, where in it someone is, what is selected, and what can be undone.

    `types` are the node types by id, by default all that are installed.
    """

    def __init__(self, types: Mapping[str, type[Node]] | None = None) -> None:
        self._types = types
        self.history = History()
        self.path: Path | None = None
        self._title = ""
        self.revision = 0
        self._now = Snapshot(Graph())
        self._saved: Graph | None = self._now.root
        self._bound: dict[str, str] = {}
        self._cache: dict[str, tuple[tuple[object, ...], Any]] = {}
        self._offered: dict[Path, Group] = {}

    # --- questions -------------------------------------------------------------------------------------------------

    @property
    def types(self) -> Mapping[str, type[Node]]:
        """The node types that there are, by id."""
        return catalogue() if self._types is None else self._types

    @property
    def root(self) -> Graph:
        """The document."""
        return self._now.root

    @property
    def place(self) -> tuple[str, ...]:
        """The groups entered, outermost first."""
        return self._now.place

    @property
    def selection(self) -> frozenset[str]:
        """Keys of the selected elements."""
        return self._now.selection

    @property
    def active(self) -> str:
        """Key of the element selected last, or nothing."""
        return self._now.active

    @property
    def graph(self) -> Graph:
        """The graph at `place`, with the values that groups set; every element of it has a place on the canvas."""
        made, before = (self.root, self.place), self._cache.get("graph", ((), None))[1]
        return self._kept("graph", made, lambda: layout.pin_places(folding.body_at(*made), before))

    @property
    def positions(self) -> Mapping[str, Place]:
        """Where every element of `graph` lies."""
        return self._kept("positions", (self.graph.ui, self.elements), lambda: layout.positions(self.graph))

    @property
    def elements(self) -> tuple[str, ...]:
        """Keys of all elements of `graph`."""
        return self._kept("elements", (self.graph,), self._elements)

    @property
    def folder(self) -> Path:
        """Where relative paths of the document start."""
        return Path(self.root.folder)

    @property
    def name(self) -> str:
        """What the document is called."""
        return self.path.stem if self.path else self._title or "untitled"

    @property
    def dirty(self) -> bool:
        """True if the document differs from what was saved."""
        same = self.root is self._saved
        return not same and self._kept("dirty", (self.root, self._saved), lambda: self.root != self._saved)

    @property
    def all_problems(self) -> tuple[Problem, ...]:
        """Everything that is wrong with the document, groups included."""
        return self._checked("all problems", self.root)

    @property
    def problems(self) -> Mapping[str, tuple[Problem, ...]]:
        """What is wrong with `graph`, by element; what belongs to none is under ""."""
        found = self._checked("problems", self.graph) if self.place else self.all_problems
        return self._kept("problems by element", (found, self.elements), lambda: _by_element(found, self.elements))

    @property
    def bindings(self) -> Mapping[str, str]:
        """Files that inputs of the document are bound to; they are not saved."""
        return {name: file for name, file in self._bound.items() if name in self.root.inputs}

    # --- changes ---------------------------------------------------------------------------------------------------

    def bind(self, name: str, path: str | None) -> None:
        """Bind an input of the document to a file (`path` or `path:layer`), or not to any."""
        if name not in self.root.inputs:
            raise GraphError(f"the graph has no input '{name}' to bind a file to")
        self._bound.pop(name, None)
        if path:
            self._bound[name] = path
        self._touch()

    def edit(
        self,
        label: str,
        graph: Graph,
        select: Iterable[str] | None = None,
        merge: str = "",
        moves: folding.Moves | None = None,
    ) -> None:
        """Put `graph` where `self.graph` is, as one step.

        `select` are the elements selected afterwards; by default those that are left. Steps with the same `merge`
        become one. `moves` are ends and controls that got another name, which matters outside a group.
        """
        if graph == self.graph:
            if select is not None:
                self._select(select, self.active)
            return
        graph = layout.pin_places(routes.tidy_routes(graph), self.graph)
        root = folding.put_body(self.root, self.place, graph, moves)
        folding.check_depth(root)
        known = set(elements.list_elements(graph))
        chosen = [key for key in (self.selection if select is None else select) if key in known]
        last = chosen[-1] if chosen else ""
        active = last if select is not None else self.active if self.active in known else ""
        self._step(label, Snapshot(root, self.place, frozenset(chosen), active), merge)

    def seal(self) -> None:
        """End merging: the next edit is a step of its own."""
        self.history.seal()

    def abandon(self, merge: str) -> None:
        """Take an unfinished step back as if it had never been, as when a drag is cancelled."""
        before = self.history.abandon(merge)
        if before is not None:
            self._set(before)

    def undo(self) -> None:
        """Take the last step back."""
        self.go_to(self.history.position - 1)

    def redo(self) -> None:
        """Do again what was undone last."""
        self.go_to(self.history.position + 1)

    def go_to(self, position: int) -> None:
        """Take steps back or do them again until `position` of them are in force."""
        self.seal()
        found = self.history.go_to(position)
        if found is not None:
            self._set(found)

    # --- inside ----------------------------------------------------------------------------------------------------

    def _step(self, label: str, after: Snapshot, merge: str = "") -> None:
        if merge == "":
            self.seal()
        self.history.add(HistoryStep(label, self._now, after, merge))
        self._set(after)

    def _set(self, now: Snapshot) -> None:
        self._now = now
        self._touch()

    def _select(self, some: Iterable[str], active: str = "") -> None:
        """Select elements that exist; the active one is `active` if it is among them, else the last."""
        known = set(self.elements)
        chosen = [key for key in some if key in known]
        now = active if active in chosen else chosen[-1] if chosen else ""
        if (frozenset(chosen), now) != (self.selection, self.active):
            self._set(Snapshot(self.root, self.place, frozenset(chosen), now))

    def _restart(self, root: Graph, path: Path | None, saved: Graph | None) -> None:
        """Another document, with no past."""
        self.history = History()
        self.path, self._saved, self._title = path, saved, ""
        self._bound, self._cache = {}, {}
        self._set(Snapshot(root))

    def _transform(self, edit: Callable[[Graph], Graph]) -> None:
        """Apply what nobody did, so that it is no step, to the document, its past, its future and what was saved."""
        done: dict[int, Graph] = {}

        def once(graph: Graph) -> Graph:
            if id(graph) not in done:
                done[id(graph)] = edit(graph)
            return done[id(graph)]

        root = once(self.root)
        saved = None if self._saved is None else once(self._saved)
        self.history.map_documents(once)
        self._saved = saved
        self._arrive(root)

    def _arrive(self, root: Graph) -> None:
        """Show another document where this one was shown, as far as it has the same groups and elements."""
        place = self.place
        while place and not folding.is_place(root, place):
            place = place[:-1]
        known = set(elements.list_elements(folding.body_at(root, place))) if place == self.place else set()
        self._set(Snapshot(root, place, self.selection & known, self.active if self.active in known else ""))

    def _touch(self) -> None:
        self.revision += 1

    def _kept(self, name: str, of: tuple[object, ...], make: Callable[[], T]) -> T:
        """What `make` returns, until one of the objects that it is made of is another one."""
        known, found = self._cache.get(name, ((), None))
        if len(known) != len(of) or any(a is not b for a, b in zip(known, of, strict=True)):
            found = make()
            self._cache[name] = (of, found)
        return found

    def _elements(self) -> tuple[str, ...]:
        """The same tuple as before where the keys are the same, so that what is made of it stays."""
        found, before = elements.list_elements(self.graph), self._cache.get("elements", ((), None))[1]
        return before if found == before else found

    def _checked(self, name: str, graph: Graph) -> tuple[Problem, ...]:
        """The problems of a graph, starting from those that were found last under that name."""
        (before, types), found = self._cache.get(name, ((None, None), ()))
        return self._kept(
            name,
            (graph, self.types),
            lambda: (
                recheck_remarks(graph, before, found, self.types)
                if isinstance(before, Graph) and types is self.types
                else find_remarks(graph, self.types)
            ),
        )

    def _ordered_selection(self) -> list[str]:
        """What is selected, the active element last."""
        return [*sorted(self.selection - {self.active}), *([self.active] if self.active else [])]

    def _read_anew(self) -> None:
        """Called when the document was read from its file again."""

    def _renamed(self, old: str, new: str) -> None:
        """Called before an element gets another key."""

    def _chosen_nodes(self) -> tuple[str, ...]:
        """Ids of the selected nodes, in the order of the graph."""
        return tuple(id for id in self.graph.nodes if id in self.selection)


def _by_element(found: tuple[Problem, ...], known: tuple[str, ...]) -> Mapping[str, tuple[Problem, ...]]:
    """Problems by the key of the element that shows them, in the order in which they were found."""
    by_key: dict[str, tuple[Problem, ...]] = {}
    for problem in found:
        node = problem.node.partition("/")[0]
        key = f"{node}.{problem.socket}" if node in (INPUTS, OUTPUTS) else node
        key = key if key in known else ""
        by_key[key] = (*by_key.get(key, ()), problem)
    return by_key
