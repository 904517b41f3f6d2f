"""Ids for new nodes, and names of values and elements for labels."""

from __future__ import annotations

from collections.abc import Collection, Container
from pathlib import Path

from ...graph import Graph, Port, Unknown, find_declaration
from ...graph.names import name_fault
from ...language.translation import translate
from .element_id import ElementId


def node_stem(path: str | Path) -> str:
    """A node id from the name of a file."""
    name = "".join(letter if letter.isalnum() else "_" for letter in Path(path).stem).strip("_") or "file"
    return name if name_fault(name, "node") is None else f"{name}_file"


def name_copy(name: str, used_names: Container[str], kind: str = "") -> str:
    """A free name for a copy: `blur2` for `blur`, `n4` for `n3`; digits that belong to its `kind` are left alone."""
    if name not in used_names:
        return name
    head = name.rstrip("0123456789")
    if len(head) < len(kind) and name.startswith(kind):
        head = kind
    number = int(name[len(head) :] or 1) + 1
    while f"{head}{number}" in used_names:
        number += 1
    return f"{head}{number}"


def value_label(graph: Graph, port: Port) -> str:
    """A value for the user: its label, else its name."""
    item = graph.nodes.get(port.node)
    value = None if item is None or isinstance(item, Unknown) else find_declaration(item, port.socket)
    words = port.socket.partition(".")[2] or port.socket
    return translate((value.label if value else "") or words.replace(".", " ").replace("_", " "), "value")


def describe_elements(elements: Collection[ElementId]) -> str:
    """Some elements for the label of a step: `blur`, `3 nodes`, `4 elements`."""
    if len(elements) == 1:
        return next(iter(elements))
    if all(element.kind == "node" for element in elements):
        return translate("{count} nodes", count=len(elements))
    return translate("{count} elements", count=len(elements))
