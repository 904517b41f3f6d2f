"""Arranges a graph, or a part of it, in layers from left to right."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from itertools import count

from ...graph import Graph, Port
from .decor import find_frame_members, set_box
from .element_id import ElementId
from .elements import Place, Places, Sizes, can_be_linked, list_decor, list_elements, with_places
from .lanes import choose_dots
from .layout import bounds, lay_out_links
from .pins import Pins, pin_height
from .routes import tidy_routes, with_routes
from .sizes import element_size


def arrange(
    graph: Graph,
    chosen: Collection[ElementId] | None,
    places: Places,
    sizes: Sizes | None = None,
    pins: Pins | None = None,
) -> Graph:
    """A graph where some nodes and ends, or all of them, are laid out in layers from left to right.

    Their top left corner stays. Frames around only such elements go along and fit. Links between them pass dots where
    they would run through an element, and no others.
    """
    elements = [key for key in list_elements(graph) if can_be_linked(key, graph) and (chosen is None or key in chosen)]
    if not elements:
        return graph
    left, top, _, _ = bounds(graph, elements, places, sizes)
    spots, bends = lay_out_links(graph, elements, sizes, pins)
    new_places = {key: (x + left, y + top) for key, (x, y) in spots.items()}
    bends = {target: tuple((x + left, y + top) for x, y in points) for target, points in bends.items()}
    after = _with_dots(with_places(graph, new_places), _route_links(graph, bends, new_places, sizes, pins))
    for frame in list_decor(graph, "frame"):
        members = [key for key in find_frame_members(graph, frame, places, sizes) if can_be_linked(key, graph)]
        if members and set(members) <= set(elements):
            before, new_bounds = (bounds(graph, members, where, sizes) for where in (places, {**places, **new_places}))
            box = bounds(graph, [frame], places, sizes)
            low, high = [box[side] - before[side] for side in (0, 1)], [box[side] - before[side] for side in (2, 3)]
            x, y = new_bounds[0] + low[0], new_bounds[1] + low[1]
            after = set_box(after, frame, x, y, new_bounds[2] + high[0] - x, new_bounds[3] + high[1] - y)
    return after


def _route_links(
    graph: Graph, bends: Mapping[Port, tuple[Place, ...]], places: Places, sizes: Sizes | None, pins: Pins | None
) -> dict[Port, tuple[Place, ...]]:
    """The places of dots for each link, by target. Links of one socket share them where they can."""
    boxes = {key: (*places[key], *element_size(graph, key, sizes)) for key in places}
    rects = {key: (x, y, x + width, y + height) for key, (x, y, width, height) in boxes.items()}
    used: dict[Port, set[Place]] = {}
    dots: dict[Port, tuple[Place, ...]] = {}
    for target, points in sorted(bends.items(), key=lambda bend: (len(bend[1]), bend[0])):
        source = graph.links[target]
        start, end = ElementId.of_port(source), ElementId.of_port(target)
        begin = rects[start][2], rects[start][1] + pin_height(graph, source, True, pins)
        finish = rects[end][0], rects[end][1] + pin_height(graph, target, False, pins)
        obstacles = [rect for key, rect in rects.items() if key not in (start, end)]
        shared = used.setdefault(source, set())
        dots[target] = choose_dots(begin, finish, points, obstacles, shared)
        shared.update(dots[target])
    return dots


def _with_dots(graph: Graph, dots: Mapping[Port, tuple[Place, ...]]) -> Graph:
    """A graph where some links pass new dots and no others; those at one place on links of one socket are the same."""
    graph = tidy_routes(with_routes(graph, dict.fromkeys(dots, ())))
    used_names = {dot.name for dot in list_decor(graph, "dot")}
    free_names = (name for name in map("d{}".format, count(1)) if name not in used_names)
    names: dict[tuple[Port, Place], str] = {}
    for target in sorted(dots):
        for place in dots[target]:
            if (graph.links[target], place) not in names:
                names[graph.links[target], place] = next(free_names)
    graph = with_places(graph, {ElementId.of("dot", name): place for (_, place), name in names.items()})
    routes = {target: [names[graph.links[target], place] for place in places] for target, places in dots.items()}
    return with_routes(graph, routes)
