"""Values that do not come from pictures: checked, limited, and as wide as they are wanted."""

from __future__ import annotations

import math

from halation.nodes import Node, Socket, Value

from ...errors import GraphError
from ...graph import Input, Port
from ...graph.values import value_fault
from ..ir import UniformConstant


def check_values(path: str, node: Node) -> None:
    """Raise GraphError for a value that no shader could take."""
    for name, value in node.values.items():
        now = getattr(node, name)
        if now is not value.default and (fault := value_fault(value, now)):
            raise GraphError(f"{path}.{name}: {fault}")


def of_input(port: Port, end: Input) -> UniformConstant:
    """The constant of a graph input. Raises GraphError where it does not fit."""
    given = end.default if isinstance(end.default, tuple) else (end.default,)
    found = tuple(part for part in given if isinstance(part, float | int) and math.isfinite(part))
    if len(found) != len(given) or len(found) not in (1, end.width):
        raise GraphError(f"input '{port.socket}': the default {end.default!r} does not fit {end.kind}")
    return UniformConstant(found if len(found) > 1 else float(*found))


def limited(wire: UniformConstant, value: Value, factor: float) -> UniformConstant:
    """A wired constant within the hard range, in working units."""
    parts = wire.value if isinstance(wire.value, tuple) else (wire.value,)
    parts = tuple(min(max(part, value.minimum), value.maximum) * factor for part in parts)
    return UniformConstant(parts if isinstance(wire.value, tuple) else parts[0])


def of_socket(socket: Socket) -> float | tuple[float, ...]:
    """A socket's default with one number per channel."""
    default = socket.default if socket.default is not None else 0.0
    if socket.channels == 1 or isinstance(default, tuple):
        return default
    return (default,) * socket.channels
