"""A graph at a frame: what changes over time stands still."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from halation.nodes import Plain, Value

from ..errors import GraphError
from .animation import ANIMATED, Animation, unfit
from .expressions import Expression
from .graph import Graph, Group, declared
from .keys import Keys, round_keys
from .model import Port, Settings
from .names import did_you_mean
from .values import coerce, expected

CHANNELS = {name: place for letters in ("xyzw", "rgba") for place, name in enumerate(letters)}


def evaluate_at_frame(graph: Graph, frame: int) -> Graph:
    """The graph at a frame: every animated value, in groups too, is set to what it is then.

    Raises GraphError for an expression that has no value there, or that needs itself.
    """
    return _FrameEvaluation(frame, graph.settings).of(graph)


def value_at(graph: Graph, port: Port, frame: int) -> Plain:
    """What a value of a node, or a control of a group, is at a frame. Raises GraphError."""
    return _Values(graph, frame, graph.settings).at(port)


def is_animated(graph: Graph) -> bool:
    """True if any value of it changes over time, groups included."""
    return bool(graph.animation) or any(
        is_animated(item.graph) for item in graph.nodes.values() if isinstance(item, Group)
    )


def find_key_range(graph: Graph) -> tuple[int, int]:
    """From frame 1 to the last key, groups included."""
    keyed = [item for item in graph.animation.values() if isinstance(item, Keys) and item.keys]
    inner = (find_key_range(item.graph)[1] for item in graph.nodes.values() if isinstance(item, Group))
    return 1, max([1, *(math.ceil(item.keys[-1].frame) for item in keyed), *inner])


def animation_fault(graph: Graph, port: Port, animation: Animation) -> str | None:
    """Why a value cannot change in that way, or None."""
    try:
        value = declared(graph.node(port.node), port.socket, port.node)
        if fault := unfit(port, value, animation):
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


def loop_faults(graph: Graph) -> Iterator[tuple[Port, str]]:
    """Expressions that need themselves."""
    reads = {
        port: [find_named_value(graph, name)[0] for name in item.names if _is_there(graph, name)]
        for port, item in graph.animation.items()
        if isinstance(item, Expression)
    }
    for port in reads:
        seen, todo = set[Port](), list(reads[port])
        while todo:
            other = todo.pop()
            if other == port:
                yield port, f"{port}: its expression needs itself"
                break
            if other not in seen:
                seen.add(other)
                todo.extend(reads.get(other, ()))


def find_named_value(graph: Graph, name: str) -> tuple[Port, int | None]:
    """The value, and the channel of it, that an expression calls `glow`, `bloom.intensity` or `move.offset.x`.

    Raises GraphError with a suggestion.
    """
    head, *rest = name.split(".")
    if head in graph.controls and head not in graph.nodes:
        port = graph.controls[head].target
    elif rest:
        port = Port(head, rest.pop(0))
        if head not in graph.nodes:
            raise GraphError(f"there is no node '{head}'{did_you_mean(head, graph.nodes)}")
    else:
        known = [*graph.controls, *(f"{node}." for node in graph.nodes)]
        raise GraphError(f"there is no control '{head}'{did_you_mean(head, known)}")
    value = declared(graph.node(port.node), port.socket, port.node)
    if value.type not in ANIMATED:
        raise GraphError(f"'{port}' is a {value.type}, which is no number")
    if not rest:
        return port, None
    width = len(value.default) if isinstance(value.default, tuple) else 1
    channel = CHANNELS.get(rest[0], width) if len(rest) == 1 else width
    if channel >= width:
        raise GraphError(f"'{name}': '{port}' has no channel '{'.'.join(rest)}'")
    return port, channel


class _FrameEvaluation:
    """One frame."""

    def __init__(self, frame: int, settings: Settings) -> None:
        self._frame, self._settings = frame, settings

    def of(self, graph: Graph) -> Graph:
        if not is_animated(graph):
            return graph
        values = _Values(graph, self._frame, self._settings)
        for port, plain in {port: values.at(port) for port in graph.animation}.items():
            graph = graph.put(port, plain)
        for id, item in graph.nodes.items():
            if isinstance(item, Group) and is_animated(item.graph):
                graph = replace(graph, nodes={**graph.nodes, id: Group(self.of(item.body()), item.path)})
        return graph


class _Values:
    """Values of one graph, groups not looked into, at one frame."""

    def __init__(self, graph: Graph, frame: int, settings: Settings) -> None:
        self._graph, self._frame, self._settings = graph, frame, settings
        self._known: dict[Port, Plain] = {}
        self._asked: list[Port] = []

    def at(self, port: Port) -> Plain:
        animation = self._graph.animation.get(port)
        if animation is None:
            return self._graph.value(port)
        if port not in self._known:
            if port in self._asked:
                raise GraphError(f"{port}: its expression needs itself", node=port.node)
            self._asked.append(port)
            self._known[port] = self._made(port, animation)
            self._asked.pop()
        return self._known[port]

    def _made(self, port: Port, animation: Animation) -> Plain:
        value = declared(self._graph.node(port.node), port.socket, port.node)
        if isinstance(animation, Keys):
            return fitted(port, value, animation.at(self._frame), self._frame)
        first, rate = (self._settings.frames or (1, 1))[0], self._settings.rate
        try:
            made = animation.at(self._frame, (self._frame - first) / rate, rate, self._named)
        except GraphError as error:
            raise GraphError(f"{port} at frame {self._frame}: {error}", node=port.node) from None
        return fitted(port, value, made, self._frame)

    def _named(self, name: str) -> Plain:
        port, channel = find_named_value(self._graph, name)
        found = self.at(port)
        return found[channel] if channel is not None and isinstance(found, tuple) else found


def fitted(port: Port, value: Value, made: Plain, frame: int) -> Plain:
    """What was computed as a setting of the value: rounded for a whole number, limited to the hard range.

    One number does for all channels. Raises GraphError for what does not fit.
    """
    if isinstance(value.default, tuple) and isinstance(made, int | float):
        made = (float(made),) * len(value.default)
    elif value.type == "int" and isinstance(made, float):
        made = int(round_keys(made))
    elif value.type == "bool" and isinstance(made, int | float):
        made = made != 0
    plain = coerce(value, made)
    if plain is None:
        raise GraphError(f"{port} at frame {frame} is {made!r}: it takes {expected(value)}", node=port.node)
    if isinstance(plain, bool | str):
        return plain
    if isinstance(plain, tuple):
        return tuple(min(max(part, value.minimum), value.maximum) for part in plain)
    return type(plain)(min(max(plain, value.minimum), value.maximum))


def _is_there(graph: Graph, name: str) -> bool:
    try:
        find_named_value(graph, name)
    except GraphError:
        return False
    return True
