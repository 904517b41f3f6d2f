"""Where elements lie without anyone having put them there."""

from __future__ import annotations

from itertools import combinations

import pytest
from halation.authoring.edits.align import align_elements
from halation.authoring.edits.arranging import arrange
from halation.authoring.edits.decor import add_frame, find_frame_members, set_box
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.elements import list_decor, list_elements, with_places
from halation.authoring.edits.layering import layer_numbers
from halation.authoring.edits.layers import place_boxes
from halation.authoring.edits.layout import bounds, element_links, pin_places, positions, shift_off
from halation.authoring.edits.routes import add_dot
from halation.authoring.edits.sizes import element_size
from halation.errors import GraphError
from halation.graph import Graph, Port
from random_graphs import random_graph
from toy_nodes import Blend, Gain, Meter, chain

BOX = (100.0, 50.0)


def drawing(names: str, *links: str) -> dict[str, tuple[float, float]]:
    return place_boxes(list(names), [(link[0], link[1]) for link in links], dict.fromkeys(names, BOX), gap=(20.0, 10.0))


def test_a_chain_is_a_straight_line():
    assert drawing("abc", "ab", "bc") == {"a": (0, 0), "b": (120, 0), "c": (240, 0)}


def test_a_source_lies_next_to_its_reader():
    names, chain_links = list("abcs"), [("a", "b"), ("b", "c")]
    assert layer_numbers(names, [*chain_links, ("s", "c")], (), ()) == {"a": 0, "b": 1, "c": 2, "s": 1}
    assert layer_numbers(names, [*chain_links, ("s", "c")], "s", ())["s"] == 0
    assert layer_numbers(names, [*chain_links, ("a", "s")], (), "cs") == {"a": 0, "b": 1, "c": 2, "s": 2}


def test_links_that_need_not_cross_do_not():
    spots = drawing("abcdxy", "ax", "by", "cx", "dy")
    first, second = sorted((spots[name][1], name) for name in "xy")
    feeders = {"x": "ac", "y": "bd"}
    assert max(spots[name][1] for name in feeders[first[1]]) < min(spots[name][1] for name in feeders[second[1]])


def test_a_loop_can_be_drawn():
    assert len(drawing("abc", "ab", "bc", "ca")) == 3


@pytest.mark.parametrize("seed", range(40))
def test_no_boxes_overlap_and_links_lead_to_the_right(seed):
    graph = random_graph(seed, 4 + seed % 20)
    spots = positions(graph)
    assert spots.keys() == set(list_elements(graph))
    assert spots == positions(random_graph(seed, 4 + seed % 20)), "the same every time"
    boxes = {key: (*spots[key], *element_size(graph, key)) for key in spots}
    for (x, y, width, height), (x2, y2, width2, height2) in combinations(boxes.values(), 2):
        assert x + width <= x2 or x2 + width2 <= x or y + height <= y2 or y2 + height2 <= y
    for start, end in element_links(graph):
        assert boxes[start][0] + boxes[start][2] < boxes[end][0]


def test_new_elements_lie_beside_what_they_are_linked_to():
    graph = pin_places(chain(3))
    spots = positions(graph)
    graph = graph.add("after", Gain()).connect(Port("n2", "out"), Port("after", "image"))
    graph = graph.add("before", Meter()).connect(Port("before", "mean"), Port("n0", "gain")).add("alone", Gain())
    found = positions(graph)
    assert {key: found[key] for key in spots} == spots, "what has a place keeps it"
    assert found["after"][0] > found["n2"][0]
    assert found["before"][0] < found["n0"][0]
    assert found["alone"][1] > max(y for _, y in spots.values())


def test_sizes_that_the_caller_measured_count():
    graph = chain(2)
    wide = positions(graph, {"n0": (500.0, 40.0)})
    assert wide["n1"][0] - wide["n0"][0] == 580.0


def test_arranging_a_part_leaves_the_rest():
    graph = with_places(pin_places(chain(4)), {ElementId("n1"): (900.0, 900.0), ElementId("n2"): (700.0, 950.0)})
    after = arrange(graph, {ElementId("n1"), ElementId("n2")}, positions(graph))
    spots = positions(after)
    assert spots["n1"] == (700.0, 900.0)
    assert spots["n2"] == (960.0, 900.0)
    assert {key: spots[key] for key in ("n0", "n3")} == {key: positions(graph)[key] for key in ("n0", "n3")}


