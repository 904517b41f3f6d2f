"""Lengths in pixels, in fractions of the height, and in pixels at a reference height."""

from __future__ import annotations

import json

import pytest
from halation import document
from halation.authoring.edits.merging import merge_part
from halation.errors import DocumentError, GraphError
from halation.graph import Expression, Graph, Group, Key, Keys, Port, Settings, problems
from halation.graph.unit_conversion import convert_length_unit, pin_length_units
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED

SIGMA = Port("blur", "sigma")
NODES = catalogue()


def make_graph(reference_height: int | None = None, **values: object) -> Graph:
    graph = Graph(settings=Settings(reference_height=reference_height))
    return graph.add("blur", NODES["gaussian_blur"](**values))


def read(text: str) -> Graph:
    return document.loads(text, sandbox=UNRESTRICTED)


@pytest.mark.parametrize(("reference_height", "unit"), [(None, "px"), (540, "px@540"), (1080, "px@1080")])
def test_a_reference_height_says_what_numbers_mean(reference_height: int | None, unit: str) -> None:
    graph = make_graph(reference_height, sigma=4.0)
    assert (graph.declaration(SIGMA).unit, graph.value(SIGMA)) == (unit, 4.0)
    assert read(document.dumps(graph)) == graph


def test_a_unit_of_one_value_is_kept_in_the_file() -> None:
    graph = convert_length_unit(make_graph(sigma=4.0), SIGMA, "height", 400)
    node = json.loads(document.dumps(graph))["nodes"]["blur"]
    assert (node["units"], node["values"]) == ({"sigma": "height"}, {"sigma": 0.01})
    assert read(document.dumps(graph)) == graph
    assert graph.set(SIGMA, 0.5).declaration(SIGMA).unit == "height"
    assert convert_length_unit(graph, SIGMA, "px", 400) == make_graph(sigma=4.0)


def test_a_default_in_another_unit_is_converted() -> None:
    graph = read('{"halation": 1, "nodes": {"blur": {"type": "gaussian_blur", "units": {"sigma": "height"}}}}')
    assert graph.value(SIGMA) == pytest.approx(NODES["gaussian_blur"].values["sigma"].default / 1080)
    assert read(document.dumps(graph)) == graph


def test_ranges_are_in_the_unit_of_the_number() -> None:
    graph = convert_length_unit(make_graph(), SIGMA, "height", 1080)
    most = NODES["gaussian_blur"].values["sigma"].maximum
    assert graph.declaration(SIGMA).maximum == pytest.approx(most / 1080)
    with pytest.raises(GraphError, match="outside the range"):
        graph.set(SIGMA, 2.0)
    bad = make_graph(sigma=5.0).override("blur.sigma.unit", "height")
    assert any("outside the range" in problem.sentence for problem in problems(bad))


def _control():
    from halation.graph import Control

    return Control(SIGMA, "Soft")


@pytest.mark.parametrize(
    ("units", "sentence"),
    [
        ({"sigma": "em"}, "'em' is no unit of a length: write px, height, or px@"),
        ({"sigma": "px@0"}, "'px@0' is no unit of a length"),
        ({"edge": "px"}, "'edge' is not a length"),
        ({"sgima": "px"}, "there is no value 'sgima'; did you mean 'sigma'"),
    ],
)
def test_bad_units_are_refused(units: dict[str, str], sentence: str) -> None:
    text = json.dumps({"halation": 1, "nodes": {"blur": {"type": "gaussian_blur", "units": units}}})
    with pytest.raises(DocumentError) as caught:
        document.loads(text, "look.json", sandbox=UNRESTRICTED)
    assert sentence.split(";")[0] in str(caught.value) and "nodes.blur.units" in str(caught.value)


def test_keys_and_expressions_are_converted_with_the_number() -> None:
    keys = Keys((Key(1, 10.0, "bezier", right=(2.0, 5.0)), Key(9, 20.0)))
    converted = convert_length_unit(make_graph().animate(SIGMA, keys), SIGMA, "height", 100).animation[SIGMA]
    assert [key.value for key in converted.keys] == [pytest.approx(0.1), pytest.approx(0.2)]
    assert converted.keys[0].right == (2.0, pytest.approx(0.05))
    formula = convert_length_unit(make_graph().animate(SIGMA, Expression("frame")), SIGMA, "px@50", 100).animation[
        SIGMA
    ]
    assert formula.evaluate(8, 0, 24, lambda name: 0) == pytest.approx(4.0)


def test_nodes_that_move_to_another_body_keep_their_lengths() -> None:
    part, graph = make_graph(270, sigma=3.0), make_graph(1080)
    merged = merge_part(graph, part, {})
    port = merged.port(SIGMA)
    assert port and merged.graph.declaration(port).unit == "px@270" and merged.graph.value(port) == 3.0
    back = merge_part(make_graph(270), pin_length_units(part, None), {})
    assert document.dumps(back.graph).count("px@270") <= 1


def test_a_control_shows_the_unit_inside_its_group() -> None:
    body = make_graph(270, sigma=3.0).add_control("soft", _control())
    outer = Graph({"g": Group(body)}, settings=Settings(reference_height=1080))
    assert outer.declaration(Port("g", "soft")).unit == "px@270"
    plain = Graph({"g": Group(make_graph().add_control("soft", _control()))}, settings=Settings(reference_height=1080))
    assert plain.declaration(Port("g", "soft")).unit == "px"


def test_a_unit_is_set_by_path() -> None:
    graph = make_graph().override("blur.sigma.unit", "height").override("blur.sigma", 0.25)
    assert (graph.value(SIGMA), graph.declaration(SIGMA).unit) == (0.25, "height")
    outer = Graph({"g": Group(make_graph())}).override("g.blur.sigma.unit", "px@720")
    assert outer.nodes["g"].graph.declaration(SIGMA).unit == "px@720"
    with pytest.raises(GraphError, match="is no unit of a length"):
        make_graph().override("blur.sigma.unit", "inch")
