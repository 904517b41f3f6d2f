"""Laying out a whole graph, or a part of it, anew."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from ...graph import Graph, Port
from .decor import boxed, frame_members
from .elements import Place, Sizes, entries, keys, linked_elements, owner, with_places
from .layout import bounds, laid_out
from .routes import routes
from .sizes import size


def arranged(
    graph: Graph, some: Collection[str] | None, places: Mapping[str, Place], sizes: Sizes | None = None
) -> Graph:
    """A graph where some nodes and ends, or all of them, are laid out in layers from left to right.

    Their top left corner stays. Frames around only such elements go along and fit, dots are spread over their links.
    """
    wanted = [key for key in keys(graph) if linked_elements(key, graph) and (some is None or key in some)]
    if not wanted:
        return graph
    left, top, _, _ = bounds(graph, wanted, places, sizes)
    moved = {key: (x + left, y + top) for key, (x, y) in laid_out(graph, wanted, sizes).items()}
    after = with_places(graph, moved | _dots(graph, {**places, **moved}, set(wanted), sizes))
    for id in entries(graph, "frames"):
        members = [key for key in frame_members(graph, id, places, sizes) if linked_elements(key, graph)]
        if members and set(members) <= set(wanted):
            before, now = (bounds(graph, members, where, sizes) for where in (places, {**places, **moved}))
            box = bounds(graph, [f"frames.{id}"], places, sizes)
            low, high = [box[side] - before[side] for side in (0, 1)], [box[side] - before[side] for side in (2, 3)]
            x, y = now[0] + low[0], now[1] + low[1]
            after = boxed(after, f"frames.{id}", x, y, now[2] + high[0] - x, now[3] + high[1] - y)
    return after


def _dots(graph: Graph, places: Mapping[str, Place], moved: set[str], sizes: Sizes | None) -> dict[str, Place]:
    """New places for the dots of links whose both ends moved: evenly on the way."""
    found: dict[str, Place] = {}
    ends: dict[str, tuple[Port, Port]] = {str(end): (start, end) for end, start in graph.links.items()}
    for target, dots in routes(graph).items():
        start, end = (owner(port) for port in ends[target]) if target in ends else ("", "")
        if start in moved and end in moved:
            (x, y), (width, _) = places[start], size(graph, start, sizes)
            for number, dot in enumerate(dots, 1):
                share = number / (len(dots) + 1)
                across = (places[end][0] - x - width) * share
                found.setdefault(f"dots.{dot}", (x + width + across, y + (places[end][1] - y) * share + 12.0))
    return found
