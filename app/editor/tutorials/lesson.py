"""What a lesson is: steps that are done when the document says so. Nothing here draws."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from halation import presets
from msgspec import Struct

from ...graph import Graph, Port
from ..shared.window_commands import PanelTitle
from .conditions import GraphCondition
from .moment import Moment, Question

if TYPE_CHECKING:
    from ...authoring.commands import EditCommand


class Step(Struct, frozen=True):
    """One step: what to do, the widget that it is about, and when it is done. Without a question the user goes on.

    `{node.add}` in the sentence stands for the shortcut of that action, `widget` may be a panel. As the step begins,
    the viewer goes to the port `show`, `panel` comes to the front, and the passes of the shader function `marks` are
    marked there. The commands of `solution` do what is asked for.
    """

    sentence: str
    widget: str
    is_done: Question | None = None
    show: str = ""
    panel: PanelTitle | None = None
    marks: str = ""
    solution: tuple[EditCommand[Any], ...] = ()


class Lesson(Struct, frozen=True):
    """A lesson with its steps. It starts with a graph, by its path below the presets, or with a picture."""

    id: str
    title: str
    doc: str
    start: str
    steps: tuple[Step, ...]

    @property
    def start_file(self) -> Path:
        """The graph or the picture that the lesson starts with."""
        return presets.sample() if self.start == "sample" else presets.sample().parents[1] / f"{self.start}.json"

    @property
    def tasks(self) -> tuple[Step, ...]:
        """The steps that ask for something that can be read off the graph."""
        return tuple(step for step in self.steps if isinstance(step.is_done, GraphCondition))

    def is_solved(self, graph: Graph) -> bool:
        """True if all that the tasks ask for is true of a graph."""
        return all(task.is_done.holds(graph) for task in self.tasks if isinstance(task.is_done, GraphCondition))


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
