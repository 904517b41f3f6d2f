"""Makes a graph from some nodes of another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from halation.nodes import Image

from ..errors import GraphError
from .graph import Graph
from .lookup import find_node_output
from .model import Input, Output, Port
from .names import INPUTS, OUTPUTS, did_you_mean


def select_nodes(graph: Graph, ids: Sequence[str]) -> Graph:
    """A graph of some nodes of another. Links into them become its inputs; its output is that of the last node.

    The last node is the only one that no other of them reads. Raises GraphError for an unknown node, and if there is
    more than one last node.
    """
    for id in ids:
        if id not in graph.nodes:
            raise GraphError(f"there is no node '{id}'{did_you_mean(id, graph.nodes)}", node=id)
    selected_ids = set(ids)
    links_into = {target: source for target, source in graph.links.items() if target.node in selected_ids}
    last_nodes = [id for id in selected_ids if not any(source.node == id for source in links_into.values())]
    if len(last_nodes) != 1:
        raise GraphError(
            f"a selection has one last node, not {len(last_nodes)} ({', '.join(sorted(last_nodes))}): select others"
        )
    inputs: dict[str, Input] = {}
    names: dict[Port, str] = {}
    links: dict[Port, Port] = {}
    for target, source in links_into.items():
        if source.node in selected_ids:
            links[target] = source
            continue
        if source not in names:
            names[source] = _choose_name(source, inputs)
            inputs[names[source]] = _make_input(graph, source)
        links[target] = Port(INPUTS, names[source])
    output_port = find_node_output(graph, last_nodes[0])
    output_socket = graph.source(output_port) or Image()
    links[Port(OUTPUTS, "image")] = output_port
    return replace(
        graph,
        nodes={id: item for id, item in graph.nodes.items() if id in selected_ids},
        links=links,
        inputs=inputs,
        outputs={"image": Output(output_socket.kind, output_socket.channels)},
        controls={name: item for name, item in graph.controls.items() if item.target.node in selected_ids},
        animation={port: item for port, item in graph.animation.items() if port.node in selected_ids},
        muted=graph.muted & selected_ids,
    )


def _make_input(graph: Graph, source: Port) -> Input:
    if source.node == INPUTS:
        return graph.inputs[source.socket]
    socket = graph.source(source) or Image()
    return Input(socket.kind, socket.channels)


def _choose_name(source: Port, inputs: dict[str, Input]) -> str:
    name = source.socket if source.node == INPUTS else source.node
    free_name, again = name, 1
    while free_name in inputs:
        again += 1
        free_name = f"{name}{again}"
    return free_name
