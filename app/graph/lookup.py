"""Finds ports by text that the user typed."""

from __future__ import annotations

from halation.nodes import ItemSet, Node, Value

from ..errors import GraphError
from .graph import Graph, Item, expand_socket, find_setting, signature
from .model import Port
from .named_items import find_field_declaration, join_path, split_path
from .spline_points import split_point


def find_node_output(graph: Graph, text: str) -> Port:
    """The port that `node` or `node.output` names. Raises GraphError that lists the outputs."""
    id, _, output = text.partition(".")
    outputs = tuple(signature(graph.node(id)).outputs)
    if (output or "out") in outputs:
        return Port(id, output or "out")
    if not output and outputs:
        return Port(id, outputs[0])
    raise GraphError(f"node '{id}' has no output '{output}': its outputs are {', '.join(outputs) or 'none'}")


def split_socket(item: Item, words: list[str]) -> tuple[str, list[str]]:
    """The socket of a value that words between dots begin with, in full, and the words behind it."""
    first, length = find_setting(item, words[0]), 1
    if first is None or first.items:
        length = 3 - (first is None) if len(words) > 1 else 1
    return expand_socket(item, ".".join(words[:length])), words[length:]


def find_declaration(item: Item, name: str) -> Value | None:
    """The declaration of a value of a node, or of a field of a named item, with its default; None if there is none."""
    if split_point(name) and (point := find_setting(item, name)):
        return point
    head, inner, field = split_path(name)
    if not inner:
        value = signature(item).values.get(name)
        return item.declaration(name) if value and value.listed_in and isinstance(item, Node) else value
    value = find_setting(item, head)
    return value and find_field_declaration(value, inner, field)


def list_sockets(item: Item, name: str) -> tuple[str, ...]:
    """The sockets of a value: the fields of its items, else the value itself."""
    value = find_setting(item, name)
    if value is None or value.items is None or not isinstance(value.default, ItemSet):
        return (name,)
    kinds = value.items.by_name
    return tuple(
        join_path(name, key, field) for key, part in value.default.items() for field in kinds[part.kind].fields
    )
