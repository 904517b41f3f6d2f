"""Where elements lie: places for those that have none, and a tidy arrangement of all."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from ...graph import INPUTS, OUTPUTS, Graph
from .elements import Place, Sizes, end_port, keys, linked_elements, owner, place, with_places
from .layers import drawn
from .sizes import size

GAP = (80.0, 40.0)
"""Room between the columns and rows of a layout."""

OFFSET = 24.0
"""How far an element moves that would exactly cover another."""


def positions(graph: Graph, sizes: Sizes | None = None) -> dict[str, Place]:
    """The place of every element: as saved, else laid out beside what it is linked to."""
    found = {key: spot for key in keys(graph) if (spot := place(graph, key)) is not None}
    missing = [key for key in keys(graph) if key not in found]
    if not missing:
        return found
    linked = [key for key in missing if linked_elements(key, graph)]
    if not any(linked_elements(key, graph) for key in found):
        left, top = 0.0, _bottom(graph, found, sizes)
        found |= {key: (x + left, y + top) for key, (x, y) in laid_out(graph, linked, sizes).items()}
    for key in _fed_first(graph, linked):
        if key not in found:
            found[key] = _beside(graph, key, found, sizes)
    for key in missing:
        if key not in found:
            found[key] = (0.0, _bottom(graph, found, sizes))
    return found


def pinned(graph: Graph, before: Graph | None = None) -> Graph:
    """A graph where every element has a saved place, so that later edits move none.

    There is nothing to do for one that has the layout and elements of a graph `before` that was pinned.
    """
    known = keys(graph)
    if before is not None and graph.ui is before.ui and known == keys(before):
        return graph
    missing = [key for key in known if place(graph, key) is None]
    places = positions(graph) if missing else {}
    return with_places(graph, {key: places[key] for key in missing})


def laid_out(graph: Graph, wanted: Collection[str], sizes: Sizes | None = None) -> dict[str, Place]:
    """A layered layout of some nodes and ends, from 0,0 on; parts that no link holds together lie below each other."""
    rest = {key: size(graph, key, sizes) for key in keys(graph) if key in set(wanted)}
    links = [pair for pair in element_links(graph) if pair[0] in rest and pair[1] in rest]
    places: dict[str, Place] = {}
    top, single = 0.0, list[str]()
    for part in _parts(list(rest), links):
        if len(part) == 1:
            single += part
            continue
        boxes = {key: rest[key] for key in part}
        inside = [(start, end) for start, end in links if start in boxes]
        ends = [key for key in part if key.startswith(f"{OUTPUTS}.")]
        starts = [key for key in part if key.startswith(f"{INPUTS}.")]
        spots = drawn(part, inside, boxes, starts, ends, GAP)
        places |= {key: (x, y + top) for key, (x, y) in spots.items()}
        top += max(spots[key][1] + boxes[key][1] for key in part) + GAP[1]
    x = 0.0
    for key in single:
        places[key] = (x, top)
        x += rest[key][0] + GAP[0]
    return places


def element_links(graph: Graph) -> list[tuple[str, str]]:
    """All links as pairs of elements, source first, without those that lead nowhere."""
    known = set(keys(graph))
    pairs = [(owner(source), owner(target)) for target, source in sorted(graph.links.items())]
    return [pair for pair in pairs if pair[0] in known and pair[1] in known]


def bounds(
    graph: Graph, some: Iterable[str], places: Mapping[str, Place], sizes: Sizes | None = None
) -> tuple[float, float, float, float]:
    """Left, top, right and bottom of some elements; zeros for none."""
    boxes = [(*places[key], *size(graph, key, sizes)) for key in some]
    if not boxes:
        return (0.0, 0.0, 0.0, 0.0)
    return (
        min(x for x, _, _, _ in boxes),
        min(y for _, y, _, _ in boxes),
        max(x + width for x, _, width, _ in boxes),
        max(y + height for _, y, _, height in boxes),
    )


def uncovered(places: Mapping[str, Place], others: Collection[Place]) -> dict[str, Place]:
    """`places` moved together until none is exactly where one of the `others` is."""
    step, taken = 0, set(others)
    while any((x + step * OFFSET, y + step * OFFSET) in taken for x, y in places.values()):
        step += 1
    return {key: (x + step * OFFSET, y + step * OFFSET) for key, (x, y) in places.items()}


def _parts(names: list[str], links: list[tuple[str, str]]) -> list[list[str]]:
    """The names that links hold together, in the order of `names`."""
    beside: dict[str, list[str]] = {name: [] for name in names}
    for start, end in links:
        beside[start].append(end)
        beside[end].append(start)
    seen, parts = set[str](), list[list[str]]()
    for start in names:
        if start in seen:
            continue
        todo, part = [start], set[str]()
        while todo:
            name = todo.pop()
            if name not in part:
                part.add(name)
                todo += beside[name]
        seen |= part
        parts.append([name for name in names if name in part])
    return parts


def _fed_first(graph: Graph, some: list[str]) -> list[str]:
    """Some elements, each after what feeds it where there are no loops."""
    rank = {key: column[0] for key, column in laid_out(graph, some).items()}
    return sorted(some, key=lambda key: (rank[key], some.index(key)))


def _beside(graph: Graph, key: str, found: Mapping[str, Place], sizes: Sizes | None) -> Place:
    """Right of what feeds an element, else left of what it feeds, else below everything."""
    links = element_links(graph)
    feeders = [start for start, end in links if end == key and start in found]
    readers = [end for start, end in links if start == key and end in found]
    width = size(graph, key, sizes)[0]
    if feeders:
        nearest = max(feeders, key=lambda one: found[one][0])
        spot = (found[nearest][0] + size(graph, nearest, sizes)[0] + GAP[0], found[nearest][1])
    elif readers:
        nearest = min(readers, key=lambda one: found[one][0])
        spot = (found[nearest][0] - width - GAP[0], found[nearest][1])
    else:
        side = end_port(key)
        left, _, right, _ = bounds(graph, found, found, sizes)
        x = right + GAP[0] if side and side.node == OUTPUTS else left
        spot = (x, _bottom(graph, found, sizes))
    return _free(graph, key, spot, found, sizes)


def _free(graph: Graph, key: str, spot: Place, found: Mapping[str, Place], sizes: Sizes | None) -> Place:
    """The nearest place below `spot` where an element covers no other node or end."""
    width, height = size(graph, key, sizes)
    boxes = [(*at, *size(graph, one, sizes)) for one, at in found.items() if linked_elements(one, graph)]
    x, y = spot
    while True:
        hit = [
            top + tall
            for left, top, wide, tall in boxes
            if left < x + width and x < left + wide and top < y + height and y < top + tall
        ]
        if not hit:
            return x, y
        y = max(hit) + GAP[1] / 2.0


def _bottom(graph: Graph, found: Mapping[str, Place], sizes: Sizes | None) -> float:
    return bounds(graph, found, found, sizes)[3] + GAP[1] if found else 0.0
