"""Some nodes of a graph as a graph of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..errors import GraphError
from .graph import Graph, signature
from .lookup import node_output
from .model import Input, Output, Port
from .names import INPUTS, OUTPUTS, did_you_mean


def selected(graph: Graph, ids: Sequence[str]) -> Graph:
    """A graph of these nodes, whose inputs are what feeds them and whose one output is that of the last of them.

    The last is the one that no other of them reads. Raises GraphError for a name that is no node, and where several
    nodes are last.
    """
    for id in ids:
        if id not in graph.nodes:
            raise GraphError(f"there is no node '{id}'{did_you_mean(id, graph.nodes)}", node=id)
    kept = set(ids)
    inside = {target: source for target, source in graph.links.items() if target.node in kept}
    ends = [id for id in kept if not any(source.node == id for source in inside.values())]
    if len(ends) != 1:
        raise GraphError(f"a selection has one last node, not {len(ends)} ({', '.join(sorted(ends))}): select others")
    inputs: dict[str, Input] = {}
    names: dict[Port, str] = {}
    links: dict[Port, Port] = {}
    for target, source in inside.items():
        if source.node in kept:
            links[target] = source
            continue
        if source not in names:
            names[source] = _free(source, inputs)
            inputs[names[source]] = _end(graph, source)
        links[target] = Port(INPUTS, names[source])
    last = node_output(graph, ends[0])
    made = signature(graph.node(last.node)).outputs[last.socket]
    links[Port(OUTPUTS, "image")] = last
    return replace(
        graph,
        nodes={id: item for id, item in graph.nodes.items() if id in kept},
        links=links,
        inputs=inputs,
        outputs={"image": Output(made.kind, made.channels)},
        controls={name: item for name, item in graph.controls.items() if item.target.node in kept},
        animation={port: item for port, item in graph.animation.items() if port.node in kept},
        muted=graph.muted & kept,
    )


def _end(graph: Graph, source: Port) -> Input:
    if source.node == INPUTS:
        return graph.inputs[source.socket]
    socket = signature(graph.node(source.node)).outputs[source.socket]
    return Input(socket.kind, socket.channels)


def _free(source: Port, taken: dict[str, Input]) -> str:
    name = source.socket if source.node == INPUTS else source.node
    found, again = name, 1
    while found in taken:
        again += 1
        found = f"{name}{again}"
    return found
