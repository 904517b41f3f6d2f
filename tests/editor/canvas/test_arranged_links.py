"""Arranged graphs that are wired at random: links, sampled as they are drawn, run around all elements."""

from __future__ import annotations

import pytest
from drawn_links import arrange_whole, build_scene, list_covered, list_overlaps
from halation.authoring.edits.elements import list_decor
from random_graphs import random_graph
from selection import list_seeds


@pytest.mark.parametrize("seed", list_seeds(daily=15, nightly=50))
def test_no_link_runs_through_an_element_that_it_does_not_join(seed: int) -> None:
    arranged = arrange_whole(random_graph(seed, 5 + seed * 37 % 40))
    scene = build_scene(arranged)
    assert list_overlaps(scene) == []
    assert list_covered(scene) == []


def test_arranging_again_changes_nothing() -> None:
    arranged = arrange_whole(random_graph(3, 16))
    assert list_decor(arranged, "dot")
    assert arrange_whole(arranged).ui == arranged.ui


def test_links_of_one_socket_share_their_dots() -> None:
    scene = build_scene(arrange_whole(random_graph(3, 16)))
    sources: dict[str, set[object]] = {}
    for wire in scene.wires:
        for stop in wire.stops[1:-1]:
            sources.setdefault(stop, set()).add(wire.source)
    assert sources and all(len(found) == 1 for found in sources.values())
    places = {(box.x, box.y) for box in scene.boxes.values() if box.sort == "dot"}
    assert len(places) == len(sources), "no two dots lie on each other"
