"""Measures how a graph is drawn: elements that cover each other, links that run through elements, crossings of links.

Links are sampled as the editor draws them, independently of the code that arranges a graph.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from halation.authoring.edits.arranging import arrange
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.elements import list_elements
from halation.authoring.edits.layout import positions
from halation.editor.canvas.link_index import Wire
from halation.editor.canvas.scene import CanvasScene
from halation.editor.canvas.staging import SceneBuilder
from halation.graph import Graph, Group
from numpy.typing import NDArray

Rect = tuple[float, float, float, float]

_POINTS = 400
"""Points along each curve: on links of a thousand units they are a few units apart."""


def list_graphs(graph: Graph, name: str) -> Iterator[tuple[str, Graph]]:
    """A graph and those of its groups."""
    yield name, graph
    for id, item in graph.nodes.items():
        if isinstance(item, Group):
            yield from list_graphs(item.graph, f"{name}/{id}")


def build_scene(graph: Graph) -> CanvasScene:
    """The scene of a graph in which each node has the place of a thumbnail."""
    places, keys = positions(graph), list_elements(graph)
    return SceneBuilder().build(graph, lambda key: places[key], (), frozenset(keys))


def arrange_whole(graph: Graph) -> Graph:
    """The graph after Arrange, as the editor calls it."""
    scene = build_scene(graph)
    return arrange(graph, None, positions(graph), scene.sizes, scene.find_pins())


def find_rectangles(scene: CanvasScene) -> dict[ElementId, Rect]:
    """Where nodes and ends are."""
    return {key: box.rect for key, box in scene.boxes.items() if box.sort in ("node", "end")}


def list_overlaps(scene: CanvasScene) -> list[tuple[str, str]]:
    """Pairs of elements that cover each other."""
    return [
        (str(first), str(second))
        for (first, one), (second, other) in combinations(find_rectangles(scene).items(), 2)
        if one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]
    ]


def list_covered(scene: CanvasScene) -> list[tuple[str, str]]:
    """Links, by target, and the elements through which they run though they do not end there."""
    found: list[tuple[str, str]] = []
    for wire in scene.wires:
        xs, ys = sample_wire(wire).T
        for key, (left, top, right, bottom) in find_rectangles(scene).items():
            inside = (xs > left) & (xs < right) & (ys > top) & (ys < bottom)
            if key not in (wire.stops[0], wire.stops[-1]) and inside.any():
                found.append((str(wire.target), str(key)))
    return found


def count_crossings(scene: CanvasScene) -> int:
    """At how many places lines from different sockets cross; links of one socket that run together are one line."""
    lines = {wire.target: sample_wire(wire)[::8] for wire in scene.wires}
    places = {
        (*sorted((str(one.source), str(other.source))), *place)
        for one, other in combinations(scene.wires, 2)
        if one.source != other.source
        for place in _find_meetings(lines[one.target], lines[other.target])
    }
    return len(places)


def sample_wire(wire: Wire) -> NDArray[np.float64]:
    """Points along a link, as rows of x and y."""
    t = np.linspace(0.0, 1.0, _POINTS)[:, None]
    pieces: list[NDArray[np.float64]] = []
    for curve in wire.curves:
        a, b, c, d = np.array(curve).reshape(4, 2)
        pieces.append((1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d)
    return np.concatenate(pieces)


def _find_meetings(one: NDArray[np.float64], other: NDArray[np.float64]) -> list[tuple[int, int]]:
    """Where two polylines cross, to the nearest 4 units."""
    if (one.max(0) < other.min(0)).any() or (other.max(0) < one.min(0)).any():
        return []
    a, b = one[:-1, None], one[1:, None]
    c, d = other[None, :-1], other[None, 1:]
    first, second = _turn(c, d, a), _turn(c, d, b)
    crossed = (_turn(a, b, c) * _turn(a, b, d) < 0) & (first * second < 0)
    rows, _ = crossed.nonzero()
    share = first[crossed] / (first[crossed] - second[crossed])
    points = one[rows] + (one[rows + 1] - one[rows]) * share[:, None]
    return [(round(x / 4), round(y / 4)) for x, y in points]


def _turn(a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]) -> NDArray[np.float64]:
    along, to = b - a, c - a
    return along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0]
