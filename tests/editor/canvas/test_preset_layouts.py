"""The graphs of all presets: no element lies on another, each at the size at which it is drawn with its thumbnail."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from pathlib import Path

import pytest
from halation import document, presets
from halation.authoring.edits.arranging import arrange
from halation.authoring.edits.elements import list_elements
from halation.authoring.edits.layout import positions
from halation.editor.canvas.staging import SceneBuilder
from halation.graph import Graph, Group
from halation.resources.sandbox import UNRESTRICTED

Rect = tuple[float, float, float, float]


def list_graphs(graph: Graph, name: str) -> Iterator[tuple[str, Graph]]:
    """A graph and those of its groups."""
    yield name, graph
    for id, item in graph.nodes.items():
        if isinstance(item, Group):
            yield from list_graphs(item.graph, f"{name}/{id}")


def find_rectangles(graph: Graph) -> dict[str, Rect]:
    """Where nodes and ends are, each with the place of a thumbnail."""
    places, keys = positions(graph), list_elements(graph)
    scene = SceneBuilder().build(graph, lambda key: places[key], (), frozenset(keys))
    return {str(key): box.rect for key, box in scene.boxes.items() if box.sort in ("node", "end")}


def list_overlaps(graph: Graph) -> list[tuple[str, str]]:
    """Pairs of elements that cover each other."""
    return [
        (first, second)
        for (first, one), (second, other) in combinations(find_rectangles(graph).items(), 2)
        if one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]
    ]


@pytest.mark.parametrize("path", presets.paths(), ids=lambda path: path.stem)
def test_no_element_of_a_preset_covers_another(path: Path) -> None:
    graphs = list_graphs(document.load(path, sandbox=UNRESTRICTED), path.stem)
    assert {name: list_overlaps(graph) for name, graph in graphs if list_overlaps(graph)} == {}


def test_all_presets_are_without_overlaps_after_arrange_at_the_sizes_with_thumbnails() -> None:
    overlaps = dict[str, list[tuple[str, str]]]()
    for path in presets.paths():
        graph = document.load(path, sandbox=UNRESTRICTED)
        sizes = {
            key: (right - left, bottom - top)
            for key in list_elements(graph)
            for left, top, right, bottom in [find_rectangles(graph).get(str(key), (0.0, 0.0, 0.0, 0.0))]
        }
        overlaps[path.stem] = list_overlaps(arrange(graph, None, positions(graph), sizes))
    assert {name: pairs for name, pairs in overlaps.items() if pairs} == {}
