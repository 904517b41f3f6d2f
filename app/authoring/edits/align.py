"""Lining elements up and spacing them evenly."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Literal, get_args

from ...errors import GraphError
from ...graph import Graph
from ...language.translation import translate
from .element_id import ElementId
from .elements import Place, Places, Sizes
from .sizes import element_size

Side = Literal["left", "right", "top", "bottom", "center x", "center y", "distribute x", "distribute y"]


def align_elements(
    graph: Graph,
    elements: Collection[ElementId],
    side: str,
    places: Places,
    sizes: Sizes | None = None,
) -> dict[ElementId, Place]:
    """The new places of some elements.

    `left` to `bottom` line up that edge with the outermost one, `center x` and `center y` the centers with their mean;
    `distribute` leaves the outermost elements and makes the gaps between all equal. Raises GraphError.
    """
    is_horizontal = side in ("left", "right", "center x", "distribute x")
    if side.startswith("distribute"):
        if len(elements) < 3:
            raise GraphError(translate("select at least three elements to distribute"))
    elif len(elements) < 2:
        raise GraphError(translate("select at least two elements to align"))
    axis = 0 if is_horizontal else 1
    spans = {key: (places[key][axis], element_size(graph, key, sizes)[axis]) for key in elements}
    starts = _align_spans(spans, side)
    return {key: (starts[key], places[key][1]) if is_horizontal else (places[key][0], starts[key]) for key in elements}


def _align_spans(spans: Mapping[ElementId, tuple[float, float]], side: str) -> dict[ElementId, float]:
    """Where each span (start, length) starts afterwards."""
    match side:
        case "left" | "top":
            least = min(start for start, _ in spans.values())
            return dict.fromkeys(spans, least)
        case "right" | "bottom":
            most = max(start + length for start, length in spans.values())
            return {key: most - length for key, (_, length) in spans.items()}
        case "center x" | "center y":
            mean = sum(start + length / 2.0 for start, length in spans.values()) / len(spans)
            return {key: mean - length / 2.0 for key, (_, length) in spans.items()}
        case "distribute x" | "distribute y":
            return _distribute(spans)
    raise GraphError(
        translate("'{side}' is not an alignment: use one of {sides}", side=side, sides=", ".join(get_args(Side)))
    )


def _distribute(spans: Mapping[ElementId, tuple[float, float]]) -> dict[ElementId, float]:
    order = sorted(spans, key=lambda key: (spans[key][0] + spans[key][1] / 2.0, key))
    first, last = spans[order[0]][0], sum(spans[order[-1]])
    gap = (last - first - sum(length for _, length in spans.values())) / (len(order) - 1)
    starts, at = dict[ElementId, float](), first
    for key in order:
        starts[key] = at
        at += spans[key][1] + gap
    return starts
