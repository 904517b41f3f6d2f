"""Nodes whose body is another graph."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING

from ...nodes import Node, Plain
from .parts import Unknown

if TYPE_CHECKING:
    from .graph import Graph


@dataclass(frozen=True)
class Group:
    """A node whose body is another graph.

    `path` is as written in the file, relative to that file; empty for a body that is part of it.
    `values` holds settings of the body's controls by name.
    """

    graph: Graph
    path: str = ""
    values: Mapping[str, Plain] = field(default_factory=dict[str, Plain])

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", MappingProxyType(dict(self.values)))

    def body(self) -> Graph:
        """The graph inside, with the group's values put where its controls point."""
        graph = self.graph
        for name, plain in self.values.items():
            if name in graph.controls:
                graph = graph.put(graph.controls[name].target, plain)
        return graph


Item = Node | Group | Unknown
