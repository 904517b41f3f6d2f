"""Whether a graph holds code that its user wrote."""

from __future__ import annotations

from ..custom_nodes import CustomNode
from .graph import Graph, Group


def has_code(graph: Graph) -> bool:
    """True if a code node is in the graph or in one of its groups."""
    return any(
        has_code(node.graph) if isinstance(node, Group) else isinstance(node, CustomNode)
        for node in graph.nodes.values()
    )
