"""Constants of graph inputs, values and unlinked sockets: checked, limited, and with the channels that are needed."""

from __future__ import annotations

import math

from halation.nodes import Kind, Node, Socket, Value

from ...errors import GraphError
from ...graph import Input, Port
from ...graph.values import value_fault
from ..ir import PlannedObject, UniformConstant
from .expand import make_zero


def check_values(path: str, node: Node) -> None:
    """Raise GraphError for an invalid value."""
    settings = node.settings
    for name, value in node.values.items():
        setting = settings[name]
        if node.length_units:
            value = node.declaration(name)
        if setting is not value.default and (fault := value_fault(value, setting)):
            raise GraphError(f"{path}.{name}: {fault}")


def make_input_constant(port: Port, end: Input) -> UniformConstant:
    """The constant of a graph input. Raises GraphError if it does not fit the input's type."""
    default = end.default if isinstance(end.default, tuple) else (end.default,)
    numbers = tuple(part for part in default if isinstance(part, float | int) and math.isfinite(part))
    if len(numbers) != len(default) or len(numbers) not in (1, end.width):
        raise GraphError(f"input '{port.socket}': the default {end.default!r} does not fit {end.kind}")
    if end.kind.is_planned:
        return _read_object(end.kind, numbers)
    return UniformConstant(numbers if len(numbers) > 1 else float(*numbers))


def limit_wire(wire: UniformConstant, value: Value, factor: float) -> UniformConstant:
    """A wired constant within the hard range, in working units."""
    parts = wire.value if isinstance(wire.value, tuple) else (wire.value,)
    parts = tuple(min(max(part, value.minimum), value.maximum) * factor for part in parts)
    return UniformConstant(parts if isinstance(wire.value, tuple) else parts[0])


def make_default(socket: Socket) -> UniformConstant:
    """The constant that an input has without a link: its default with one number per channel."""
    default = socket.default if socket.default is not None else 0.0
    if socket.kind.is_planned:
        return _read_object(socket.kind, default if isinstance(default, tuple) else (default,))
    if socket.channels == 1 or isinstance(default, tuple):
        return UniformConstant(default)
    return UniformConstant((default,) * socket.channels)


def make_empty_constant(socket: Socket) -> UniformConstant:
    """The constant of a muted output that no input can replace: zero, or no object."""
    return PlannedObject() if socket.kind.is_planned else UniformConstant(make_zero(socket))


def _read_object(kind: Kind, numbers: tuple[float, ...]) -> PlannedObject:
    """The object of a planned kind that numbers of a graph file stand for."""
    read = kind.facts.read
    return PlannedObject(content=read(numbers) if read else None)


def find_choices(node: Node | type[Node]) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """The options of every choice of a node or a class, by value: its GLSL file reads them as macros."""
    return tuple((name, value.choices) for name, value in node.values.items() if value.choices)
