"""What a lesson is: steps that are done when the document says so. Nothing here draws."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from ...graph import Graph, Group, Port, Unknown

if TYPE_CHECKING:
    from ...authoring.session import Session
    from ...graph import Item


@dataclass(frozen=True)
class Moment:
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


@dataclass(frozen=True)
class Step:
    """One step: what to do, the widget that it is about, and when it is done. Without a question the user goes on.

    `{node.add}` in the sentence stands for the shortcut of that action, `widget` may be a panel.
    """

    sentence: str
    widget: str
    is_done: Question | None = None


@dataclass(frozen=True)
class Lesson:
    """A lesson with its steps. It begins with a preset, or with the sample render."""

    id: str
    title: str
    doc: str
    start: Literal["soft_bloom", "sample"]
    steps: tuple[Step, ...]


def selects(id: str) -> Question:
    """Done when an element is selected."""
    return lambda _, now: id in now.selected


def adds(type: str) -> Question:
    """Done when the graph has a node of a type."""
    return lambda _, now: now.has(type)


def links(port: str) -> Question:
    """Done when something is linked to a port."""
    return lambda _, now: Port.parse(port) in now.graph.links


def changes(*ports: str) -> Question:
    """Done when one of some values is another one than at the beginning of the step."""

    def is_done(before: Moment, now: Moment) -> bool:
        return any(_find_value(before, port) != _find_value(now, port) for port in ports)

    return is_done


def shows(node: str, socket: str = "") -> Question:
    """Done when the viewer shows an output of a node."""
    return lambda _, now: now.viewed is not None and now.viewed.node == node and socket in ("", now.viewed.socket)


def draws(widget: str) -> Question:
    """Done when a widget is there, such as a panel."""
    return lambda _, now: widget in now.widgets


def undoes(before: Moment, now: Moment) -> bool:
    """Done when a step of the history is undone."""
    return now.step_count < before.step_count


def _find_value(moment: Moment, name: str) -> object:
    port = Port.parse(name)
    return moment.graph.value(port) if port.node in moment.graph.nodes else None
