"""Links: which sockets fit, and nodes that are put into links or taken out of them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

from halation.nodes import Kind, Node, Pointwise, Socket, Value, is_length

from ...errors import GraphError
from ...graph import Graph, Item, Port, conversion, make_socket, signature
from ...graph.values import coerce, value_fault
from ...graph.walk import describe_loop, find_route
from ...language.translation import translate
from .element_id import ElementId
from .elements import place
from .routes import dots_on_link as dots_of
from .routes import split_route, with_routes

Types = Mapping[str, type[Node]]


def why_not_linkable(graph: Graph, source: Port, target: Port) -> str | None:
    """Why a link is impossible, loops included; None if it is possible."""
    if fault := graph.link_fault(source, target):
        return fault
    loop = find_route(target.node, source.node, graph.fed)
    return describe_loop((*loop, target.node)) if loop else None


def list_targets(item: Item, id: str) -> tuple[Port, ...]:
    """The sockets of a node that take a link: inputs, then values."""
    interface = signature(item)
    wireable = interface.values if interface.pointwise or not isinstance(item, Node) else {}
    values = [name for name, value in wireable.items() if value.wireable]
    return tuple(Port(id, name) for name in (*interface.inputs, *values))


def first_target(graph: Graph, source: Port, id: str, values: bool = True) -> Port:
    """The first input of a node, or with `values` any socket, that `source` can feed; free ones come first.

    Raises GraphError.
    """
    names = signature(graph.node(id)).unfolded_inputs
    ports = [port for port in list_targets(graph.node(id), id) if values or port.socket in names]
    free = [port for port in ports if port not in graph.links and not _is_folded(graph, port)]
    fitting = [port for port in (*free, *ports) if why_not_linkable(graph, source, port) is None]
    if not fitting:
        raise GraphError(
            translate(
                "'{source}' fits no input of node '{id}'{reason}",
                source=source,
                id=id,
                reason=_explain_refusal(graph, source, ports),
            )
        )
    return fitting[0]


def _is_folded(graph: Graph, port: Port) -> bool:
    """True for a port of the mask that many nodes have, which is linked only where the user asks for it."""
    interface = signature(graph.node(port.node))
    item = interface.inputs.get(port.socket) or interface.values.get(port.socket)
    return item is not None and item.folded


def first_source(graph: Graph, id: str, target: Port) -> Port:
    """The first output of a node that can feed `target`. Raises GraphError."""
    ports = [Port(id, name) for name in signature(graph.node(id)).outputs]
    fitting = [port for port in ports if why_not_linkable(graph, port, target) is None]
    if not fitting:
        why = f": {why_not_linkable(graph, ports[0], target)}" if ports else translate(": it has no outputs")
        raise GraphError(translate("no output of node '{id}' fits '{target}'{why}", id=id, target=target, why=why))
    return fitting[0]


def link_node(graph: Graph, id: str, port: Port, output: bool) -> Graph:
    """A graph where a node is linked with `port`, a source if `output`, by the first socket that fits."""
    if output:
        return graph.connect(port, first_target(graph, port, id))
    return graph.connect(first_source(graph, id, port), port)


def list_fitting_types(graph: Graph, port: Port, is_output: bool, types: Types) -> tuple[str, ...]:
    """Ids of node types that could be linked with `port`, a source if `output`, in the order of `types`."""
    if is_output:
        start = graph.source(port)
        return tuple(
            id
            for id, kind in types.items()
            if any(start is None or conversion(start, end) is None for end in _wireable_ends(kind))
        )
    end = graph.target(port)
    return tuple(
        id
        for id, kind in types.items()
        if any(end is None or conversion(output.socket, end) is None for output in kind.outputs.values())
    )


def fits(graph: Graph, port: Port, output: bool, item: Item) -> bool:
    """True if a node or group could be linked with `port`, a source if `output`."""
    id = graph.fresh_id("new")
    try:
        link_node(graph.add(id, item), id, port, output)
    except GraphError:
        return False
    return True


def fits_picture(graph: Graph, port: Port, output: bool) -> bool:
    """True if a port could be linked with a picture, as a source if `output`."""
    if output:
        start = graph.source(port)
        return start is None or conversion(start, make_socket(Kind.IMAGE)) is None
    end = graph.target(port)
    return end is None or conversion(make_socket(Kind.IMAGE), end) is None


def insert_node(graph: Graph, id: str, target: Port) -> Graph:
    """A graph where node `id` stands in the link that feeds `target`; dots left of it stay before it."""
    return _put_chain_between(graph, id, id, target)


def splice_chain(graph: Graph, ids: Collection[str], target: Port) -> Graph:
    """A graph where a chain of nodes stands in the link that feeds `target`. Raises GraphError if they are no chain."""
    for end, start in graph.links.items():
        if (end.node in ids) != (start.node in ids):
            inner = end.node if end.node in ids else start.node
            raise GraphError(
                translate(
                    "node '{inner}' is linked with others: extract the selection to put it into a link", inner=inner
                )
            )
    inner = [(start.node, end.node) for end, start in graph.links.items() if end.node in ids]
    fed, feeding = {end for _, end in inner}, {start for start, _ in inner}
    last = [id for id in graph.nodes if id in ids and id not in feeding]
    first = [id for id in graph.nodes if id in ids and id not in fed and list_targets(graph.nodes[id], id)]
    if len(last) != 1 or len(first) != 1:
        raise GraphError(
            translate("these nodes are not a chain: only a chain with one first and one last node fits into a link")
        )
    return _put_chain_between(graph, first[0], last[0], target)


def _put_chain_between(graph: Graph, first: str, last: str, target: Port) -> Graph:
    """A graph where a chain from node `first` to node `last` stands in the link that feeds `target`."""
    source = graph.links.get(target)
    if source is None:
        raise GraphError(
            translate("nothing is linked to '{target}': a node can only be put into a link", target=target)
        )
    for id in (first, last):
        if id in (source.node, target.node):
            raise GraphError(translate("node '{id}' is an end of that link already", id=id))
    dots = dots_of(graph, target)
    entrance = first_target(graph.disconnect(target), source, first, values=False)
    after = graph.disconnect(target).connect(source, entrance)
    after = after.connect(first_source(after, last, target), target)
    spot = place(graph, ElementId(first))
    left, right = split_route(graph, dots, spot[0]) if spot else (dots, ())
    return with_routes(after, {entrance: left, target: right})


def remove_node(graph: Graph, id: str, heal: bool = True) -> Graph:
    """A graph without a node. With `heal` its links are joined where they fit, and so are their dots."""
    after = graph.remove(id, heal)
    into = {graph.links[Port(id, name)]: Port(id, name) for name in reversed(_list_linked_inputs(graph, id))}
    joined: dict[Port, tuple[str, ...]] = {}
    for target, source in graph.links.items():
        if source.node == id and (source := after.links.get(target)) in into:
            joined[target] = (*dots_of(graph, into[source]), *dots_of(graph, target))
    return with_routes(after, joined) if any(joined.values()) else after


def extract_nodes(graph: Graph, ids: Collection[str]) -> Graph:
    """A graph where nodes left their chains: they keep the links among themselves, the others are joined."""
    after = graph
    for id in ids:
        after = remove_node(after, id)
    inner = {end: start for end, start in graph.links.items() if end.node in ids and start.node in ids}
    if inner.keys() | after.links.keys() == graph.links.keys() and {**after.links, **inner} == graph.links:
        raise GraphError(translate("these nodes are in no chain: they have no links to other nodes"))
    routes = {end: dots_of(after, end) for end in after.links} | {end: dots_of(graph, end) for end in inner}
    return with_routes(
        replace(graph, links={**after.links, **inner}), routes | {end: () for end in graph.links if end not in routes}
    )


def cut_links(graph: Graph, ends: Iterable[Port]) -> Graph:
    """A graph without the links to `ends`."""
    for target in sorted(set(ends)):
        graph = graph.disconnect(target)
    return graph


def move_link(graph: Graph, old: Port, new: Port) -> Graph:
    """A graph where a link feeds another socket."""
    source = graph.links.get(old)
    if source is None:
        raise GraphError(translate("nothing is linked to '{old}'", old=old))
    dots = dots_of(graph, old)
    return graph if old == new else with_routes(graph.disconnect(old).connect(source, new), {new: dots})


def swap_inputs(graph: Graph, id: str) -> Graph:
    """A graph where the sources of a node's first two inputs changed places."""
    names = tuple(signature(graph.node(id)).unfolded_inputs)[:2]
    ports = [Port(id, name) for name in names]
    sources = [graph.links.get(port) for port in ports]
    if len(ports) < 2 or sources == [None, None]:
        raise GraphError(
            translate("node '{id}' has fewer than two inputs to swap", id=id)
            if len(ports) < 2
            else translate("nothing is linked to '{id}'", id=id)
        )
    routes = [dots_of(graph, port) for port in ports]
    after = cut_links(graph, [port for port in ports if port in graph.links])
    for port, source in zip(ports, reversed(sources), strict=True):
        after = after.connect(source, port) if source else after
    return with_routes(after, dict(zip(ports, reversed(routes), strict=True)))


