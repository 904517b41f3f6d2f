"""What the steps of a lesson ask about."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from msgspec import Struct

from ...graph import Graph, Group, Port, Unknown

if TYPE_CHECKING:
    from ...authoring.session import Session
    from ...graph import Item


class Moment(Struct, frozen=True):
    """What a step may ask about, at its beginning and now."""

    graph: Graph
    selected: frozenset[str]
    """The names of selected elements."""
    viewed: Port | None
    """What side A of the viewer shows."""
    frame: int
    step_count: int
    """How many steps of the history count: undo makes them fewer."""
    widgets: frozenset[str]
    """The widgets that were drawn, by name."""

    @classmethod
    def read(cls, session: Session, widgets: frozenset[str]) -> Moment:
        """The moment of the last frame."""
        return cls(
            session.graph,
            frozenset(element.name for element in session.selection),
            session.views.find_port("A"),
            session.time.frame,
            session.history.position,
            widgets,
        )

    def find_type(self, id: str) -> str:
        """The type of a node; "" if there is none of that name."""
        item: Item | None = self.graph.nodes.get(id)
        return "" if item is None or isinstance(item, Group | Unknown) else item.id

    def has(self, type: str) -> bool:
        """True if the graph has a node of a type."""
        return any(self.find_type(id) == type for id in self.graph.nodes)


Question = Callable[[Moment, Moment], bool]
"""Whether a step is done, by the moment in which it began and the present one."""
