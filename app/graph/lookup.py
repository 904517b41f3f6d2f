"""Finds ports by text that the user typed."""

from __future__ import annotations

from ..errors import GraphError
from .graph import Graph, signature
from .model import Port


def find_node_output(graph: Graph, text: str) -> Port:
    """The port that `node` or `node.output` names. Raises GraphError that lists the outputs."""
    id, _, output = text.partition(".")
    outputs = tuple(signature(graph.node(id)).outputs)
    if (output or "out") in outputs:
        return Port(id, output or "out")
    if not output and outputs:
        return Port(id, outputs[0])
    raise GraphError(f"node '{id}' has no output '{output}': its outputs are {', '.join(outputs) or 'none'}")
