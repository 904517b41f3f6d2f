"""The dots that links run through: layout only, a dot never changes a link."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from ...errors import GraphError
from ...graph import Graph, Port
from ...language.translation import translate
from .element_id import ElementId
from .elements import Place, fresh_decor, list_decor, place, with_places, with_sections, without_entries

Route = tuple[str, ...]


def routes(graph: Graph) -> dict[str, Route]:
    """The dots of every link, by target, from source to target."""
    dot_names, section = {dot.name for dot in list_decor(graph, "dot")}, graph.ui.get("routes")
    if not isinstance(section, Mapping):
        return {}
    known_routes = {
        target: tuple(dot for dot in dots if dot in dot_names) for target, dots in section.items() if _is_list(dots)
    }
    return {target: dots for target, dots in known_routes.items() if dots}


def dots_on_link(graph: Graph, target: Port) -> Route:
    """The dots that the link to `target` passes."""
    return routes(graph).get(str(target), ())


def inner_dots(graph: Graph, elements: Collection[ElementId]) -> tuple[ElementId, ...]:
    """The dots that only links between some elements pass."""
    ends = {
        str(end): ElementId.of_port(end) in elements and ElementId.of_port(start) in elements
        for end, start in graph.links.items()
    }
    dots_inside = [(dot, ends.get(target, False)) for target, dots in routes(graph).items() for dot in dots]
    shared_dots = {dot for dot, inside in dots_inside if not inside}
    return tuple(
        dict.fromkeys(ElementId.of("dot", dot) for dot, inside in dots_inside if inside and dot not in shared_dots)
    )


def with_routes(graph: Graph, changed: Mapping[Port, Iterable[str]]) -> Graph:
    """A graph where some links pass other dots."""
    new_routes = routes(graph) | {str(target): tuple(dots) for target, dots in changed.items()}
    return with_sections(graph, {"routes": {target: dots for target, dots in new_routes.items() if dots}})


def tidy_routes(graph: Graph) -> Graph:
    """The graph without routes of removed links, and without dots that no link uses."""
    if "routes" not in graph.ui and "dots" not in graph.ui:
        return graph
    ends = {str(target) for target in graph.links}
    live_routes = {target: dots for target, dots in routes(graph).items() if target in ends}
    graph = with_sections(graph, {"routes": live_routes}) if graph.ui.get("routes") != live_routes else graph
    used = {dot for dots in live_routes.values() for dot in dots}
    return without_entries(graph, [dot for dot in list_decor(graph, "dot") if dot.name not in used])


def add_dot(graph: Graph, target: Port, at: Place) -> tuple[Graph, ElementId]:
    """A dot on the link that feeds `target`, and its id; it goes where it makes the shortest detour."""
    if target not in graph.links:
        raise GraphError(translate("nothing is linked to '{target}': a dot needs a link", target=target))
    dot = fresh_decor(graph, "dot")
    graph = with_places(graph, {dot: at})
    return with_routes(graph, {target: _insert_dot(graph, dots_on_link(graph, target), dot.name, at)}), dot


def join_dot(graph: Graph, dot: ElementId, target: Port) -> Graph:
    """A graph where the link to `target` passes a dot of another link from the same source."""
    if target not in graph.links:
        raise GraphError(translate("nothing is linked to '{target}': a dot needs a link", target=target))
    sources = {str(end): source for end, source in graph.links.items()}
    for end, dots in routes(graph).items():
        if dot.name in dots and sources.get(end) == graph.links[target]:
            return with_routes(graph, {target: dots[: dots.index(dot.name) + 1]})
    raise GraphError(
        translate(
            "only links from the same source can share a dot: the link to '{target}' has another source", target=target
        )
    )


def remove_dots(graph: Graph, removed: Collection[ElementId]) -> Graph:
    """A graph without those dots; links go on without them."""
    names = {dot.name for dot in removed}
    live_routes = {target: tuple(dot for dot in passed if dot not in names) for target, passed in routes(graph).items()}
    graph = with_sections(graph, {"routes": {target: passed for target, passed in live_routes.items() if passed}})
    return without_entries(graph, removed)


def split_route(graph: Graph, dots: Route, x: float) -> tuple[Route, Route]:
    """A route split in two at the first dot that is not left of `x`."""
    for index, dot in enumerate(dots):
        spot = place(graph, ElementId.of("dot", dot))
        if spot is not None and spot[0] >= x:
            return dots[:index], dots[index:]
    return dots, ()


def _insert_dot(graph: Graph, dots: Route, dot: str, at: Place) -> Route:
    """`dots` with one more, after those that lie left of it."""
    before, after = split_route(graph, dots, at[0])
    return (*before, dot, *after)


def _is_list(item: object) -> bool:
    return isinstance(item, list | tuple)
