"""Makes space for nodes that were put into a link."""

from __future__ import annotations

from collections.abc import Collection

from ...graph import Graph, Port
from ...graph.walk import find_reachable
from .decor import find_frame_members, set_box
from .element_id import ElementId
from .elements import Places, Sizes, list_decor, with_places
from .layout import bounds, element_links, positions
from .routes import inner_dots
from .sizes import element_size

MARGIN = 40.0
"""The gap between boxes that overlapped, in canvas units."""

Box = tuple[float, float, float, float]


def make_space(graph: Graph, ids: Collection[ElementId], target: Port, sizes: Sizes | None = None) -> Graph:
    """A graph where nodes that were put into the link to `target` cover neither what feeds them nor what they feed.

    They move right of what feeds them, and everything that depends on them moves right by as much as is needed; what
    is not in the way stays. Frames go along with what is in them, or grow.
    """
    places = positions(graph, sizes)
    links = element_links(graph)
    feeders = {start for start, end in links if end in ids and start not in ids}
    ahead = _measure_overlap(graph, feeders, ids, places, sizes)
    if ahead > 0.0:
        graph = with_places(graph, {id: (places[id][0] + ahead, places[id][1]) for id in ids})
        places = positions(graph, sizes)
    after: dict[ElementId, list[ElementId]] = {}
    for start, end in links:
        after.setdefault(start, []).append(end)
    behind = {ElementId.of_port(target), *find_reachable([ElementId.of_port(target)], after)} - {*ids}
    by = _measure_overlap(graph, ids, behind, places, sizes)
    return _push_right(graph, behind, by, places, sizes) if by > 0.0 else graph


def _measure_overlap(
    graph: Graph,
    left: Collection[ElementId],
    right: Collection[ElementId],
    places: Places,
    sizes: Sizes | None,
) -> float:
    """How far the elements at the right must move so that none is in the way of those at the left."""
    overlap = 0.0
    for left_element in left:
        a = _box(graph, left_element, places, sizes)
        for right_element in right:
            b = _box(graph, right_element, places, sizes)
            if b[0] < a[2] and a[0] < b[2] and b[1] < a[3] and a[1] < b[3]:
                overlap = max(overlap, a[2] + MARGIN - b[0])
    return overlap


def _push_right(graph: Graph, elements: Collection[ElementId], by: float, places: Places, sizes: Sizes | None) -> Graph:
    """A graph where elements lie further right, with the dots between them, and the frames that they fill."""
    moved_elements = {*elements, *inner_dots(graph, elements)}
    after = with_places(graph, {key: (places[key][0] + by, places[key][1]) for key in moved_elements})
    for frame in list_decor(graph, "frame"):
        members = {key for key in find_frame_members(graph, frame, places, sizes) if key.kind != "frame"}
        if members & moved_elements:
            left, top, right, bottom = bounds(graph, [frame], places, sizes)
            if members <= moved_elements:
                left += by
            after = set_box(after, frame, left, top, right + by - left, bottom - top)
    return after


def _box(graph: Graph, key: ElementId, places: Places, sizes: Sizes | None) -> Box:
    (x, y), (width, height) = places[key], element_size(graph, key, sizes)
    return x, y, x + width, y + height
