"""The graph by keyboard: from element to element, and links between what is selected."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

from ...authoring.commands import ConnectSelection
from ...authoring.edits.appending import estimate_sizes
from ...authoring.edits.element_id import ElementId
from ...language.translation import mark
from ..shared.action import Action
from .geometry import Point

if TYPE_CHECKING:
    from .context import CanvasContext

Way = Literal["left", "right", "up", "down"]

_WAYS: Mapping[Way, Point] = {"left": (-1.0, 0.0), "right": (1.0, 0.0), "up": (0.0, -1.0), "down": (0.0, 1.0)}
_SIDEWAYS = 2.0
"""How much farther a step to the side counts than one ahead."""

_TITLES: Mapping[Way, tuple[str, str]] = {
    "left": (mark("Select to the Left"), mark("Add to the Left")),
    "right": (mark("Select to the Right"), mark("Add to the Right")),
    "up": (mark("Select Above"), mark("Add Above")),
    "down": (mark("Select Below"), mark("Add Below")),
}


def find_middles(places: Mapping[ElementId, Point], sizes: Mapping[ElementId, Point]) -> dict[ElementId, Point]:
    """The middles of elements, from their left top corners; of frames, which hold others, those of their titles."""
    return {
        key: (x + sizes[key][0] / 2.0, y if key.kind == "frame" else y + sizes[key][1] / 2.0)
        for key, (x, y) in places.items()
        if key in sizes
    }


def find_neighbor(middles: Mapping[ElementId, Point], start: ElementId, way: Way) -> ElementId | None:
    """The element that lies nearest in a direction from another one; None at the end."""
    x, y = middles[start]
    right, down = _WAYS[way]
    nearest: tuple[float, ElementId] | None = None
    for key, (left, top) in middles.items():
        ahead = (left - x) * right + (top - y) * down
        aside = abs((left - x) * down) + abs((top - y) * right)
        if key != start and ahead > 0.5 and (nearest is None or (ahead + _SIDEWAYS * aside, key) < nearest):
            nearest = ahead + _SIDEWAYS * aside, key
    return nearest and nearest[1]


def _walk(context: CanvasContext, way: Way, adds: bool) -> None:
    """Select the neighbor of the element selected last; without one, what is nearest to the middle of the view."""
    session, view = context.session, context.canvas
    middles = find_middles(session.positions, estimate_sizes(session.graph, view.sizes))
    if not middles:
        return
    if session.active in middles:
        found = find_neighbor(middles, session.active, way)
    else:
        found = min(middles, key=lambda key: (math.dist(middles[key], view.center), key))
    if found is not None:
        session.select(found, "add" if adds else "replace")
        view.reveal((found,))


def _make_walk(way: Way, adds: bool) -> Action[CanvasContext]:
    return Action(
        f"walk.{'add_' if adds else ''}{way}",
        _TITLES[way][adds],
        lambda context: _walk(context, way, adds),
        "Edit/Select",
        f"{'Ctrl+Shift' if adds else 'Alt'}+{way.title()}Arrow",
        "graph",
        separated=way == "left",
        repeats=True,
    )


WALKING: tuple[Action[CanvasContext], ...] = (
    *(_make_walk(way, False) for way in _WAYS),
    *(_make_walk(way, True) for way in _WAYS),
    Action(
        "link.selection",
        "Link Selected",
        lambda context: context.session.apply(ConnectSelection()),
        "Graph",
        "J",
        "graph",
        lambda context: len(context.session.selection) > 1,
        contexts=frozenset({"node"}),
        doc="Link all that is selected to what was selected last: sockets of the same name, else the first that fits.",
    ),
)
