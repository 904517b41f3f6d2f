"""What a command is: one thing that a user can do to a document, as a frozen value.

There is one way to change a document: `session.apply(command)`. A command knows what the user asked for, such as
`Connect(source, target)`, not how the document is stored. Its `apply` reads the open document and returns an `Edited`:
the new graph, the label of the step in the history, what is selected afterwards. It changes nothing itself, so it
needs no window, can be tested on random graphs, and cannot leave a document half changed: an invalid command raises
HalationError before anything happens.

The session turns an `Edited` into a step of the history. During a drag the editor applies one command per frame; they
carry the same `merge` token, and the history joins them into one step that goes back to where the drag began.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from types import MappingProxyType
from typing import Generic, TypeVar

from msgspec import Struct

from ...errors import GraphError
from ...graph import Graph, Port
from ...language.translation import translate_plural
from ..edits.element_id import ElementId
from ..edits.folding import Moves
from ..state.open_document import OpenDocument

T = TypeVar("T")


class Edited(Struct, Generic[T], frozen=True):
    """The document after a command, and the `outcome` for its caller, such as the id of a new node.

    `graph` takes the place of the graph that the user sees; `root`, if given, that of the whole document. `select` are
    the elements selected afterwards, by default those that are left. Steps with the same `merge` token become one.
    """

    label: str
    outcome: T
    graph: Graph | None = None
    select: Iterable[ElementId] | None = None
    merge: str = ""
    root: Graph | None = None
    moves: Moves | None = None
    """Ends and controls that got another name, which matters to the graph around a group."""
    renamed: tuple[ElementId, ElementId] | None = None
    """The old and the new name of an element: what the viewer shows and the files bound to inputs follow it."""
    view: Port | None = None
    """The port that the viewer shows afterwards."""
    follows: Mapping[Port, Port] = MappingProxyType({})
    """What the viewer shows in the place of some ports: what was made behind them, or of them."""


class EditCommand(Struct, Generic[T], frozen=True):
    """One thing that a user can do to a document. `T` is what the caller gets back."""

    def apply(self, document: OpenDocument) -> Edited[T]:
        """The document after the command. Raises HalationError with one sentence if the command is invalid."""
        raise NotImplementedError


def require_selection(document: OpenDocument, fault: str) -> frozenset[ElementId]:
    """The selected elements. Raises GraphError with that sentence if there are none."""
    if not document.selection:
        raise GraphError(fault)
    return document.selection


def require_nodes(document: OpenDocument, fault: str) -> tuple[ElementId, ...]:
    """The selected nodes, in the order of the graph. Raises GraphError with that sentence if there are none."""
    nodes = tuple(id for id in map(ElementId, document.graph.nodes) if id in document.selection)
    if not nodes:
        raise GraphError(fault)
    return nodes


def count_links(targets: Collection[Port]) -> str:
    """The number of links, for the label of a step: `1 link`, `3 links`."""
    return translate_plural("{count} link", "{count} links", len(set(targets)))
