"""The content of one graph put into another, under ids that are free there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from halation.nodes import Node

from ...graph import INPUTS, OUTPUTS, Graph, Port
from . import timing
from .elements import DECOR, Place, entries, entry, with_entries, with_places
from .naming import name_copy
from .routes import routes, with_routes


@dataclass(frozen=True)
class MergedPart:
    """`graph` holds everything; `keys` says what nodes and decor of the part are called there."""

    graph: Graph
    keys: Mapping[str, str]

    def port(self, port: Port) -> Port | None:
        """Where a port of a node of the part is now; None for ports that are no node's."""
        return Port(self.keys[port.node], port.socket) if port.node in self.keys else None


def merge_part(graph: Graph, part: Graph, places: Mapping[str, Place]) -> MergedPart:
    """`graph` with the nodes and decor of `part` at `places`, and the links among those nodes.

    Paths of `part` must start where those of `graph` do. Ends, controls and links from elsewhere are left out.
    """
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
    for section in DECOR:
        for id in entries(part, section):
            names[f"{section}.{id}"] = f"{section}.{name_copy(id, entries(after, section))}"
            after = with_entries(after, {names[f"{section}.{id}"]: entry(part, f"{section}.{id}")})
    after = with_entries(after, {names[id]: entry(part, id) for id in part.nodes if entry(part, id)})
    merged_part = MergedPart(
        with_places(after, {names[key]: spot for key, spot in places.items() if key in names}), names
    )
    ends = {str(end): end for end in part.links if end.node in names and part.links[end].node in names}
    new_routes = {
        Port(names[ends[target].node], ends[target].socket): rename_dots(merged_part, dots)
        for target, dots in routes(part).items()
        if target in ends
    }
    return replace(merged_part, graph=with_routes(merged_part.graph, new_routes)) if new_routes else merged_part


def rename_dots(merged_part: MergedPart, dots: tuple[str, ...]) -> tuple[str, ...]:
    """Dots of the part as they are called now."""
    return tuple(merged_part.keys[f"dots.{dot}"].removeprefix("dots.") for dot in dots)


def _extra(part: Graph, names: Mapping[str, str]) -> dict[str, Mapping[str, object]]:
    """Unknown keys of the nodes, by where they are now."""
    extra: dict[str, Mapping[str, object]] = {}
    for path, facts in part.extra.items():
        section, _, rest = path.partition(".")
        id, dot, tail = rest.partition(".")
        if section == "nodes" and id in names:
            extra[f"nodes.{names[id]}{dot}{tail}"] = facts
    return extra
