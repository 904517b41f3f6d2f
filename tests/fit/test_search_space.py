"""Which numbers may change, and what a point of the search space makes of a graph."""

from __future__ import annotations

import numpy as np
import pytest
from halation.errors import UsageError
from halation.fit.search_space import find_search_space
from halation.fit.value_patterns import ValuePattern
from halation.graph import Control, Graph, Group, Key, Keys, Port
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.curves import Curves
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.grade import Grade
from halation.nodes.color.hue_curves import HueCurves
from halation.nodes.distort.kaleidoscope import Kaleidoscope
from halation.nodes.geometry.fog import Fog


@pytest.fixture
def graph() -> Graph:
    """Nodes of several kinds, one of them in a group, and a control."""
    body = Graph().add("light", Exposure(stops=1.0))
    nodes = {
        "grade": Grade(),
        "tone": Curves(),
        "hue": HueCurves(),
        "mirrors": Kaleidoscope(segments=6),
        "blur": GaussianBlur(),
        "look": Group(body),
    }
    return Graph(nodes).add_control("softness", Control(Port("blur", "sigma")))


def names(graph: Graph, *texts: str, points: int = 5) -> list[str]:
    return [item.name for item in find_search_space(graph, [ValuePattern(text) for text in texts], points).numbers]


def test_names_and_stars(graph):
    assert names(graph, "grade.g*") == [
        f"grade.{value}.{channel}" for value in ("gamma", "gain") for channel in ("red", "green", "blue")
    ]
    assert names(graph, "look.*.stops", "*") == ["look.light.stops", "softness"]
    assert names(graph, "softness", "blur.sigma") == ["softness"], "a control is its value"
    assert not any(name.startswith("blur.mix") for name in names(graph, "blur.*"))
    assert names(graph, "blur.mix") == ["blur.mix"]


def test_ranges_are_those_of_sliders_or_of_the_user(graph):
    space = find_search_space(graph, [ValuePattern("grade.gain"), ValuePattern("softness", 1.0, 9.0)], 5)
    assert [(item.low, item.high) for item in space.numbers] == [(0.5, 1.5)] * 3 + [(1.0, 9.0)]
    blur = find_search_space(graph, [ValuePattern("softness")], 5).numbers[0]
    declared = GaussianBlur.values["sigma"]
    assert (blur.low, blur.high) == (declared.low, declared.high)


@pytest.mark.parametrize("color", [(0.2, 0.4, 0.8), (3.0, 0.5, 0.0)])
def test_a_color_may_be_twice_as_bright_or_white(color):
    """Its numbers have no sliders: from black to twice what they are, at least to 1."""
    graph = Graph().add("fog", Fog()).set(Port("fog", "color"), (*color, 1.0))
    value = Fog.values["color"]
    assert value.type == "color" and not np.isfinite(value.high)
    numbers = find_search_space(graph, [ValuePattern("fog.color")], 5).numbers
    assert [(item.start, item.low, item.high) for item in numbers] == [
        (part, 0.0, max(1.0, 2.0 * part)) for part in color
    ]


def test_a_point_is_a_graph_with_these_values(graph):
    space = find_search_space(graph, [ValuePattern(text) for text in ("grade.gain", "mirrors.segments", "look.*.*")], 5)
    np.testing.assert_allclose(space.graph_at(space.start).value(Port("grade", "gain")), (1.0, 1.0, 1.0, 1.0))
    moved = space.graph_at(np.array([0.0, 0.25, 1.0, *space.start[3:]]))
    assert moved.value(Port("grade", "gain")) == (0.5, 0.75, 1.5, 1.0)
    assert moved.value(Port("mirrors", "segments")) == 6 and type(moved.value(Port("mirrors", "segments"))) is int
    stops = space.graph_at(np.ones(len(space.numbers))).node("look").body().value(Port("light", "stops"))
    assert stops == Exposure.values["stops"].high


def test_straight_curves_get_points_that_change_nothing(graph):
    space = find_search_space(graph, [ValuePattern("tone.master")], 5)
    assert space.graph.value(Port("tone", "master")) == (0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1)
    assert [item.name for item in space.numbers][1] == "tone.master at 0.25"
    bent = graph.set(Port("tone", "master"), (0.0, 0.0, 0.5, 0.6, 1.0, 1.0))
    assert len(find_search_space(bent, [ValuePattern("tone.master")], 5).numbers) == 3


def test_both_ends_of_the_hues_are_one_number(graph):
    space = find_search_space(graph, [ValuePattern("hue.hue_by_hue")], 5)
    point = np.array([1.0, *space.start[1:]])
    assert len(space.numbers) == 4
    assert space.graph_at(point).value(Port("hue", "hue_by_hue"))[1::2] == (0.25, 0.0, 0.0, 0.0, 0.25)
    assert len(find_search_space(graph, [ValuePattern("hue.saturation_by_saturation")], 5).numbers) == 5


@pytest.mark.parametrize(
    ("pattern", "sentence"),
    [
        (ValuePattern("grade.gian"), "no such value; did you mean 'grade.gain'"),
        (ValuePattern("tone.space"), "it is a choice"),
        (ValuePattern("softness", 100.0, 200.0), "give a range that holds it"),
        (ValuePattern("mirrors.segments", 0.0, 5.0), "give a range that holds it"),
    ],
)
def test_what_cannot_be_fitted_is_refused(graph, pattern, sentence):
    with pytest.raises(UsageError, match=sentence):
        find_search_space(graph, [pattern], 5)


def test_a_value_that_is_animated_is_refused(graph):
    animated = graph.animate(Port("blur", "sigma"), Keys((Key(1, 1.0), Key(9, 2.0))))
    with pytest.raises(UsageError, match="'softness' cannot be fitted: it is animated"):
        find_search_space(animated, [ValuePattern("softness")], 5)
