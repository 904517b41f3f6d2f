"""Positions of elements: for those that have none, and a layered layout of all."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from ...graph import Graph, Port
from .element_id import ElementId
from .elements import Place, Places, Sizes, can_be_linked, list_elements, place, with_places
from .layering import Tie
from .layers import draw_layers
from .pins import Pins, pin_height
from .sizes import element_size

GAP = (80.0, 40.0)
"""The gaps between the columns and rows of a layout, in canvas units."""

OFFSET = 24.0
"""How far an element moves that would exactly cover another."""


def positions(graph: Graph, sizes: Sizes | None = None) -> dict[ElementId, Place]:
    """The place of every element: as saved, else laid out beside what it is linked to."""
    places = {key: spot for key in list_elements(graph) if (spot := place(graph, key)) is not None}
    missing = [key for key in list_elements(graph) if key not in places]
    if not missing:
        return places
    linked = [key for key in missing if can_be_linked(key, graph)]
    if not any(can_be_linked(key, graph) for key in places):
        left, top = 0.0, _bottom(graph, places, sizes)
        places |= {key: (x + left, y + top) for key, (x, y) in lay_out(graph, linked, sizes).items()}
    for key in _sort_by_column(graph, linked):
        if key not in places:
            places[key] = _place_beside(graph, key, places, sizes)
    for key in missing:
        if key not in places:
            places[key] = (0.0, _bottom(graph, places, sizes))
    return places


def pin_places(graph: Graph, before: Graph | None = None) -> Graph:
    """A graph where every element has a saved place, so that later edits move none.

    There is nothing to do for one that has the layout and elements of a graph `before` that was pinned.
    """
    elements = list_elements(graph)
    if before is not None and graph.ui is before.ui and elements == list_elements(before):
        return graph
    missing = [key for key in elements if place(graph, key) is None]
    places = positions(graph) if missing else {}
    return with_places(graph, {key: places[key] for key in missing})


def lay_out(graph: Graph, elements: Collection[ElementId], sizes: Sizes | None = None) -> dict[ElementId, Place]:
    """A layered layout of some nodes and ends, from 0,0 on; parts that are not linked lie below each other."""
    return lay_out_links(graph, elements, sizes)[0]


def lay_out_links(
    graph: Graph, elements: Collection[ElementId], sizes: Sizes | None = None, pins: Pins | None = None
) -> tuple[dict[ElementId, Place], dict[Port, tuple[Place, ...]]]:
    """A layered layout, and points through which each link, by target, meets no element on its way."""
    rest = {key: element_size(graph, key, sizes) for key in list_elements(graph) if key in set(elements)}
    links = [pair for pair in element_links(graph) if pair[0] in rest and pair[1] in rest]
    ties = {target: tie for target, tie in _list_ties(graph, pins).items() if tie.start in rest and tie.end in rest}
    places: dict[ElementId, Place] = {}
    bends: dict[Port, tuple[Place, ...]] = {}
    top, unlinked = 0.0, list[ElementId]()
    for part in _find_connected_parts(list(rest), links):
        if len(part) == 1:
            unlinked += part
            continue
        boxes: dict[str, Place] = {key: rest[key] for key in part}
        inside = {target: tie for target, tie in ties.items() if tie.start in boxes}
        ends = [key for key in part if key.kind == "output"]
        starts = [key for key in part if key.kind == "input"]
        drawing = draw_layers(part, inside.values(), boxes, starts, ends, GAP)
        places |= {key: (drawing.places[key][0], drawing.places[key][1] + top) for key in part}
        bends |= {target: tuple((x, y + top) for x, y in drawing.bends.get(tie, ())) for target, tie in inside.items()}
        top += drawing.height + GAP[1]
    x = 0.0
    for key in unlinked:
        places[key] = (x, top)
        x += rest[key][0] + GAP[0]
    return places, bends


def _list_ties(graph: Graph, pins: Pins | None) -> dict[Port, Tie]:
    """All links by target, with the heights of their sockets."""
    return {
        target: Tie(
            ElementId.of_port(source),
            ElementId.of_port(target),
            pin_height(graph, source, True, pins),
            pin_height(graph, target, False, pins),
        )
        for target, source in sorted(graph.links.items())
    }


def element_links(graph: Graph) -> list[tuple[ElementId, ElementId]]:
    """All links as pairs of elements, source first, without those that lead nowhere."""
    elements = set(list_elements(graph))
    pairs = [(ElementId.of_port(source), ElementId.of_port(target)) for target, source in sorted(graph.links.items())]
    return [pair for pair in pairs if pair[0] in elements and pair[1] in elements]


def bounds(
    graph: Graph, elements: Iterable[ElementId], places: Places, sizes: Sizes | None = None
) -> tuple[float, float, float, float]:
    """Left, top, right and bottom of some elements; zeros for none."""
    boxes = [(*places[key], *element_size(graph, key, sizes)) for key in elements]
    if not boxes:
        return (0.0, 0.0, 0.0, 0.0)
    return (
        min(x for x, _, _, _ in boxes),
        min(y for _, y, _, _ in boxes),
        max(x + width for x, _, width, _ in boxes),
        max(y + height for _, y, _, height in boxes),
    )


def shift_off(places: Places, occupied_places: Collection[Place]) -> dict[ElementId, Place]:
    """`places` moved together until none is exactly where one of `occupied_places` is."""
    step, occupied = 0, set(occupied_places)
    while any((x + step * OFFSET, y + step * OFFSET) in occupied for x, y in places.values()):
        step += 1
    return {key: (x + step * OFFSET, y + step * OFFSET) for key, (x, y) in places.items()}


def _find_connected_parts(names: list[ElementId], links: list[tuple[ElementId, ElementId]]) -> list[list[ElementId]]:
    """The connected parts of the graph, in the order of `names`."""
    beside: dict[ElementId, list[ElementId]] = {name: [] for name in names}
    for start, end in links:
        beside[start].append(end)
        beside[end].append(start)
    visited, parts = set[ElementId](), list[list[ElementId]]()
    for start in names:
        if start in visited:
            continue
        todo, part = [start], set[ElementId]()
        while todo:
            name = todo.pop()
            if name not in part:
                part.add(name)
                todo += beside[name]
        visited |= part
        parts.append([name for name in names if name in part])
    return parts


def _sort_by_column(graph: Graph, elements: list[ElementId]) -> list[ElementId]:
    """Some elements, each after what feeds it where there are no loops."""
    rank = {key: column[0] for key, column in lay_out(graph, elements).items()}
    return sorted(elements, key=lambda key: (rank[key], elements.index(key)))


def _place_beside(graph: Graph, key: ElementId, places: Places, sizes: Sizes | None) -> Place:
    """Right of what feeds an element, else left of what it feeds, else below everything."""
    links = element_links(graph)
    feeders = [start for start, end in links if end == key and start in places]
    readers = [end for start, end in links if start == key and end in places]
    width = element_size(graph, key, sizes)[0]
    if feeders:
        nearest = max(feeders, key=lambda element: places[element][0])
        spot = (places[nearest][0] + element_size(graph, nearest, sizes)[0] + GAP[0], places[nearest][1])
    elif readers:
        nearest = min(readers, key=lambda element: places[element][0])
        spot = (places[nearest][0] - width - GAP[0], places[nearest][1])
    else:
        left, _, right, _ = bounds(graph, places, places, sizes)
        x = right + GAP[0] if key.kind == "output" else left
        spot = (x, _bottom(graph, places, sizes))
    return find_free_place(graph, key, spot, places, sizes)


def find_free_place(graph: Graph, key: ElementId, spot: Place, places: Places, sizes: Sizes | None) -> Place:
    """The nearest place at or below `spot` where an element covers no node or end of `places`."""
    width, height = element_size(graph, key, sizes)
    boxes = [
        (*at, *element_size(graph, element, sizes)) for element, at in places.items() if can_be_linked(element, graph)
    ]
    x, y = spot
    while True:
        covered_bottoms = [
            top + tall
            for left, top, wide, tall in boxes
            if left < x + width and x < left + wide and top < y + height and y < top + tall
        ]
        if not covered_bottoms:
            return x, y
        y = max(covered_bottoms) + GAP[1] / 2.0


def _bottom(graph: Graph, places: Places, sizes: Sizes | None) -> float:
    return bounds(graph, places, places, sizes)[3] + GAP[1] if places else 0.0
