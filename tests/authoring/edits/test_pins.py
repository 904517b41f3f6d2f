"""How far below the top of a node its sockets are, before anything was drawn: row by row."""

from __future__ import annotations

import pytest
from halation.authoring.edits.pins import pin_height
from halation.authoring.edits.sizes import HEADER, ROW
from halation.graph import Graph, Port
from halation.nodes import catalogue

GRAPH = Graph().add("bloom", catalogue()["bloom"]()).add("merge", catalogue()["merge"]())


@pytest.mark.parametrize(
    ("port", "is_output", "rows"),
    [("bloom.image", False, 0.5), ("bloom.out", True, 0.5), ("bloom.glow", True, 1.5), ("merge.out", True, 0.5),
     ("bloom.intensity", False, 2.5)],
)  # fmt: skip
def test_sockets_are_in_the_middle_of_their_rows_and_values_below_all(port: str, is_output: bool, rows: float) -> None:
    assert pin_height(GRAPH, Port.parse(port), is_output) == HEADER + ROW * rows


def test_inputs_follow_each_other_and_come_before_values() -> None:
    node = catalogue()["merge"]
    names = [name for name, socket in node.inputs.items() if not socket.optional]
    heights = [pin_height(GRAPH, Port("merge", name), False) for name in names]
    assert len(names) > 1 and heights == [HEADER + ROW * (row + 0.5) for row in range(len(names))]
    value = next(name for name in node.values if name not in node.inputs)
    assert pin_height(GRAPH, Port("merge", value), False) > max(heights)


@pytest.mark.parametrize("port", ["nobody.out", "bloom.nothing"])
def test_what_is_not_there_or_collapsed_is_at_the_header(port: str) -> None:
    assert pin_height(GRAPH, Port.parse(port), True) == HEADER / 2


def test_what_was_measured_counts() -> None:
    port = Port("bloom", "out")
    assert pin_height(GRAPH, port, True, {(port, True): 7.0, (port, False): 9.0}) == 7.0
    assert pin_height(GRAPH, port, True, {(port, False): 9.0}) == HEADER + ROW * 0.5
