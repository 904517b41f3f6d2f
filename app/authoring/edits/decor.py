"""Frames and comments."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from types import MappingProxyType

from ...errors import GraphError
from ...graph import Graph
from ...language.translation import mark, translate
from .element_id import DECOR, ElementId
from .elements import (
    Place,
    Places,
    Sizes,
    clean_text,
    entry,
    fresh_decor,
    list_decor,
    list_elements,
    round_coordinate,
    with_entries,
)
from .layout import bounds
from .sizes import COMMENT, element_size

PADDING, TITLE = 24.0, 28.0
"""The padding between a frame and its elements, and the height of its title, in canvas units."""

EMPTY = (320.0, 200.0)
"""The size of an empty frame."""

SMALLEST = 40.0
"""The smallest side of a frame: its title is 28 high."""

Color = tuple[float, float, float]


def add_frame(
    graph: Graph,
    around: Collection[ElementId],
    places: Places,
    title: str = "",
    at: Place = (0.0, 0.0),
    sizes: Sizes | None = None,
) -> tuple[Graph, ElementId]:
    """A frame around some elements, or at `at` around nothing; and its id."""
    frame = fresh_decor(graph, "frame")
    if around:
        left, top, right, bottom = bounds(graph, around, places, sizes)
        box = (left - PADDING, top - PADDING - TITLE, right - left + 2 * PADDING, bottom - top + 2 * PADDING + TITLE)
    else:
        box = (*at, *EMPTY)
    return set_box(with_entries(graph, {frame: {"title": clean_text(title)}}), frame, *box), frame


def add_comment(graph: Graph, at: Place, text: str) -> tuple[Graph, ElementId]:
    """A comment at that place, and its id."""
    comment = fresh_decor(graph, "comment")
    graph = with_entries(graph, {comment: {"text": clean_text(text)}})
    return set_box(graph, comment, *at, *COMMENT), comment


def set_box(graph: Graph, note: ElementId, x: float, y: float, width: float, height: float) -> Graph:
    """The graph with another rectangle of a frame or comment, which never gets too small for the mouse."""
    facts = {
        "x": round_coordinate(x),
        "y": round_coordinate(y),
        "w": round_coordinate(max(width, SMALLEST)),
        "h": round_coordinate(max(height, SMALLEST)),
    }
    if note.kind == "comment":
        del facts["h"]
    return with_entries(graph, {note: facts})


_MISSING: Mapping[str, str] = MappingProxyType(
    {
        "frame": mark("there is no frame '{name}'"),
        "comment": mark("there is no comment '{name}'"),
        "dot": mark("there is no dot '{name}'"),
    }
)
"""Messages for elements that do not exist, by kind."""


def set_facts(graph: Graph, note: ElementId, **facts: object) -> Graph:
    """The graph with other facts of a frame or comment. Raises GraphError if there is none."""
    kind = note.kind
    if kind not in DECOR or note not in list_decor(graph, kind):
        raise GraphError(translate(_MISSING.get(kind, _MISSING["frame"]), name=note.name))
    return with_entries(graph, {note: facts})


def find_frame_members(
    graph: Graph, frame: ElementId, places: Places, sizes: Sizes | None = None
) -> frozenset[ElementId]:
    """The elements that lie inside a frame with all of their box; smaller frames too."""
    if not entry(graph, frame) or frame not in places:
        return frozenset()
    left, top, right, bottom = bounds(graph, [frame], places, sizes)
    members = set[ElementId]()
    for element in list_elements(graph):
        if element != frame and element in places:
            (x, y), (width, height) = places[element], element_size(graph, element, sizes)
            if left <= x and top <= y and x + width <= right and y + height <= bottom:
                members.add(element)
    return frozenset(members)
