"""What is correct on its own side may be wrong beside the changes of the other; what was wrong before is no fault."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from halation.document.diff_merge.faults import find_merge_faults
from halation.graph import Control, Expression, Graph, Group, Port
from toy_nodes import Blend, Gain, Soften

STOPS, GONE = Port("gain", "gain"), Port("gone", "gain")
KNOB = {"knob": Control(STOPS)}
MOVED = {STOPS: Expression("frame")}
WHOLE, EMPTY = Graph({"gain": Gain(), "soft": Soften()}), Graph({"soft": Soften()})


def change(graph: Graph, **parts: Any) -> Graph:
    return replace(graph, **parts)


@pytest.mark.parametrize(("name", "parts", "path"), [
    ("controls", {"controls": KNOB}, ("controls", "knob")), ("keys", {"animation": MOVED}, ("animation", "gain.gain")),
])  # fmt: skip
def test_what_one_side_adds_for_a_node_that_the_other_removes(name: str, parts: dict[str, Any], path: Any) -> None:
    merge, adding = change(EMPTY, **parts), change(WHOLE, **parts)
    assert [*find_merge_faults(merge, adding, EMPTY)] == [path] == [*find_merge_faults(merge, EMPTY, adding)]
    assert not [*find_merge_faults(change(WHOLE, **parts), adding, WHOLE)], "it is there"
    assert not [*find_merge_faults(merge, merge, EMPTY)], "it was wrong before"
    assert not [*find_merge_faults(merge, adding, merge)], "on one side it was wrong before"


def test_a_control_that_was_another_one_counts_as_new() -> None:
    merge, ours = change(EMPTY, controls=KNOB), change(WHOLE, controls=KNOB)
    other = change(EMPTY, controls={"knob": Control(GONE)})
    assert [*find_merge_faults(merge, ours, other)] == [("controls", "knob")]


def test_a_link_that_fits_no_more() -> None:
    links = {Port("soft", "image"): Port("gain", "out")}
    merge, ours = change(EMPTY, links=links), change(WHOLE, links=links)
    assert [*find_merge_faults(merge, ours, EMPTY)] == [("links", "soft.image")]
    assert not [*find_merge_faults(merge, merge, EMPTY)] and not [*find_merge_faults(ours, ours, WHOLE)]
    assert not [*find_merge_faults(merge, merge, ours)], "on one side it was wrong before"


def test_loops_are_faults_of_their_links() -> None:
    nodes = Graph({"a": Blend(), "b": Blend()})
    image = next(iter(Blend.inputs))
    forth, back = {Port("b", image): Port("a", "out")}, {Port("a", image): Port("b", "out")}
    merge = change(nodes, links=forth | back)
    assert [*find_merge_faults(merge, change(nodes, links=forth), change(nodes, links=back))] == [
        ("links", f"a.{image}")
    ]


def test_groups_are_searched_where_both_have_one() -> None:
    def wrap(graph: Graph) -> Graph:
        return Graph({"g": Group(graph)})

    merge, ours = change(EMPTY, controls=KNOB), change(WHOLE, controls=KNOB)
    path = ("nodes", "g", "graph", "controls", "knob")
    assert [*find_merge_faults(wrap(merge), wrap(ours), wrap(EMPTY))] == [path]
    assert not [*find_merge_faults(wrap(merge), wrap(ours), Graph())]
