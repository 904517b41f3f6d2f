"""The content of one graph put into another, under ids that are free there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from halation.nodes import Node

from ...graph import INPUTS, OUTPUTS, Graph, Port
from . import timing
from .elements import DECOR, Place, entries, entry, with_entries, with_places
from .naming import copy_of
from .routes import routes, with_routes


@dataclass(frozen=True)
class Merged:
    """`graph` holds everything; `keys` says what nodes and decor of the part are called there."""

    graph: Graph
    keys: Mapping[str, str]

    def port(self, port: Port) -> Port | None:
        """Where a port of a node of the part is now; None for ports that are no node's."""
        return Port(self.keys[port.node], port.socket) if port.node in self.keys else None


def merged(graph: Graph, part: Graph, places: Mapping[str, Place]) -> Merged:
    """`graph` with the nodes and decor of `part` at `places`, and the links among those nodes.

    Paths of `part` must start where those of `graph` do. Ends, controls and links from elsewhere are left out.
    """
    taken = {*graph.nodes, INPUTS, OUTPUTS}
    names: dict[str, str] = {}
    for id, item in part.nodes.items():
        names[id] = copy_of(id, taken, item.id if isinstance(item, Node) else "")
        taken.add(names[id])
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
                Port(names[port.node], port.socket): timing.renamed(item, names)
                for port, item in part.animation.items()
                if port.node in names
            },
        },
    )
    for section in DECOR:
        for id in entries(part, section):
            names[f"{section}.{id}"] = f"{section}.{copy_of(id, entries(after, section))}"
            after = with_entries(after, {names[f"{section}.{id}"]: entry(part, f"{section}.{id}")})
    after = with_entries(after, {names[id]: entry(part, id) for id in part.nodes if entry(part, id)})
    found = Merged(with_places(after, {names[key]: spot for key, spot in places.items() if key in names}), names)
    ends = {str(end): end for end in part.links if end.node in names and part.links[end].node in names}
    passed = {
        Port(names[ends[target].node], ends[target].socket): moved_dots(found, dots)
        for target, dots in routes(part).items()
        if target in ends
    }
    return replace(found, graph=with_routes(found.graph, passed)) if passed else found


def moved_dots(found: Merged, dots: tuple[str, ...]) -> tuple[str, ...]:
    """Dots of the part as they are called now."""
    return tuple(found.keys[f"dots.{dot}"].removeprefix("dots.") for dot in dots)


def _extra(part: Graph, names: Mapping[str, str]) -> dict[str, Mapping[str, object]]:
    """Unknown keys of the nodes, by where they are now."""
    found: dict[str, Mapping[str, object]] = {}
    for path, kept in part.extra.items():
        section, _, rest = path.partition(".")
        id, dot, tail = rest.partition(".")
        if section == "nodes" and id in names:
            found[f"nodes.{names[id]}{dot}{tail}"] = kept
    return found
