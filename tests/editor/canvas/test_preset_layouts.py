"""The graphs of all presets: no element lies on another, each at the size at which it is drawn with its thumbnail."""

from __future__ import annotations

from pathlib import Path

import pytest
from drawn_links import arrange_whole, build_scene, count_crossings, list_covered, list_graphs, list_overlaps
from halation import document, presets
from halation.resources.sandbox import UNRESTRICTED


@pytest.mark.parametrize("path", presets.paths(), ids=lambda path: path.stem)
def test_no_element_of_a_preset_covers_another(path: Path) -> None:
    graphs = list_graphs(document.load(path, sandbox=UNRESTRICTED), path.stem)
    overlaps = {name: list_overlaps(build_scene(graph)) for name, graph in graphs}
    assert {name: pairs for name, pairs in overlaps.items() if pairs} == {}


@pytest.mark.parametrize("path", presets.paths(), ids=lambda path: path.stem)
def test_arrange_leads_the_links_of_a_preset_around_all_elements_and_crosses_no_more_than_before(path: Path) -> None:
    for _, graph in list_graphs(document.load(path, sandbox=UNRESTRICTED), path.stem):
        scene = build_scene(arrange_whole(graph))
        assert list_overlaps(scene) == []
        assert list_covered(scene) == []
        assert count_crossings(scene) <= count_crossings(build_scene(graph))
