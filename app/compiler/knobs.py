"""Controls of a graph as numbers, and what the compiler makes of the graph at other values of them.

A value of a node reaches a program through Python: the node converts units, computes weights or chooses passes. So no
code can say what a control does. Exports, which run without the compiler, find it out: they compile the graph again
with other values, and compare what they get. A *knob* is one number that a user may change: a component of a control,
or the frame. All knobs together are a *point*, and what the compiler makes there is a *sample* (`GraphSampler`).

How numbers follow between samples is up to the export: `isf` writes formulas, `export.package` curves.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Generic, TypeVar

from halation.nodes import ItemSet, Scalar, Value
from msgspec import Struct

from ..errors import HalationError
from ..graph import Graph, find_declaration

FRAME = "frame"
"""The name of the knob of time."""

Point = Mapping[str, float]
"""Values of knobs by name. Knobs that it does not name rest."""

SampleT = TypeVar("SampleT")


class Knob(Struct, frozen=True):
    """A number from `low` to `high` that a user may change; `rest` is its value in the graph."""

    name: str
    rest: float
    low: float
    high: float
    is_whole: bool = False

    def snap(self, number: float) -> float:
        """The nearest value that it can have."""
        number = min(max(number, self.low), self.high)
        return float(round(number)) if self.is_whole else number


class KnobControl(Struct, frozen=True):
    """A control whose values are numbers: what a user sees of it, and its knobs, one for each component.

    `label` is empty where neither the control nor the value has one.
    """

    name: str
    label: str
    doc: str
    value: Value
    knobs: tuple[Knob, ...]

    def value_at(self, point: Point) -> Scalar | str:
        """The value of the control at a point."""
        parts = tuple(point.get(knob.name, knob.rest) for knob in self.knobs)
        if self.value.length > 1:
            return parts
        if self.value.type == "choice":
            return self.value.choices[round(parts[0])]
        return {"bool": bool, "int": round}.get(self.value.type, float)(parts[0])


def find_control_name(knob: str) -> str:
    """The control that a knob belongs to; of the frame, its own name."""
    return knob.partition(".")[0]


def find_knob_controls(graph: Graph, has_input: Callable[[Value], bool]) -> tuple[list[KnobControl], dict[str, str]]:
    """The controls for whose values a format `has_input`, and what is said of the others, by their names."""
    controls, remarks = list[KnobControl](), dict[str, str]()
    for name, control in graph.controls.items():
        item = graph.nodes.get(control.target.node)
        value = find_declaration(item, control.target.socket) if item else None
        rest = graph.value(control.target) if value else None
        if value is None or rest is None or isinstance(rest, ItemSet):
            continue
        if not has_input(value):
            remarks[name] = f"keeps its value: the format has no input for a {value.type} like it"
        elif control.target in graph.animation or control.target in graph.links:
            remarks[name] = "cannot be changed: it is animated or linked"
        else:
            label, doc = control.label or value.label, control.doc or value.doc
            controls.append(KnobControl(name, label, doc, value, _make_knobs(name, value, rest)))
    return controls, remarks


def describe_control(name: str, remark: str) -> str:
    """A sentence on a control."""
    return f"control '{name}' {remark}"


def _make_knobs(name: str, value: Value, rest: object) -> tuple[Knob, ...]:
    name = f"{name}.0" if name == FRAME else name
    if value.type == "choice":
        return (Knob(name, float(value.choices.index(str(rest))), 0.0, len(value.choices) - 1.0, is_whole=True),)
    parts = [float(part) for part in (rest if isinstance(rest, tuple) else (rest,))]  # pyright: ignore
    if value.type == "bool":
        return (Knob(name, parts[0], 0.0, 1.0, is_whole=True),)
    low, high = max(value.low, value.minimum), min(value.high, value.maximum)
    if low == float("-inf") or high == float("inf") or low >= high:
        low, high = 0.0, max(1.0, *(2.0 * part for part in parts))
    low, high = min(low, *parts), max(high, *parts)
    many = len(parts) > 1
    return tuple(
        Knob(f"{name}.{at}" if many else name, part, low, high, value.type == "int") for at, part in enumerate(parts)
    )


class GraphSampler(Generic[SampleT]):
    """Compiles a graph at points, each of them once: exports ask for the same points again and again.

    `compile_at` gets the graph with the controls of a point set, and the point for what else it says.
    """

    def __init__(
        self, graph: Graph, controls: Sequence[KnobControl], compile_at: Callable[[Graph, Point], SampleT]
    ) -> None:
        self._graph, self._controls, self._compile_at = graph, controls, compile_at
        self._samples: dict[tuple[tuple[str, float], ...], SampleT] = {}

    def take(self, point: Point) -> SampleT:
        """The sample at a point. Raises the errors of compiling the graph."""
        key = tuple(sorted(point.items()))
        if key not in self._samples:
            graph = self._graph
            for control in self._controls:
                if any(knob.name in point for knob in control.knobs):
                    graph = graph.set_control(control.name, control.value_at(point))
            self._samples[key] = self._compile_at(graph, point)
        return self._samples[key]

    def try_take(self, point: Point) -> SampleT | None:
        """The sample at a point; None where the graph cannot be compiled."""
        try:
            return self.take(point)
        except HalationError:
            return None
