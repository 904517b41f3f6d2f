"""The numbers that may change: which values of a graph, and within which ranges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import floor, isfinite, log10

import numpy as np
from halation.nodes import Plain, Value, curve_at
from msgspec import Struct, structs

from ..errors import UsageError
from ..graph import Graph, Group, Port, Unknown, did_you_mean, find_declaration, list_sockets, signature
from ..media.comparison.metrics import Array
from .value_patterns import ValuePattern

_DIGITS = 5
"""Digits of a range that are kept: of a slider as wide as a screen, a hundredth of a pixel."""

_CHANNELS = ("red", "green", "blue")
_FITTED_TYPES = ("float", "int", "color", "vector", "matrix", "curve")
_LONGEST = 400
"""Numbers that are fitted together. Chosen by judgement: each costs a render per step, and memory for its gradient."""


class FittedNumber(Struct, frozen=True):
    """A number that may change: that of a value, or one of its list, from `low` to `high`.

    `places` are its places in the list; both ends of a cyclic curve are one number. `path` is what `Graph.override`
    takes.
    """

    name: str
    path: str
    places: tuple[int, ...]
    start: float
    low: float
    high: float
    is_whole: bool = False

    def at(self, fraction: float) -> float:
        """The number at a fraction of the range."""
        number = float(f"{self.low + fraction * (self.high - self.low):.12g}")
        return float(round(number)) if self.is_whole else min(max(number, self.low), self.high)

    def round(self, fraction: float) -> float:
        """The nearest fraction whose number has `_DIGITS` digits of the range."""
        digits = _DIGITS - floor(log10(self.high - self.low))
        number = min(max(round(self.at(fraction), digits), self.low), self.high)
        return (number - self.low) / (self.high - self.low)


class SearchSpace(Struct, frozen=True):
    """All numbers that may change in a graph. A point has one fraction of its range, 0 to 1, for each of them."""

    graph: Graph
    numbers: tuple[FittedNumber, ...]

    @property
    def start(self) -> Array:
        """The point of the graph itself."""
        return np.array([(item.start - item.low) / (item.high - item.low) for item in self.numbers])

    @property
    def whole(self) -> Array:
        """Which numbers are whole."""
        return np.array([item.is_whole for item in self.numbers])

    def round(self, point: Array) -> Array:
        """The nearest point whose numbers are short. What did not change stays as it is."""
        pairs = zip(self.numbers, point, self.start, strict=True)
        return np.array([start if part == start else item.round(float(part)) for item, part, start in pairs])

    def settings_at(self, point: Array) -> dict[str, Plain]:
        """The values that a point sets, by the paths that `Graph.override` takes: numbers, and whole lists."""
        lists: dict[str, list[float]] = {}
        settings: dict[str, Plain] = {}
        for item, fraction in zip(self.numbers, point, strict=True):
            number = item.at(float(fraction))
            if not item.places:
                settings[item.path] = int(number) if item.is_whole else number
                continue
            parts = lists.setdefault(item.path, list(_read_list(self.graph, item.path)))
            for place in item.places:
                parts[place] = number
        return settings | {path: tuple(parts) for path, parts in lists.items()}

    def graph_at(self, point: Array) -> Graph:
        """The graph with the numbers of a point."""
        graph = self.graph
        for path, setting in self.settings_at(point).items():
            graph = graph.override(path, setting)
        return graph


class _NamedValue(Struct, frozen=True):
    name: str
    path: str
    value: Value
    fault: str = ""


def find_search_space(graph: Graph, patterns: Sequence[ValuePattern], curve_points: int) -> SearchSpace:
    """The numbers of all values that a pattern names. A curve of two points gets `curve_points`, without a change.

    Raises UsageError for a pattern that names nothing, or a value that is no number.
    """
    values = tuple(_list_values(graph))
    chosen: dict[str, tuple[_NamedValue, ValuePattern]] = {}
    for pattern in patterns:
        for item in _select(values, pattern):
            chosen.setdefault(item.path, (item, pattern))
    numbers: list[FittedNumber] = []
    for item, pattern in chosen.values():
        if item.value.type == "curve" and len(points := _read_list(graph, item.path)) == 4:
            graph = graph.override(item.path, _add_points(points, curve_points))
        numbers += _make_numbers(item, _read_setting(graph, item.path), pattern)
    if len(numbers) > _LONGEST:
        raise UsageError(f"--values: {len(numbers)} numbers are more than the {_LONGEST} that can be fitted together")
    return SearchSpace(graph, tuple(numbers))


def _select(values: Sequence[_NamedValue], pattern: ValuePattern) -> list[_NamedValue]:
    matches = [item for item in values if pattern.matches(item.name)]
    if not matches:
        hint = did_you_mean(pattern.text, [item.name for item in values])
        raise UsageError(f"--values {pattern.text}: the graph has no such value{hint}")
    usable = [item for item in matches if not item.fault and (pattern.is_exact or not _is_left_out(item.value))]
    if not usable:
        fault = matches[0].fault or "a * leaves it out: name it in full"
        raise UsageError(f"--values {pattern.text}: '{matches[0].name}' cannot be fitted: {fault}")
    return usable


def _is_left_out(value: Value) -> bool:
    """True for what nobody means by a *: the mask of a node, and the seeds of patterns."""
    return value.folded or (value.name == "seed" and value.type == "int")


def _list_values(graph: Graph) -> Iterator[_NamedValue]:
    """All values by name, controls of the graph first, with the path that sets each."""
    named = {str(item.path): item for item in _list_node_values(graph, "")}
    for name, control in graph.controls.items():
        if item := named.get(str(control.target)):
            yield _NamedValue(name, item.path, item.value, item.fault)
    yield from named.values()


def _list_node_values(graph: Graph, prefix: str) -> Iterator[_NamedValue]:
    for id, item in graph.nodes.items():
        if isinstance(item, Unknown):
            continue
        for name in signature(item).values:
            for socket in list_sockets(item, name):
                port = Port(id, socket)
                declared = find_declaration(item, socket)
                value = structs.replace(graph.declaration(port), default=declared.default if declared else 0.0)
                path = f"{prefix}{port}"
                yield _NamedValue(path, path, value, _find_fault(graph, port, value))
        if isinstance(item, Group) and not item.path:
            yield from _list_node_values(item.body(), f"{prefix}{id}.")


def _find_fault(graph: Graph, port: Port, value: Value) -> str:
    """Why a value cannot be fitted, or ""."""
    if value.type not in _FITTED_TYPES:
        return f"it is a {value.type}, and only numbers, colors and curves can be"
    if port in graph.links or port.whole in graph.links:
        return "a link drives it"
    if port in graph.animation or port.whole in graph.animation:
        return "it is animated"
    return ""


def _read_setting(graph: Graph, path: str) -> Plain:
    head, _, rest = path.partition(".")
    item = graph.node(head)
    if isinstance(item, Group) and (inner := rest.partition(".")[0]) in item.graph.nodes and "." in rest and inner:
        return _read_setting(item.body(), rest)
    return graph.value(Port(head, rest))


def _read_list(graph: Graph, path: str) -> tuple[float, ...]:
    setting = _read_setting(graph, path)
    assert isinstance(setting, tuple)
    return setting


def _add_points(points: tuple[float, ...], count: int) -> tuple[float, ...]:
    """The straight curve between two points through `count` of them."""
    places = np.linspace(points[0], points[-2], count)
    return tuple(float(part) for x in places for part in (x, curve_at(points, float(x))))


def _make_numbers(item: _NamedValue, setting: Plain, pattern: ValuePattern) -> Iterator[FittedNumber]:
    value = item.value
    if not isinstance(setting, tuple):
        number = float(setting)  # type: ignore[arg-type]
        yield FittedNumber(item.name, item.path, (), number, *_find_range(item, number, pattern), value.type == "int")
        return
    if value.type == "curve":
        last = len(setting) - 1
        for place in range(1, len(setting), 2):
            if value.cyclic and place == last:
                continue
            places = (place, last) if value.cyclic and place == 1 else (place,)
            limits = _find_range(item, setting[place], pattern)
            yield FittedNumber(f"{item.name} at {setting[place - 1]:.3g}", item.path, places, setting[place], *limits)
        return
    labels = _CHANNELS if value.type == "color" else [str(place) for place in range(len(setting))]
    for place, label in enumerate(labels):
        limits = _find_range(item, setting[place], pattern, place)
        yield FittedNumber(f"{item.name}.{label}", item.path, (place,), setting[place], *limits)


def _find_range(item: _NamedValue, number: float, pattern: ValuePattern, place: int = 0) -> tuple[float, float]:
    """The range of a number: that of the pattern, else of its slider. The number itself is always inside."""
    value = item.value
    if pattern.low is not None and pattern.high is not None:
        low, high = max(pattern.low, value.minimum), min(pattern.high, value.maximum)
        if not low <= number <= high or low >= high:
            raise UsageError(
                f"--values {pattern.text}={pattern.low:g}..{pattern.high:g}: '{item.name}' is {number:g} now: give a "
                "range that holds it, or set it first with --set"
            )
        return low, high
    low, high = _find_declared_range(value, number, place)
    return max(min(low, number), value.minimum), min(max(high, number), value.maximum)


def _find_declared_range(value: Value, number: float, place: int) -> tuple[float, float]:
    if value.wheel and isinstance(value.default, tuple):
        gray = value.default[place]
        return gray - value.wheel, gray + value.wheel
    if isfinite(value.low) and isfinite(value.high) and value.low < value.high:
        return value.low, value.high
    return (0.0, max(1.0, 2.0 * number)) if value.type == "color" else (number - 1.0, number + 1.0)