def replace_node(graph: Graph, id: str, kind: type[Node]) -> Graph:
    """A graph where a node has another type; links stay where they fit, values where name and type agree."""
    item = graph.node(id)
    before = signature(item).values
    units = dict(item.length_units) if isinstance(item, Node) else {}
    kept_units = tuple((name, units[name]) for name in units if name in kind.values and is_length(kind.values[name]))
    blank = kind().with_length_units(kept_units)
    values = {name: blank.declaration(name).default for name, _ in kept_units}
    for name, value in kind.values.items():
        if name in before and before[name].type == value.type:
            fitted_value = coerce(value, graph.value(Port(id, name)))
            if fitted_value is not None and value_fault(blank.declaration(name), fitted_value) is None:
                values[name] = fitted_value
    return graph.replace(id, blank.with_values(**values))


def _wireable_ends(kind: type[Node]) -> list[Socket | Value]:
    wires = [value for value in kind.values.values() if value.wireable] if issubclass(kind, Pointwise) else []
    return [*kind.inputs.values(), *wires]


def _list_linked_inputs(graph: Graph, id: str) -> list[str]:
    interface = signature(graph.node(id))
    names = interface.inputs or sorted(port.socket for port in graph.links if port.node == id)
    return [name for name in names if Port(id, name) in graph.links]


def _explain_refusal(graph: Graph, source: Port, ports: list[Port]) -> str:
    return f": {why_not_linkable(graph, source, ports[0])}" if ports else translate(": it has none")
