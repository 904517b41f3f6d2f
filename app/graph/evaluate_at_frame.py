"""Evaluates the animation of a graph at one frame."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

from halation.nodes import ItemSet, Node, Plain, Row, Scalar, Value

from ..errors import GraphError
from .animation import ANIMATED, Animation, animation_type_fault
from .expressions import Expression
from .graph import Graph, Group, Item
from .keys import Keys, round_keys
from .lookup import split_socket
from .model import Port, Settings
from .names import can_compare_all, did_you_mean
from .scalars import coerce_scalar, describe_type
from .spline_points import pick_point, put_points, split_point
from .walk import find_cyclic

_LONG = 4000
"""Letters of a sentence about an expression that reads others: it shows the text of each, with a line below."""
CHANNELS = {name: place for letters in ("xyzw", "rgba") for place, name in enumerate(letters)}


def evaluate_at_frame(graph: Graph, frame: float) -> Graph:
    """The graph with every animated value, also in groups, set to its value at a frame, or between two.

    Raises GraphError for an expression that has no value at this frame, or that depends on itself.
    """
    return _FrameEvaluation(frame, graph.settings).evaluate(graph)


def value_at(graph: Graph, port: Port, frame: float) -> Plain:
    """The value of a node, or of a control of a group, at a frame. Raises GraphError."""
    return _ValueEvaluation(graph, frame, graph.settings).evaluate(port)


def is_animated(graph: Graph) -> bool:
    """True if any value is animated, also in groups."""
    return bool(graph.animation) or any(
        is_animated(item.graph) for item in graph.nodes.values() if isinstance(item, Group)
    )


def find_key_range(graph: Graph) -> tuple[int, int]:
    """The frames from 1 to the last key, also in groups."""
    keyed = [item for item in graph.animation.values() if isinstance(item, Keys) and item.keys]
    inner = (find_key_range(item.graph)[1] for item in graph.nodes.values() if isinstance(item, Group))
    return 1, max([1, *(math.ceil(item.keys[-1].frame) for item in keyed), *inner])


def animation_fault(graph: Graph, port: Port, animation: Animation) -> str | None:
    """Why a value cannot be animated in this way, or None. Checks the names in expressions too."""
    try:
        value = graph.declaration(port)
        if fault := animation_type_fault(port, value, animation):
            return fault
        if isinstance(animation, Keys):
            return None
        for name in animation.names:
            try:
                find_named_value(graph, name)
            except GraphError as error:
                raise animation.blame_name(name, f"{error}") from None
    except GraphError as error:
        return str(error) if f"{port}" in str(error) else f"{port}: {error}"
    return None


def find_expression_loops(graph: Graph) -> Iterator[tuple[Port, str]]:
    """The ports whose expressions depend on themselves, each with a sentence."""
    reads: dict[Port, list[Port]] = {}
    for port, item in graph.animation.items():
        for name in item.names if isinstance(item, Expression) else ():
            with suppress(GraphError):
                reads.setdefault(port, []).append(find_named_value(graph, name)[0])
    cyclic = find_cyclic(reads)
    yield from ((port, f"{port}: its expression depends on itself") for port in reads if port in cyclic)


def find_named_value(graph: Graph, name: str) -> tuple[Port, int | None]:
    """The value, and its channel if any, that a name in an expression means: `glow`, `bloom.intensity`, `move.by.x`.

    Raises GraphError with a suggestion. What a name means is looked for once in a graph.
    """
    if (known := graph.named_values.get(name)) is None:
        known = graph.named_values[name] = _find_named_value(graph, name)
    return known


def _find_named_value(graph: Graph, name: str) -> tuple[Port, int | None]:
    head, *rest = name.split(".")
    if head in graph.controls and head not in graph.nodes:
        start = graph.controls[head].target
        item, words = graph.node(start.node), [start.socket, *rest]
    elif rest:
        if head not in graph.nodes:
            raise GraphError(f"there is no node '{head}'{did_you_mean(head, graph.nodes)}")
        if len(rest) == 1 and _is_animated_number(graph.nodes[head], rest[0]):
            return Port(head, rest[0]), None  # the usual case
        start, item, words = Port(head, ""), graph.node(head), rest
    else:
        names = [*graph.controls, *(f"{node}." for node in graph.nodes)] if can_compare_all(graph.nodes) else ()
        raise GraphError(f"there is no control '{head}'{did_you_mean(head, names)}")
    socket, rest = split_socket(item, words)
    port = Port(start.node, socket)
    value = graph.declaration(port)
    if value.type not in ANIMATED:
        raise GraphError(f"'{port}' is a {value.type}, not a number")
    if not rest:
        return port, None
    width = len(value.default) if isinstance(value.default, tuple) else 1
    channel = CHANNELS.get(rest[0], width) if len(rest) == 1 else width
    if channel >= width:
        raise GraphError(f"'{name}': '{port}' has no channel '{'.'.join(rest)}'")
    return port, channel


def _is_animated_number(item: Item, name: str) -> bool:
    """True for a value of a node that a name means by itself: no named items, which have fields, and no text."""
    value = item.values.get(name) if isinstance(item, Node) else None
    return value is not None and value.items is None and value.type in ANIMATED


class _FrameEvaluation:
    """Evaluates graphs and their groups at one frame."""

    def __init__(self, frame: float, settings: Settings) -> None:
        self._frame, self._settings = frame, settings

    def evaluate(self, graph: Graph) -> Graph:
        if not is_animated(graph):
            return graph
        values = _ValueEvaluation(graph, self._frame, self._settings)
        graph = graph.put_all({port: values.evaluate(port) for port in graph.animation})
        inner = {
            id: Group(self.evaluate(item.body()), item.path)
            for id, item in graph.nodes.items()
            if isinstance(item, Group) and is_animated(item.graph)
        }
        return replace(graph, nodes={**graph.nodes, **inner}) if inner else graph


class _ValueEvaluation:
    """Evaluates values of one graph, without its groups, at one frame; each once.

    What an expression reads is evaluated before it. So evaluation does not go deeper with every expression that reads
    another one, and thousands in a row work. A fault is kept for whoever reads that value: an expression may name one
    that it does not use at this frame.
    """

    def __init__(self, graph: Graph, frame: float, settings: Settings) -> None:
        self._graph, self._frame, self._settings = graph, frame, settings
        self._named: dict[str, tuple[Port, int | None]] = {}
        self._results: dict[Port, Plain | GraphError] = {}
        self._in_progress: set[Port] = set()

    def evaluate(self, port: Port) -> Plain:
        """The value at the frame. Raises GraphError."""
        plain = self._evaluate_whole(port)
        if points := self._graph.keyed_points.get(port):
            own = {number: self._evaluate_whole(point) for number, point in points.items()}
            return put_points(plain, own) if isinstance(plain, tuple) else plain
        return plain

    def _evaluate_whole(self, port: Port) -> Plain:
        """The value at the frame, without what points have of their own."""
        if port not in self._graph.animation:
            return self._find_point(port) or self._graph.value(port)
        if port not in self._results:
            if port in self._in_progress:
                raise GraphError(f"{port}: its expression depends on itself", node=port.node)
            self._evaluate_with_reads(port)
        plain = self._results[port]
        if isinstance(plain, GraphError):
            raise GraphError(str(plain), node=plain.node)
        return plain

    def _find_point(self, port: Port) -> Row | None:
        """Where keys of all points put one that has none of its own; None for any other value."""
        point = split_point(port.socket)
        points = Port(port.node, point[0]) if point else port
        if point is None or points not in self._graph.animation:
            return None
        plain = self._evaluate_whole(points)
        return pick_point(plain, point[1])

    def _evaluate_with_reads(self, port: Port) -> None:
        """Evaluate an animated value after all that it reads."""
        todo, begun = [port], self._in_progress
        while todo:
            port = todo[-1]
            if port in self._results:
                todo.pop()
            elif port not in begun:
                begun.add(port)
                todo += [read_port for read_port in self._find_reads(port)[::-1] if read_port not in begun]
            else:
                try:
                    self._results[port] = self._evaluate_animation(port, self._graph.animation[port])
                except GraphError as error:
                    self._results[port] = error.with_traceback(None)

    def _find_reads(self, port: Port) -> list[Port]:
        """The animated values that an expression names; names that mean none are left out."""
        animation, ports = self._graph.animation[port], list[Port]()
        for name in animation.names if isinstance(animation, Expression) else ():
            try:
                read_port = self._find_named_value(name)[0]
            except GraphError:
                continue
            if read_port in self._graph.animation:
                ports.append(read_port)
        return ports

    def _find_named_value(self, name: str) -> tuple[Port, int | None]:
        """`find_named_value`, which looks a name up once."""
        if name not in self._named:
            self._named[name] = find_named_value(self._graph, name)
        return self._named[name]

    def _evaluate_animation(self, port: Port, animation: Animation) -> Plain:
        value = self._graph.declaration(port)
        if isinstance(animation, Keys):
            return fit_to_value(port, value, animation.evaluate(self._frame), self._frame)
        first, rate = (self._settings.frames or (1, 1))[0], self._settings.rate
        try:
            number = animation.evaluate(self._frame, (self._frame - first) / rate, rate, self._evaluate_name)
        except GraphError as error:
            if len(str(error)) > _LONG:  # it comes through many expressions, each of which would make it longer
                raise
            raise GraphError(f"{port} at frame {self._frame:g}: {error}", node=port.node) from None
        return fit_to_value(port, value, number, self._frame)

    def _evaluate_name(self, name: str) -> Scalar:
        port, channel = self._find_named_value(name)
        plain = self.evaluate(port)
        if isinstance(plain, ItemSet):
            raise GraphError(f"'{port}' holds named items: name a field of one, such as {port}.NAME.FIELD")
        return plain[channel] if channel is not None and isinstance(plain, tuple) else plain


def fit_to_value(port: Port, value: Value, computed: Scalar, frame: float) -> Scalar:
    """Convert a computed number to the type of a value: rounded for an int, limited to the hard range.

    A single number is used for all channels. Raises GraphError if it does not fit.
    """
    if isinstance(value.default, tuple) and isinstance(computed, int | float):
        computed = (float(computed),) * len(value.default)
    elif value.type == "int" and isinstance(computed, float):
        computed = int(round_keys(computed))
    elif value.type == "bool" and isinstance(computed, int | float):
        computed = computed != 0
    plain = coerce_scalar(value, computed)
    if plain is None:
        raise GraphError(f"{port} at frame {frame:g} is {computed!r}: it takes {describe_type(value)}", node=port.node)
    if isinstance(plain, bool | str):
        return plain
    if isinstance(plain, tuple):
        return tuple(min(max(part, value.minimum), value.maximum) for part in plain)
    return type(plain)(min(max(plain, value.minimum), value.maximum))
