"""Controls of a graph as numbers that a user may change."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import ItemSet, Scalar, Value
from msgspec import Struct

from ...graph import Graph, find_declaration

FRAME = "frame"
"""The name of the knob of time."""

Point = Mapping[str, float]
"""Values of knobs by name."""


class PackageKnob(Struct, frozen=True):
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


class PackageControl(Struct, frozen=True):
    """A control: what a user sees of it, and its knobs, one for each component."""

    name: str
    label: str
    doc: str
    value: Value
    knobs: tuple[PackageKnob, ...]

    @property
    def widget(self) -> str:
        """How it is changed: slider, whole, switch, choice, color or point."""
        if self.value.type == "vector":
            return "point"
        return {"float": "slider", "int": "whole", "bool": "switch"}.get(self.value.type, self.value.type)

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


def find_controls(graph: Graph) -> tuple[list[PackageControl], list[str]]:
    """The controls that can be changed in a package, and a sentence on each of the others."""
    controls, notes = list[PackageControl](), list[str]()
    for name, control in graph.controls.items():
        item = graph.nodes.get(control.target.node)
        value = find_declaration(item, control.target.socket) if item else None
        rest = graph.value(control.target) if value else None
        if value is None or rest is None or isinstance(rest, ItemSet):
            continue
        if value.type not in ("float", "int", "bool", "color", "vector", "choice"):
            notes.append(f"control '{name}' keeps its value: a {value.type} is no single number")
        elif control.target in graph.animation or control.target in graph.links:
            notes.append(f"control '{name}' cannot be changed: it is animated or linked")
        else:
            label = control.label or value.label or name.replace("_", " ").capitalize()
            controls.append(
                PackageControl(name, label, control.doc or value.doc, value, _make_knobs(name, value, rest))
            )
    return controls, notes


def _make_knobs(name: str, value: Value, rest: object) -> tuple[PackageKnob, ...]:
    name = f"{name}.0" if name == FRAME else name
    if value.type == "choice":
        return (PackageKnob(name, float(value.choices.index(str(rest))), 0.0, len(value.choices) - 1.0, is_whole=True),)
    parts = [float(part) for part in (rest if isinstance(rest, tuple) else (rest,))]  # pyright: ignore
    if value.type == "bool":
        return (PackageKnob(name, parts[0], 0.0, 1.0, is_whole=True),)
    low, high = max(value.low, value.minimum), min(value.high, value.maximum)
    if low == float("-inf") or high == float("inf") or low >= high:
        low, high = 0.0, max(1.0, *(2.0 * part for part in parts))
    low, high = min(low, *parts), max(high, *parts)
    many = len(parts) > 1
    return tuple(
        PackageKnob(f"{name}.{at}" if many else name, part, low, high, value.type == "int")
        for at, part in enumerate(parts)
    )
