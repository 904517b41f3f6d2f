"""Arranges a graph, or a part of it, in layers from left to right."""

from __future__ import annotations

from collections.abc import Collection

from ...graph import Graph, Port
from .decor import find_frame_members, set_box
from .element_id import ElementId
from .elements import Place, Places, Sizes, can_be_linked, list_decor, list_elements, with_places
from .layout import bounds, lay_out
from .routes import routes
from .sizes import element_size

_DOT_DROP = 12.0
"""How far below the corners of its nodes a dot is placed, in canvas units: about where the first sockets are."""


def arrange(graph: Graph, chosen: Collection[ElementId] | None, places: Places, sizes: Sizes | None = None) -> Graph:
    """A graph where some nodes and ends, or all of them, are laid out in layers from left to right.

    Their top left corner stays. Frames around only such elements go along and fit, dots are spread over their links.
    """
    elements = [key for key in list_elements(graph) if can_be_linked(key, graph) and (chosen is None or key in chosen)]
    if not elements:
        return graph
    left, top, _, _ = bounds(graph, elements, places, sizes)
    new_places = {key: (x + left, y + top) for key, (x, y) in lay_out(graph, elements, sizes).items()}
    after = with_places(graph, new_places | _spread_dots(graph, {**places, **new_places}, set(elements), sizes))
    for frame in list_decor(graph, "frame"):
        members = [key for key in find_frame_members(graph, frame, places, sizes) if can_be_linked(key, graph)]
        if members and set(members) <= set(elements):
            before, new_bounds = (bounds(graph, members, where, sizes) for where in (places, {**places, **new_places}))
            box = bounds(graph, [frame], places, sizes)
            low, high = [box[side] - before[side] for side in (0, 1)], [box[side] - before[side] for side in (2, 3)]
            x, y = new_bounds[0] + low[0], new_bounds[1] + low[1]
            after = set_box(after, frame, x, y, new_bounds[2] + high[0] - x, new_bounds[3] + high[1] - y)
    return after


def _spread_dots(graph: Graph, places: Places, moved: set[ElementId], sizes: Sizes | None) -> dict[ElementId, Place]:
    """New places for the dots of links whose both ends moved: evenly on the way."""
    dot_places: dict[ElementId, Place] = {}
    ends: dict[str, tuple[Port, Port]] = {str(end): (start, end) for end, start in graph.links.items()}
    for target, dots in routes(graph).items():
        if target not in ends:
            continue
        start, end = map(ElementId.of_port, ends[target])
        if start in moved and end in moved:
            (x, y), (width, _) = places[start], element_size(graph, start, sizes)
            for number, dot in enumerate(dots, 1):
                share = number / (len(dots) + 1)
                across = (places[end][0] - x - width) * share
                dot_places.setdefault(
                    ElementId.of("dot", dot), (x + width + across, y + (places[end][1] - y) * share + _DOT_DROP)
                )
    return dot_places
