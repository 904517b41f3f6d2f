"""Takes nodes out of a graph as a graph of their own, which works wherever it is used."""

from __future__ import annotations

from collections.abc import Collection

from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Group, Input, Item, Output, Port, Unknown, signature
from ...graph.names import fresh_name
from ...language.translation import translate
from .element_id import ElementId
from .grouping import make_group


def extract_graph(graph: Graph, chosen: Collection[ElementId]) -> Graph:
    """The chosen nodes as a graph: what they read from outside are inputs, what nothing in them reads are outputs.

    One group alone gives what is in it. Raises GraphError if no node is chosen, or if they cannot be a group.
    """
    ids = [id for id in graph.nodes if id in chosen]
    alone = graph.nodes[ids[0]] if len(ids) == 1 else None
    if isinstance(alone, Group):
        return alone.body()
    grouped, id = make_group(graph, chosen)
    group = grouped.nodes[id]
    assert isinstance(group, Group)
    return _with_free_outputs(_with_free_inputs(group.body()))


def _with_free_inputs(body: Graph) -> Graph:
    """The graph with an input for each socket that must be linked and is not."""
    for id, item in _list_known_items(body):
        for socket in signature(item).inputs.values():
            port = Port(id, socket.name)
            if not socket.optional and port not in body.links:
                name = fresh_name(socket.name, {*body.inputs, *body.controls})
                body = body.add_input(name, Input(socket.kind, socket.channels)).connect(Port(INPUTS, name), port)
    return body


def _with_free_outputs(body: Graph) -> Graph:
    """The graph with an output for the first result of each node that nothing reads."""
    read = {source.node for source in body.links.values()}
    for id, item in _list_known_items(body):
        socket = next(iter(signature(item).outputs.values()), None)
        if id not in read and socket is not None:
            name = fresh_name(socket.name, body.outputs)
            body = body.add_output(name, Output(socket.kind, socket.channels))
            body = body.connect(Port(id, socket.name), Port(OUTPUTS, name))
    if not body.outputs:
        raise GraphError(translate("these nodes have no result: select nodes that make a picture or a number"))
    return body


def _list_known_items(body: Graph) -> list[tuple[str, Item]]:
    return [(id, item) for id, item in body.nodes.items() if not isinstance(item, Unknown)]
