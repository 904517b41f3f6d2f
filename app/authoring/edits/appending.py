"""New nodes behind what is selected: what they are linked with, and where they lie."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from ...errors import GraphError
from ...graph import OUTPUTS, Graph, Port, signature
from .element_id import ElementId
from .elements import Place, Sizes, entry, list_elements, with_places
from .layout import GAP, find_free_place, positions
from .sizes import element_size
from .surface_layers import connect_layers
from .wiring import first_source, why_not_linkable

_HEADER, _ROW, _PICTURE, _MOST_FIELDS = 32.0, 24.0, 116.0, 5
"""The header, a row, and a thumbnail with its borders as the canvas draws them, and the fields that it shows at most:
the room that a node needs before anybody has measured it."""


def list_alike(graph: Graph, source_id: str, target_id: str) -> dict[Port, Port]:
    """The free inputs of one node that have the name of an output of the other, which fits; with that output."""
    if source_id not in graph.nodes or target_id not in graph.nodes:
        return {}
    outputs = signature(graph.nodes[source_id]).outputs
    inputs = [Port(target_id, name) for name in signature(graph.nodes[target_id]).unfolded_inputs if name in outputs]
    pairs = {port: Port(source_id, port.socket) for port in inputs if port not in graph.links}
    return {target: source for target, source in pairs.items() if why_not_linkable(graph, source, target) is None}


def connect_alike(graph: Graph, source_id: str, target_id: str, absent: Collection[Port] = ()) -> Graph:
    """A graph where all sockets of the same name of two nodes are linked, as far as they are free and fit.

    Those of `absent`, which have nothing to give, are left out.
    """
    for target, source in list_alike(graph, source_id, target_id).items():
        if source not in absent:
            graph = graph.connect(source, target)
    return graph


def append_node(
    graph: Graph, id: str, feeders: Iterable[ElementId], sizes: Sizes | None = None, absent: Collection[Port] = ()
) -> Graph:
    """A graph where node `id`, which has no links, is fed by the first socket of each element that fits one of its own.

    Layers of a render that it has sockets for come from behind the feeders, too. It lies right of the first of them in
    free room. Where that fed nothing but outputs of the graph, the new node stands between: the picture that comes out
    is that of the longer chain. Where nothing feeds an output of the graph, the node does. Without feeders that fit, it
    only moves away from what it would cover.
    """
    feeders = list(feeders)
    for element in feeders:
        graph = connect_alike(graph, element, id, absent)
    graph = connect_layers(graph, id, feeders, absent)
    fed = {ElementId.of_port(source) for target, source in graph.links.items() if target.node == id}
    for element in feeders:
        graph = graph if element in fed else _feed_first(graph, element, id, absent)
    sources = [source for target, source in graph.links.items() if target.node == id]
    direct = next((source for element in feeders for source in sources if ElementId.of_port(source) == element), None)
    if direct is not None:
        graph = _move_outputs_behind(graph, direct, id)
    graph = _feed_first_output(graph, id)
    behind = ElementId.of_port(direct) if direct is not None else feeders[0] if sources else None
    return _place_node(graph, ElementId(id), behind, sizes)


def feed_element(graph: Graph, target: ElementId, feeders: Iterable[ElementId], absent: Collection[Port] = ()) -> Graph:
    """A graph where elements feed a node, or an output of the graph, by sockets that are free; those that fit nothing
    are left out. Outputs in `absent` have nothing to give.
    """
    for element in feeders:
        if target in graph.nodes:
            graph = _feed(graph, element, target, absent)
        elif (end := target.port) is not None and target.kind == "output" and end not in graph.links:
            try:
                source = first_source(graph, element, end) if element in graph.nodes else element.port
                graph = graph.connect(source, end) if source is not None else graph
            except GraphError:
                continue
    return graph


def estimate_sizes(graph: Graph, sizes: Sizes | None = None) -> dict[ElementId, tuple[float, float]]:
    """Width and height of all elements: as measured, else what they need with a thumbnail."""
    return {element: _estimate_size(graph, element) for element in list_elements(graph)} | dict(sizes or {})


def _estimate_size(graph: Graph, element: ElementId) -> tuple[float, float]:
    width, height = element_size(graph, element)
    if element not in graph.nodes or entry(graph, element).get("collapsed") is True:
        return width, height
    interface = signature(graph.nodes[element])
    fields = [value for value in interface.values.values() if not value.folded]
    rows = max(len(interface.unfolded_inputs), len(interface.outputs)) + min(len(fields), _MOST_FIELDS)
    return width, _HEADER + rows * _ROW + _PICTURE


def _feed(graph: Graph, element: ElementId, id: str, absent: Collection[Port]) -> Graph:
    """A graph where an element feeds a node: by sockets of the same name, else by its first output that fits."""
    alike = connect_alike(graph, element, id, absent)
    return alike if alike is not graph else _feed_first(graph, element, id, absent)


def _feed_first(graph: Graph, element: ElementId, id: str, absent: Collection[Port]) -> Graph:
    """A graph where the first output of an element that fits feeds a node."""
    if element in graph.nodes:
        ports = (Port(element, name) for name in signature(graph.nodes[element]).outputs)
        outputs = [port for port in ports if port not in absent]
    else:
        outputs = [element.port] if element.port and element.kind == "input" else []
    for output in outputs:
        target = _find_free_input(graph, output, id)
        if target is not None:
            return graph.connect(output, target)
    return graph


def _find_free_input(graph: Graph, source: Port, id: str) -> Port | None:
    """The first input that `source` fits and nothing feeds; those that need a link come first."""
    inputs = signature(graph.nodes[id]).unfolded_inputs
    ports = sorted((Port(id, name) for name in inputs), key=lambda port: inputs[port.socket].optional)
    free = (port for port in ports if port not in graph.links)
    return next((port for port in free if why_not_linkable(graph, source, port) is None), None)


def _move_outputs_behind(graph: Graph, source: Port, id: str) -> Graph:
    """A graph where the outputs that `source` fed are fed by node `id`, if it fed nothing else and the node fits."""
    readers = [target for target, start in graph.links.items() if start == source and target.node != id]
    if not readers or any(target.node != OUTPUTS for target in readers):
        return graph
    for target in readers:
        try:
            graph = graph.connect(first_source(graph, id, target), target)
        except GraphError:
            continue
    return graph


def _feed_first_output(graph: Graph, id: str) -> Graph:
    """A graph where node `id` feeds the first output that it fits, if nothing feeds any: it begins the picture."""
    if any(target.node == OUTPUTS for target in graph.links):
        return graph
    for name in graph.outputs:
        target = Port(OUTPUTS, name)
        try:
            return graph.connect(first_source(graph, id, target), target)
        except GraphError:
            continue
    return graph


def _place_node(graph: Graph, node: ElementId, behind: ElementId | None, sizes: Sizes | None) -> Graph:
    """A graph where a new node lies in free room: right of the element `behind`, else where it was put."""
    measured = estimate_sizes(graph, sizes)
    places = positions(graph, measured)
    spot: Place = places.pop(node)
    readers = [target for target, start in graph.links.items() if start.node == node]
    if behind is not None:
        spot = places[behind][0] + element_size(graph, behind, measured)[0] + GAP[0], places[behind][1]
    # The outputs that it feeds now give way to the right; everything else stays where it is.
    ends = dict.fromkeys(ElementId.of_port(target) for target in readers)
    spots = {end: places.pop(end) for end in ends}
    places[node] = find_free_place(graph, node, spot, places, measured)
    right = places[node][0] + measured[node][0] + GAP[0]
    for end, (x, y) in spots.items():
        places[end] = find_free_place(graph, end, (max(x, right), y), places, measured)
    return with_places(graph, {key: places[key] for key in (node, *ends)})
