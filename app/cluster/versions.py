"""The version of everything that decides the pixels of a graph: two machines with the same ones render the same."""

from __future__ import annotations

import inspect
from collections.abc import Iterator, Mapping
from hashlib import sha256
from pathlib import Path

from halation.nodes import Node, plugins

from ..compiler.library import load_library
from ..custom_nodes import CustomNode
from ..graph import Graph, Group
from ..version import VERSION

_DIGITS = 12
"""Hexadecimal digits of a hash that a sentence shows and that are compared: as many as `halation reproduce` prints."""


def describe_versions(graph: Graph) -> dict[str, str]:
    """The versions of Halation, of the plug-ins of a graph, and of the code of each type of node in it, by name."""
    types = {type(node).id: type(node) for node in _list_nodes(graph)}
    versions = {"Halation": VERSION}
    if any("." in id for id in types):
        used = {id.partition(".")[0] for id in types}
        versions |= {
            f"the plug-in {plugin.package}": plugin.version for plugin in plugins() if plugin.namespace in used
        }
    return versions | {f"node type {id}": _hash_code(types[id]) for id in sorted(types)}


def find_version_fault(ours: Mapping[str, str], others: Mapping[str, str]) -> str:
    """How the versions of this machine differ from those of another one that sends a job; "" if they do not."""
    for name, other in others.items():
        if name not in ours:
            return f"it has no {name.removeprefix('the ')}, which the job needs ({other})"
        if ours[name] != other:
            return f"it has {name} {ours[name]}, and the job was sent by {other}"
    return ""


def _list_nodes(graph: Graph) -> Iterator[Node]:
    """All nodes whose code is installed, also those in groups. The code of custom nodes is part of the graph."""
    for item in graph.nodes.values():
        if isinstance(item, Group):
            yield from _list_nodes(item.graph)
        elif isinstance(item, Node) and not isinstance(item, CustomNode):
            yield item


def _hash_code(kind: type[Node]) -> str:
    """A hash of the class of a node and of all GLSL that it includes."""
    try:
        parts = [Path(inspect.getfile(kind)).read_bytes()]
    except (OSError, TypeError):
        parts = []
    if kind.shader in load_library().texts:
        parts.append(load_library().digest((kind.shader,), kind.id).encode())
    return sha256(b"\0".join(parts)).hexdigest()[:_DIGITS]
