"""The types of outputs that follow an input: a blur of a Field is a Field."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Protocol

from halation.nodes import Field, Kind, Node, Socket, Value

from ..errors import GraphError
from .conversion import conversion, make_socket
from .model import Port, class_signature

_NOTHING = Port("", "")


class _SourceGraph(Protocol):
    """A graph, as far as this walk reads it."""

    @property
    def nodes(self) -> Mapping[str, object]: ...

    @property
    def links(self) -> Mapping[Port, Port]: ...

    def find_declared_source(self, port: Port) -> Socket | None: ...


def find_followed_input(graph: _SourceGraph, port: Port) -> Port | None:
    """The input whose type an output has, or None."""
    item = graph.nodes.get(port.node)
    output = item.outputs.get(port.socket) if isinstance(item, Node) else None
    return Port(port.node, output.follows) if output and output.follows else None


def find_field_outputs(graph: _SourceGraph) -> Mapping[Port, Socket]:
    """The outputs that are Fields because a Field is linked to the input that they follow.

    Goes from node to node, since many in a row may follow each other, and over each of them once.
    """
    are_fields: dict[Port, bool] = {}
    for id, item in graph.nodes.items():
        for name in item.outputs if isinstance(item, Node) else ():
            row, source = list[Port](), Port(id, name)
            while source not in are_fields and (followed := find_followed_input(graph, source)):
                are_fields[source] = False  # so that a circle ends
                row.append(source)
                source = graph.links.get(followed, _NOTHING)
            is_field = are_fields[source] if source in are_fields else _is_field(graph, source)
            are_fields.update(dict.fromkeys(row, is_field))
    return MappingProxyType(
        {port: make_socket(Kind.FIELD, name=port.socket) for port in are_fields if are_fields[port]}
    )


def _is_field(graph: _SourceGraph, port: Port) -> bool:
    """True if an output that follows nothing is a Field."""
    try:
        socket = graph.find_declared_source(port)
    except GraphError:
        return False
    return socket is not None and socket.kind is Kind.FIELD


@lru_cache(4096)
def fits_as_declared(start: type[Node], output: str, end: type[Node], socket: str) -> bool:
    """True if an output of all nodes of a class fits an input or a value of all those of another, as they declare it.

    Most links do, and a graph may have 100,000. False says nothing: an output may follow an input to another type.
    """
    source, signature = class_signature(start).outputs.get(output), class_signature(end)
    target = signature.inputs.get(socket) or (signature.values.get(socket) if signature.pointwise else None)
    return source is not None and target is not None and conversion(source, target) is None


def find_type_fault(
    graph: _SourceGraph,
    source: Port,
    start: Socket,
    target: Socket | Value,
    list_fields: Callable[[], Mapping[Port, Socket]],
) -> str | None:
    """Why an output, declared as `start`, cannot feed a target; None if its type fits, or that of what it follows.

    `list_fields` returns what `find_field_outputs` does; it is called only where the declared type does not fit.
    """
    fault = conversion(start, target)
    followed = find_followed_input(graph, source) if fault else None
    if fault is None or followed is None:
        return fault
    if field := list_fields().get(source):
        return conversion(field, target)
    if followed in graph.links or conversion(Field(), target):
        return fault
    return f"{fault}; '{source}' is a Field where a Field is linked to '{followed}'"
