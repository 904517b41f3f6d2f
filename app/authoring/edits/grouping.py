"""Turns nodes into a group: a graph of its own, with inputs and outputs where links crossed its border."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

from halation.nodes import Kind, Socket, Value
from msgspec import Struct, field

from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Control, Graph, Group, Input, Output, Port, Settings, signature
from ...graph.names import check_name, fresh_name
from ...graph.notes import keys_of_nodes
from ...language.translation import translate
from . import timing
from .element_id import ElementId
from .elements import (
    Place,
    Places,
    entry,
    list_elements,
    place,
    with_entries,
    with_places,
    with_sections,
    without_entries,
)
from .layout import GAP, bounds, positions
from .ports import read_port
from .routes import routes, tidy_routes
from .sizes import WIDTH, element_size

_KINDS = {"float": Kind.FIELD, "int": Kind.FIELD, "bool": Kind.FIELD, "color": Kind.IMAGE, "vector": Kind.VECTOR}
"""The kind of an input that feeds a value of that type."""


def make_group(graph: Graph, chosen: Collection[ElementId], name: str = "") -> tuple[Graph, str]:
    """A graph where the chosen nodes and decor are a group, and its id.

    Every source outside that feeds chosen nodes becomes an input, every output of theirs that is read outside an
    output, named after the sockets; where nothing is read outside, the first output of each node at an end becomes one.
    Controls go on working. Raises GraphError where the group would feed itself.
    """
    ids = [id for id in graph.nodes if id in chosen]
    if not ids:
        raise GraphError(translate("no node is selected: select the nodes to group"))
    _check_no_way_back(graph, set(ids))
    rest = {id: item for id, item in graph.nodes.items() if id not in chosen}
    id = fresh_name(name or "group", {*rest, INPUTS, OUTPUTS})
    check_name(id, "node")
    crossing = _find_crossings(graph, set(ids))
    spots = positions(graph)
    body = _body(graph, ids, chosen, crossing, spots)
    inner, around = timing.split_animation(graph, ids, id)
    body = replace(body, animation=inner)
    outer = replace(
        graph,
        nodes={**rest, id: Group(body)},
        links={end: start for end, start in graph.links.items() if end.node not in ids and start.node not in ids}
        | {Port(id, socket): source for socket, source in crossing.sources.items()}
        | {
            end: Port(id, crossing.leaving[start])
            for end, start in graph.links.items()
            if start.node in ids and end.node not in ids
        },
        controls={
            name: item.with_target(Port(id, name)) if item.target.node in ids else item
            for name, item in graph.controls.items()
        },
        muted=graph.muted - set(ids),
        animation=around,
        extra=_extra(graph, ids, inside=False),
        ui=_outer_ui(graph, id, ids, crossing),
    )
    timing.check_names(graph, body, inner)
    timing.check_names(graph, outer, around)
    notes = [key for key in list_elements(graph) if key in chosen and key.is_note]
    return tidy_routes(with_places(without_entries(outer, notes), {ElementId(id): group_corner(graph, ids, spots)})), id


def group_corner(graph: Graph, ids: Iterable[str], spots: Places) -> Place:
    """Where a group goes that stands for some nodes: their center, less half a node."""
    left, top, right, bottom = bounds(graph, map(ElementId, ids), spots)
    return round((left + right - WIDTH) / 2.0, 2), round((top + bottom) / 2.0 - GAP[1], 2)


class _Crossing(Struct):
    """The ends of a group: names by what crosses its border."""

    inputs: dict[str, Input] = field(default_factory=dict[str, Input])
    outputs: dict[str, Output] = field(default_factory=dict[str, Output])
    sources: dict[str, Port] = field(default_factory=dict[str, Port])
    """What feeds each input from outside."""
    entering: dict[Port, str] = field(default_factory=dict[Port, str])
    """The input that each target inside is fed by."""
    leaving: dict[Port, str] = field(default_factory=dict[Port, str])
    """The output that shows each source inside."""


def _find_crossings(graph: Graph, ids: set[str]) -> _Crossing:
    crossing = _Crossing()
    input_names: dict[tuple[Port, Kind, int], str] = {}
    control_names = {name for name, item in graph.controls.items() if item.target.node in ids}
    for target, source in sorted(graph.links.items(), key=lambda link: _vertical_order(graph, link[0])):
        if target.node in ids and source.node not in ids:
            kind, width = _kind(graph, source, target)
            name = input_names.get((source, kind, width))
            if name is None:
                name = fresh_name(target.socket, {*crossing.inputs, *control_names})
                input_names[source, kind, width] = name
                crossing.inputs[name], crossing.sources[name] = Input(kind, width), source
            crossing.entering[target] = name
        elif source.node in ids and target.node not in ids and source not in crossing.leaving:
            name = fresh_name(source.socket, crossing.outputs)
            crossing.outputs[name] = Output(*_kind(graph, source, target))
            crossing.leaving[source] = name
    if not crossing.leaving:
        _add_ends(graph, ids, crossing)
    return crossing


def _add_ends(graph: Graph, ids: set[str], crossing: _Crossing) -> None:
    """Outputs for the nodes that feed nothing, so that a group that nobody reads yet has something to give."""
    feeding = {start.node for start in graph.links.values()}
    for id in sorted(ids - feeding):
        for name, socket in list(signature(graph.nodes[id]).outputs.items())[:1]:
            output = fresh_name(name, crossing.outputs)
            crossing.outputs[output] = Output(socket.kind, socket.channels)
            crossing.leaving[Port(id, name)] = output


def _vertical_order(graph: Graph, target: Port) -> tuple[float, float, Port]:
    """Targets from top to bottom, so that the sockets of a group lie as its links did."""
    spot = place(graph, ElementId(target.node)) or (0.0, 0.0)
    return spot[1], spot[0], target


def _kind(graph: Graph, source: Port, target: Port) -> tuple[Kind, int]:
    """The type of an end in a link: that of the source, else one that the target takes."""
    for ask, port in ((graph.source, source), (graph.target, target)):
        try:
            socket: Socket | Value | None = ask(port)
        except GraphError:
            continue
        if isinstance(socket, Socket):
            return socket.kind, socket.channels
        if isinstance(socket, Value):
            return _KINDS.get(socket.type, Kind.IMAGE), max(socket.length, 2)
    return Kind.IMAGE, 4


def _body(graph: Graph, ids: list[str], chosen: Collection[ElementId], crossing: _Crossing, spots: Places) -> Graph:
    """The graph inside a new group. Dots of links that lie inside move with them, and so do chosen frames and
    comments. It takes over only the reference height, as lengths depend on it; a group has no size or frames of its
    own.
    """
    links = {end: start for end, start in graph.links.items() if end.node in ids and start.node in ids}
    links |= {end: Port(INPUTS, name) for end, name in crossing.entering.items()}
    links |= {Port(OUTPUTS, name): start for start, name in crossing.leaving.items()}
    body = Graph(
        nodes={id: graph.nodes[id] for id in ids},
        links=links,
        inputs=crossing.inputs,
        outputs=crossing.outputs,
        controls={
            name: Control(item.target, item.label, item.doc)
            for name, item in graph.controls.items()
            if item.target.node in ids
        },
        muted=graph.muted & set(ids),
        settings=Settings(reference_height=graph.settings.reference_height),
        extra=_extra(graph, ids, inside=True),
        folder=graph.folder,
    )
    inner = {str(end) for end in graph.links if end.node in ids and graph.links[end].node in ids}
    passed = {target: dots for target, dots in routes(graph).items() if target in inner}
    dots = {ElementId.of("dot", dot) for route in passed.values() for dot in route}
    moved = [key for key in list_elements(graph) if key in ids or key in dots or (key in chosen and key.is_note)]
    body = with_entries(body, {key: entry(graph, key) for key in moved})
    return tidy_routes(with_places(with_sections(body, {"routes": passed}), _spots(body, graph, ids, spots)))


def _spots(body: Graph, graph: Graph, ids: list[str], spots: Places) -> dict[ElementId, Place]:
    """Nodes where they were, inputs left of them, outputs right of them."""
    left, top, right, _ = bounds(graph, map(ElementId, ids), spots)
    places = {ElementId(id): spots[ElementId(id)] for id in ids}
    inputs = [ElementId.of("input", name) for name in body.inputs]
    outputs = [ElementId.of("output", name) for name in body.outputs]
    for ends, x in ((inputs, left - WIDTH - GAP[0]), (outputs, right + GAP[0])):
        y = top
        for end in ends:
            places[end] = (x, y)
            y += element_size(body, end)[1] + GAP[1]
    return places


def _outer_ui(graph: Graph, id: str, ids: list[str], crossing: _Crossing) -> Mapping[str, object]:
    """`ui` where routes and viewers of crossing links belong to the group."""
    all_routes, inside = routes(graph), {str(end) for end in graph.links if end.node in ids}
    outer_routes = {target: dots for target, dots in all_routes.items() if target not in inside}
    for target, name in crossing.entering.items():
        if str(target) in all_routes:
            outer_routes.setdefault(f"{id}.{name}", all_routes[str(target)])
    viewers = graph.ui.get("viewers")
    leaving = {str(start): f"{id}.{name}" for start, name in crossing.leaving.items()}
    outer_viewers = {
        number: leaving.get(str(port), port)
        for number, port in (viewers.items() if isinstance(viewers, Mapping) else ())
        if str(port) in leaving or (viewed := read_port(port)) is None or viewed.node not in ids
    }
    after = with_sections(graph, {"routes": outer_routes, "viewers": outer_viewers})
    return without_entries(after, map(ElementId, ids)).ui


def _extra(graph: Graph, ids: Collection[str], inside: bool) -> dict[str, Mapping[str, object]]:
    """Unknown keys of some nodes, or all others."""
    of_nodes = keys_of_nodes(graph.extra, ids)
    return of_nodes if inside else {path: facts for path, facts in graph.extra.items() if path not in of_nodes}


def _check_no_way_back(graph: Graph, ids: set[str]) -> None:
    """Raise GraphError if a path leaves the nodes and comes back."""
    after = set[str]().union(*(graph.downstream(id) for id in ids)) - ids
    before = set[str]().union(*(graph.upstream(id) for id in ids)) - ids
    if between := sorted(after & before):
        raise GraphError(
            translate(
                "these nodes cannot become a group, because it would feed itself: '{node}' lies between "
                "them; select it too, or deselect the nodes that it feeds",
                node=between[0],
            )
        )
