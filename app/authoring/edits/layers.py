"""Layered drawing of a directed graph: layers by longest path, few crossings, straight lines, lanes for long links.

After Sugiyama, Tagawa and Toda (1981), "Methods for visual understanding of hierarchical system structures".
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

from msgspec import Struct

from .layering import BoxLayers, Tie, layer_numbers, make_layers
from .straightening import find_tops
from .uncrossing import uncross

GAP = 80.0, 40.0
"""The space between columns and rows of boxes, in canvas units: chosen by eye, so that links can be told apart."""

Spot = tuple[float, float]


class Drawing(Struct, frozen=True):
    """Where boxes and links lie; the whole drawing starts at 0,0."""

    places: dict[str, Spot]
    """The top left of every box."""
    bends: dict[Tie, tuple[Spot, ...]]
    """For each link that leads to the right: points at the edges of columns, from left to right.

    A link through all of them runs straight through columns and changes its height only between them: it meets no box.
    """
    height: float
    """The lowest edge of boxes, and of links through their bends."""


def draw_layers(
    names: Sequence[str],
    ties: Iterable[Tie],
    sizes: Mapping[str, Spot],
    first: Iterable[str] = (),
    last: Iterable[str] = (),
    gap: Spot = GAP,
) -> Drawing:
    """The drawing of boxes of `sizes` that links join. The same for equal arguments."""
    sorted_ties = sorted({tie for tie in ties if tie.start != tie.end})
    pairs = sorted({(tie.start, tie.end) for tie in sorted_ties})
    layering = make_layers(names, sorted_ties, layer_numbers(names, pairs, first, last))
    uncross(layering)
    heights = {name: sizes[name][1] if name in sizes else 0.0 for layer in layering.layers for name in layer}

    def find_gap(upper: str, lower: str) -> float:
        return gap[1] / 2 if upper in layering.virtual or lower in layering.virtual else gap[1]

    tops = find_tops(layering, heights, find_gap)
    least = min(tops.values())
    level = {name: float(round(top - least)) for name, top in tops.items()}
    columns = _find_columns(layering, sizes, gap[0])
    places: dict[str, Spot] = {}
    for layer, (left, right) in zip(layering.layers, columns, strict=True):
        for name in layer:
            if name in sizes:
                # What nothing feeds lies at the right edge of its column, so that its links need not pass a neighbor.
                places[name] = (left if layering.before[name] else right - sizes[name][0], level[name])
    column_of = {name: column for layer, column in zip(layering.layers, columns, strict=True) for name in layer}
    bends: dict[Tie, tuple[Spot, ...]] = {}
    for tie, passed in layering.passed.items():
        start_x, end_x = places[tie.start][0] + sizes[tie.start][0], places[tie.end][0]
        bends[tie] = _find_bends(
            (start_x, column_of[tie.start][1], level[tie.start] + tie.leaves),
            *((*column_of[name], level[name]) for name in passed),
            (column_of[tie.end][0], end_x, level[tie.end] + tie.enters),
        )
    return Drawing(places, bends, max(level[name] + heights[name] for name in level))


def place_boxes(
    names: Sequence[str],
    links: Iterable[tuple[str, str]],
    sizes: Mapping[str, Spot],
    first: Iterable[str] = (),
    last: Iterable[str] = (),
    gap: Spot = GAP,
) -> dict[str, Spot]:
    """Top left of every box of a drawing whose links meet boxes at their upper corners."""
    return draw_layers(names, [Tie(*link) for link in links], sizes, first, last, gap).places


def _find_columns(layering: BoxLayers, sizes: Mapping[str, Spot], gap: float) -> list[Spot]:
    """The left and right edge of each layer."""
    columns: list[Spot] = []
    x = 0.0
    for layer in layering.layers:
        width = max((sizes[name][0] for name in layer if name in sizes), default=0.0)
        columns.append((x, x + width))
        x += width + gap
    return columns


def _find_bends(*pieces: tuple[float, float, float]) -> tuple[Spot, ...]:
    """The points where a link leaves its height, of level pieces from `left` to `right` at a height `y` each."""
    bends: list[Spot] = []
    for (_, right, y), (left, _, next_y) in pairwise(pieces):
        if y != next_y:
            bends += [(right, y), (left, next_y)]
    ends = (pieces[0][0], pieces[0][2]), (pieces[-1][1], pieces[-1][2])
    return tuple(bend for bend in bends if bend not in ends)
