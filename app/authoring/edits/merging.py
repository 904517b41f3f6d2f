"""Adds the content of one graph to another, under free ids."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from halation.nodes import Node
from msgspec import Struct, structs

from ...graph import INPUTS, OUTPUTS, Graph, Port
from ...graph.notes import keys_of_nodes
from ...graph.unit_conversion import pin_length_units
from . import timing
from .element_id import DECOR, ElementId
from .elements import Places, entry, list_decor, with_entries, with_places
from .naming import name_copy
from .routes import routes, with_routes


class MergedPart(Struct, frozen=True):
    """`graph` has everything; `names` has the new ids of the nodes and decor of the part."""

    graph: Graph
    names: Mapping[ElementId, ElementId]

    def port(self, port: Port) -> Port | None:
        """Where a port of a node of the part is now; None for ports that are no node's."""
        node = ElementId(port.node)
        return Port(self.names[node].name, port.socket) if node in self.names else None


def merge_part(graph: Graph, part: Graph, places: Places) -> MergedPart:
    """`graph` with the nodes and decor of `part` at `places`, and the links among those nodes.

    Paths of `part` must start where those of `graph` do. Ends, controls and links from elsewhere are left out. Names
    that are taken get a number, and everything that names a node follows: links, expressions, layout, dots on links.
    Lengths keep their meaning.
    """
    part = pin_length_units(part, graph.settings.reference_height)
    taken_names = {*graph.nodes, INPUTS, OUTPUTS}
    names: dict[str, str] = {}
    for id, item in part.nodes.items():
        names[id] = name_copy(id, taken_names, item.id if isinstance(item, Node) else "")
        taken_names.add(names[id])
    links = {
        Port(names[end.node], end.socket): Port(names[start.node], start.socket)
        for end, start in part.links.items()
        if end.node in names and start.node in names
    }
    after = replace(
        graph,
        nodes={**graph.nodes, **{names[id]: item for id, item in part.nodes.items()}},
        links={**graph.links, **links},
        muted=graph.muted | {names[id] for id in part.muted if id in names},
        extra={**graph.extra, **_extra(part, names)},
        animation={
            **graph.animation,
            **{
                Port(names[port.node], port.socket): timing.rename_in_expression(item, names)
                for port, item in part.animation.items()
                if port.node in names
            },
        },
    )
    new_ids = {ElementId(old): ElementId(new) for old, new in names.items()}
    for kind in DECOR:
        for old, facts in list_decor(part, kind).items():
            used_names = {decor.name for decor in list_decor(after, kind)}
            new_ids[old] = ElementId.of(kind, name_copy(old.name, used_names))
            after = with_entries(after, {new_ids[old]: facts})
    nodes = map(ElementId, part.nodes)
    after = with_entries(after, {new_ids[node]: facts for node in nodes if (facts := entry(part, node))})
    after = with_places(after, {new_ids[old]: spot for old, spot in places.items() if old in new_ids})
    merged_part = MergedPart(after, new_ids)
    ends = {str(end): end for end in part.links if end.node in names and part.links[end].node in names}
    new_routes = {
        Port(names[ends[target].node], ends[target].socket): rename_dots(merged_part, dots)
        for target, dots in routes(part).items()
        if target in ends
    }
    return structs.replace(merged_part, graph=with_routes(merged_part.graph, new_routes)) if new_routes else merged_part


def rename_dots(merged_part: MergedPart, dots: tuple[str, ...]) -> tuple[str, ...]:
    """The dots of the part, under their new ids."""
    return tuple(merged_part.names[ElementId.of("dot", dot)].name for dot in dots)


def _extra(part: Graph, names: Mapping[str, str]) -> dict[str, Mapping[str, object]]:
    """Unknown keys of the nodes, under their new ids."""
    extra: dict[str, Mapping[str, object]] = {}
    for path, facts in keys_of_nodes(part.extra, names).items():
        section, id, *inside = path.split(".", 2)
        extra[".".join((section, names[id], *inside))] = facts
    return extra