def test_arranging_takes_frames_along():
    graph = with_places(pin_places(chain(2)), {ElementId("n0"): (0.0, 300.0), ElementId("n1"): (40.0, 800.0)})
    graph, frame = add_frame(graph, [ElementId("n0"), ElementId("n1")], positions(graph))
    members = find_frame_members(graph, frame, positions(graph))
    after = arrange(graph, None, positions(graph))
    assert find_frame_members(after, frame, positions(after)) >= {"n0", "n1"} <= members


def test_a_frame_is_as_far_from_its_members_on_each_side_after_they_are_arranged():
    graph = with_places(pin_places(chain(2)), {ElementId("n0"): (0.0, 300.0), ElementId("n1"): (40.0, 800.0)})
    members = [ElementId("n0"), ElementId("n1")]
    graph, frame = add_frame(graph, members, positions(graph))
    left, top, right, bottom = bounds(graph, members, positions(graph))
    wanted = (11.0, 43.0, 29.0, 7.0)
    graph = set_box(graph, frame, left - 11.0, top - 43.0, right - left + 40.0, bottom - top + 50.0)
    after = arrange(graph, None, positions(graph))
    inner, outer = (bounds(after, some, positions(after)) for some in (members, [frame]))
    assert inner != (left, top, right, bottom)
    room = inner[0] - outer[0], inner[1] - outer[1], outer[2] - inner[2], outer[3] - inner[3]
    assert room == pytest.approx(wanted)


def test_arranging_removes_dots_that_links_do_not_need():
    graph, _ = add_dot(pin_places(chain(3)), Port("n1", "image"), (5.0, 5.0))
    graph, other = add_dot(graph, Port("n2", "image"), (7.0, 5.0))
    assert set(list_decor(arrange(graph, None, positions(graph)), "dot")) == set()
    assert set(list_decor(arrange(graph, {ElementId("n0"), ElementId("n1")}, positions(graph)), "dot")) == {other}


def test_alignment():
    graph = Graph().add("a", Gain()).add("b", Gain()).add("c", Blend())
    spots = {"a": (0.0, 0.0), "b": (50.0, 10.0), "c": (300.0, 70.0)}
    sizes = {"a": (100.0, 20.0), "b": (40.0, 40.0), "c": (60.0, 20.0)}

    def done(side: str) -> list[tuple[float, float]]:
        found = align_elements(graph, list("abc"), side, spots, sizes)
        return [found[key] for key in "abc"]

    assert done("left") == [(0, 0), (0, 10), (0, 70)]
    assert done("right") == [(260, 0), (320, 10), (300, 70)]
    assert done("top") == [(0, 0), (50, 0), (300, 0)]
    assert done("bottom") == [(0, 70), (50, 50), (300, 70)]
    assert {x + sizes[key][0] / 2 for key, (x, _) in zip("abc", done("center x"), strict=True)} == {150.0}
    assert [y for _, y in done("center y")] == pytest.approx([30.0, 20.0, 30.0])
    assert done("distribute x") == [(0, 0), (180, 10), (300, 70)], "gaps of 80"
    assert done("distribute y") == [(0, 0), (50, 25), (300, 70)], "gaps of 5"
    for some, side, wanted in (("a", "left", "two"), ("ab", "distribute x", "three"), ("ab", "up", "one of left")):
        with pytest.raises(GraphError, match=wanted):
            align_elements(graph, list(some), side, spots, sizes)


def test_what_would_be_covered_moves_aside():
    assert shift_off({"a": (0.0, 0.0), "b": (9.0, 9.0)}, [(5.0, 5.0)]) == {"a": (0.0, 0.0), "b": (9.0, 9.0)}
    assert shift_off({"a": (0.0, 0.0), "b": (9.0, 9.0)}, [(0.0, 0.0), (33.0, 33.0)]) == {"a": (48, 48), "b": (57, 57)}
