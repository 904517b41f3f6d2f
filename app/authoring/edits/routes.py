"""The dots that links pass: layout only, the logic of a link never changes."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from ...errors import GraphError
from ...graph import Graph, Port
from .elements import Place, element_of, entries, fresh_id, place, with_places, with_sections, without_entries

Route = tuple[str, ...]


def routes(graph: Graph) -> dict[str, Route]:
    """The dots of every link, by target, from source to target."""
    dots_by_id, section = entries(graph, "dots"), graph.ui.get("routes")
    if not isinstance(section, Mapping):
        return {}
    known_routes = {
        target: tuple(dot for dot in dots if dot in dots_by_id) for target, dots in section.items() if _is_list(dots)
    }
    return {target: dots for target, dots in known_routes.items() if dots}


def dots_on_link(graph: Graph, target: Port) -> Route:
    """The dots that the link to `target` passes."""
    return routes(graph).get(str(target), ())


def inner_dots(graph: Graph, ids: Collection[str]) -> tuple[str, ...]:
    """Keys of the dots that only links between some elements pass."""
    ends = {str(end): element_of(end) in ids and element_of(start) in ids for end, start in graph.links.items()}
    dots_inside = [(dot, ends.get(target, False)) for target, dots in routes(graph).items() for dot in dots]
    shared_dots = {dot for dot, inside in dots_inside if not inside}
    return tuple(dict.fromkeys(f"dots.{dot}" for dot, inside in dots_inside if inside and dot not in shared_dots))


def with_routes(graph: Graph, changed: Mapping[Port, Iterable[str]]) -> Graph:
    """A graph where some links pass other dots."""
    new_routes = routes(graph) | {str(target): tuple(dots) for target, dots in changed.items()}
    return with_sections(graph, {"routes": {target: dots for target, dots in new_routes.items() if dots}})


def tidy_routes(graph: Graph) -> Graph:
    """A graph without routes of links that are gone, and without dots that no link passes."""
    if "routes" not in graph.ui and "dots" not in graph.ui:
        return graph
    ends = {str(target) for target in graph.links}
    live_routes = {target: dots for target, dots in routes(graph).items() if target in ends}
    graph = with_sections(graph, {"routes": live_routes}) if graph.ui.get("routes") != live_routes else graph
    used = {dot for dots in live_routes.values() for dot in dots}
    return without_entries(graph, [f"dots.{dot}" for dot in entries(graph, "dots") if dot not in used])


def add_dot(graph: Graph, target: Port, at: Place) -> tuple[Graph, str]:
    """A dot on the link that feeds `target`, and its id; it goes where it makes the shortest detour."""
    if target not in graph.links:
        raise GraphError(f"nothing is linked to '{target}': a dot needs a link")
    dot = fresh_id(graph, "dots")
    graph = with_places(graph, {f"dots.{dot}": at})
    return with_routes(graph, {target: _insert_dot(graph, dots_on_link(graph, target), dot, at)}), dot


def join_dot(graph: Graph, dot: str, target: Port) -> Graph:
    """A graph where the link to `target` passes a dot of another link from the same source."""
    if target not in graph.links:
        raise GraphError(f"nothing is linked to '{target}': only a link can pass a dot")
    sources = {str(end): source for end, source in graph.links.items()}
    for end, dots in routes(graph).items():
        if dot in dots and sources.get(end) == graph.links[target]:
            return with_routes(graph, {target: dots[: dots.index(dot) + 1]})
    raise GraphError(f"the dot carries another signal than the link to '{target}': links join where they start alike")


def remove_dots(graph: Graph, removed: Iterable[str]) -> Graph:
    """A graph without those dots; links go on without them."""
    dots = set(removed)
    live_routes = {target: tuple(dot for dot in passed if dot not in dots) for target, passed in routes(graph).items()}
    graph = with_sections(graph, {"routes": {target: passed for target, passed in live_routes.items() if passed}})
    return without_entries(graph, [f"dots.{dot}" for dot in dots])


def split_route(graph: Graph, dots: Route, x: float) -> tuple[Route, Route]:
    """A route cut in two: what lies left of `x` up to the first dot that does not, and the rest."""
    for index, dot in enumerate(dots):
        spot = place(graph, f"dots.{dot}")
        if spot is not None and spot[0] >= x:
            return dots[:index], dots[index:]
    return dots, ()


def _insert_dot(graph: Graph, dots: Route, dot: str, at: Place) -> Route:
    """`dots` with one more, after those that lie left of it."""
    before, after = split_route(graph, dots, at[0])
    return (*before, dot, *after)


def _is_list(item: object) -> bool:
    return isinstance(item, list | tuple)
