"""What a node shows of its values until it is expanded."""

from __future__ import annotations

import pytest
from halation.editor.canvas.layout import FIELDS, MAIN, NodeFacts, NodeLayout, make_node_layout
from halation.graph import Graph
from halation.nodes import catalogue


def find_face(type: str) -> NodeLayout:
    node = catalogue()[type]()
    return make_node_layout("node", node, Graph().add("node", node), NodeFacts())


@pytest.mark.parametrize("type", catalogue())
def test_every_row_on_a_node_can_be_set_there(type: str) -> None:
    rows = [row for row in find_face(type).rows if row.value is not None]
    assert len(rows) <= FIELDS + 1
    assert not [row.label for row in rows if row.value and row.value.type in ("curve", "ramp", "matrix")]


@pytest.mark.parametrize("type", [id for id, kind in catalogue().items() if set(MAIN) & kind.values.keys()])
def test_how_strong_the_effect_is_stands_on_the_node(type: str) -> None:
    names = {row.value.name for row in find_face(type).rows if row.value is not None}
    assert names & set(MAIN)


def test_bloom_shows_its_intensity_in_the_order_of_its_class() -> None:
    names = [row.value.name for row in find_face("bloom").rows if row.value is not None]
    assert names == ["radius", "scatter", "tint", "intensity"]
    assert "amount" in [row.value.name for row in find_face("grade").rows if row.value is not None]
