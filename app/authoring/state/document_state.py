"""What is open: the document, where in it the user is, what is selected, and what follows from that.

Answers are computed once per graph, so panels may ask in every frame of the window.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from halation.nodes import Node, catalogue

from ...errors import GraphError
from ...graph import Graph, Problem
from ...graph.rules import UNFED_OUTPUT
from ...language.translation import translate
from ...resources.sandbox import Sandbox
from ..edits import elements, folding, layout
from ..edits.element_id import ElementId
from ..edits.elements import Place, Places
from ..edits.folding import GroupPath
from .history import History, Snapshot
from .memo import Memo
from .problems import find_problems, sort_problems


class DocumentState:
    """A document, where in it the user is, what is selected, and what can be undone.

    `types` are the node types by id, by default all that are installed. `sandbox` says which files may be read and
    written.
    """

    def __init__(self, types: Mapping[str, type[Node]] | None = None, *, sandbox: Sandbox) -> None:
        self._types, self.sandbox = types, sandbox
        self._snapshot = Snapshot(Graph())
        self._title = ""
        self._bound: dict[str, str] = {}
        self._memo = Memo()
        self.revision = 0
        """Greater after every change of the document, the selection or the view."""
        self.path: Path | None = None
        """The file that the document is saved to; None for a new one."""
        self.saved: Graph | None = self._snapshot.root
        """The document as it was saved last; None if it never was."""
        self.history = History()

    # --- the document ------------------------------------------------------------------------------------------------

    @property
    def types(self) -> Mapping[str, type[Node]]:
        """The node types that there are, by id."""
        return catalogue() if self._types is None else self._types

    @property
    def root(self) -> Graph:
        """The whole document."""
        return self._snapshot.root

    @property
    def place(self) -> GroupPath:
        """The groups entered, outermost first."""
        return self._snapshot.place

    @property
    def selection(self) -> frozenset[ElementId]:
        """The selected elements."""
        return self._snapshot.selection

    @property
    def active(self) -> ElementId:
        """The element selected last; empty if there is none."""
        return self._snapshot.active

    @property
    def graph(self) -> Graph:
        """The graph at `place`, with the values that groups set; every element of it has a place on the canvas."""
        source, before = (self.root, self.place), self._memo.last("graph")[1]
        return self._memo.get("graph", source, lambda: layout.pin_places(folding.body_at(*source), before))

    @property
    def positions(self) -> Places:
        """Where every element of `graph` lies."""
        return self._memo.get("positions", (self.graph.ui, self.elements), lambda: layout.positions(self.graph))

    @property
    def elements(self) -> tuple[ElementId, ...]:
        """All elements of `graph`; the same object until they change."""
        return self._memo.get("elements", (self.graph,), self._list_elements)

    def position(self, element: ElementId) -> Place:
        """Where an element lies. Raises GraphError if there is none."""
        if element not in self.positions:
            raise GraphError(translate("there is no '{element}' on the canvas", element=element))
        return self.positions[element]

    @property
    def name(self) -> str:
        """What the document is called."""
        return self.path.stem if self.path else self._title or "untitled"

    @property
    def crumbs(self) -> tuple[tuple[str, GroupPath], ...]:
        """The way to where the user is: title and place of the document and of every group entered."""
        return ((self.name, ()), *((id, self.place[:depth]) for depth, id in enumerate(self.place, 1)))

    @property
    def borrowed(self) -> str:
        """The file that the graph at `place` belongs to, if it is not this document; it cannot be edited here."""
        borrowed = folding.find_borrowed_group(self.root, self.place)
        return borrowed[1] if borrowed else ""

    def check_editable(self) -> None:
        """Raise GraphError within a group that comes from another file."""
        if borrowed := folding.find_borrowed_group(self.root, self.place):
            group, file = borrowed[0][-1], borrowed[1]
            raise GraphError(
                translate(
                    "group '{group}' comes from the file '{file}': make it local first, or open that file",
                    group=group,
                    file=file,
                )
            )

    @property
    def dirty(self) -> bool:
        """True if the document differs from what was saved."""
        is_same = self.root is self.saved
        return not is_same and self._memo.get("dirty", (self.root, self.saved), lambda: self.root != self.saved)

    @property
    def problems(self) -> Mapping[ElementId, tuple[Problem, ...]]:
        """What is wrong with `graph`, by element; what belongs to none is under the empty id.

        That nothing feeds the output of a graph is no mistake before it has a node.
        """
        name, graph = ("problems of a group", self.graph) if self.place else ("problems", self.root)
        problems = find_problems(self._memo, name, graph, self.types)
        shown = problems if self.graph.nodes else tuple(one for one in problems if one.rule != UNFED_OUTPUT)
        return self._memo.get(
            "problems by element", (problems, self.elements), lambda: sort_problems(shown, self.elements)
        )

    @property
    def bindings(self) -> Mapping[str, str]:
        """Files that inputs of the document are bound to; they are not saved."""
        return {name: file for name, file in self._bound.items() if name in self.root.inputs}

    def _list_elements(self) -> tuple[ElementId, ...]:
        """The same tuple as before where the elements are the same, so that what is computed of it stays."""
        keys, before = elements.list_elements(self.graph), self._memo.last("elements")[1]
        return before if keys == before else keys
