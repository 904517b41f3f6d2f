"""Frames and comments."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from ...errors import GraphError
from ...graph import Graph
from .elements import Place, Sizes, clean_text, entries, entry, fresh_id, list_elements, round_coordinate, with_entries
from .layout import bounds
from .sizes import COMMENT, element_size

PADDING, TITLE = 24.0, 28.0
"""Room between a frame and what is in it, and for its title above that."""

EMPTY = (320.0, 200.0)
"""The size of a frame around nothing."""

SMALLEST = 40.0

Color = tuple[float, float, float]


def add_frame(
    graph: Graph,
    around: Collection[str],
    places: Mapping[str, Place],
    title: str = "",
    at: Place = (0.0, 0.0),
    sizes: Sizes | None = None,
) -> tuple[Graph, str]:
    """A frame around some elements, or at `at` around nothing; and its id."""
    id = fresh_id(graph, "frames")
    if around:
        left, top, right, bottom = bounds(graph, around, places, sizes)
        box = (left - PADDING, top - PADDING - TITLE, right - left + 2 * PADDING, bottom - top + 2 * PADDING + TITLE)
    else:
        box = (*at, *EMPTY)
    return set_box(with_entries(graph, {f"frames.{id}": {"title": clean_text(title)}}), f"frames.{id}", *box), id


def add_comment(graph: Graph, at: Place, text: str) -> tuple[Graph, str]:
    """A comment at that place, and its id."""
    id = fresh_id(graph, "comments")
    graph = with_entries(graph, {f"comments.{id}": {"text": clean_text(text)}})
    return set_box(graph, f"comments.{id}", *at, *COMMENT), id


def set_box(graph: Graph, key: str, x: float, y: float, width: float, height: float) -> Graph:
    """A graph where a frame or comment has that rectangle, which never gets too small to be grabbed."""
    facts = {
        "x": round_coordinate(x),
        "y": round_coordinate(y),
        "w": round_coordinate(max(width, SMALLEST)),
        "h": round_coordinate(max(height, SMALLEST)),
    }
    if "comments." in key:
        del facts["h"]
    return with_entries(graph, {key: facts})


def set_facts(graph: Graph, key: str, **facts: object) -> Graph:
    """A graph where a frame or comment says something else. Raises GraphError if there is none."""
    section, _, id = key.partition(".")
    if id not in entries(graph, section):
        raise GraphError(f"there is no {section[:-1]} '{id}'")
    return with_entries(graph, {key: facts})


def find_frame_members(
    graph: Graph, id: str, places: Mapping[str, Place], sizes: Sizes | None = None
) -> frozenset[str]:
    """The elements that lie inside a frame with all of their box; smaller frames too."""
    key = f"frames.{id}"
    if not entry(graph, key) or key not in places:
        return frozenset()
    left, top, right, bottom = bounds(graph, [key], places, sizes)
    members = set[str]()
    for other in list_elements(graph):
        if other != key and other in places:
            (x, y), (width, height) = places[other], element_size(graph, other, sizes)
            if left <= x and top <= y and x + width <= right and y + height <= bottom:
                members.add(other)
    return frozenset(members)
