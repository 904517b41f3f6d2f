"""Parts of a document as users read them."""

from __future__ import annotations

from typing import Any

import pytest
from halation.document.diff_merge import wording
from halation.document.diff_merge.parts import ABSENT
from halation.graph import Graph, Group, Port
from halation.nodes import catalogue

BLUR, NODES = catalogue()["gaussian_blur"].values["sigma"], catalogue()


@pytest.mark.parametrize(
    ("part", "exact", "text"),
    [
        (True, False, "true"), (None, False, "null"), (2.0, False, "2"), (2.0, True, "2"),
        (1 / 3, False, "0.333333"), (1 / 3, True, "0.3333333333333333"), (7, False, "7"),
        ((1.0, 0.5), False, "(1, 0.5)"), ([1, 2], False, "(1, 2)"),
        ([0.0] * 8, False, "(0, 0, 0, 0, 0, 0, 0, 0)"), ([0.0] * 9, False, "9 numbers"),
        ([0.0] * 9, True, "(0, 0, 0, 0, 0, 0, 0, 0, 0)"), ([True], False, "[true]"), ("word", False, '"word"'),
        ("x" * 58, False, f'"{"x" * 58}"'), ("x" * 59, False, f'"{"x" * 58}…'), ("x" * 59, True, f'"{"x" * 59}"'),
        (ABSENT, False, "not set"),
    ],
)  # fmt: skip
def test_values(part: Any, exact: bool, text: str) -> None:
    assert wording.value_text(part, None, exact) == text


def test_values_have_units_and_defaults() -> None:
    unit = f" {BLUR.unit}" if BLUR.unit not in ("", "ratio", "count") else ""
    assert unit and wording.value_text(2.5, BLUR) == f"2.5{unit}"
    assert wording.value_text(ABSENT, BLUR) == f"{BLUR.default:g}{unit} (default)"


@pytest.mark.parametrize(
    ("before", "after", "text"),
    [(1.0, 2.0, "1 -> 2"), (0.12345671, 0.12345672, "0.12345671 -> 0.12345672"), (ABSENT, 3, "not set -> 3")],
)
def test_changes_have_the_digits_that_differ(before: Any, after: Any, text: str) -> None:
    assert wording.change_text(before, after) == text


@pytest.mark.parametrize(
    ("node", "text"),
    [
        ({"type": "blur"}, "blur"), ({"type": "blur", "muted": True}, "blur, muted"),
        ({"type": "group", "path": "a.json", "muted": True}, "group a.json, muted"),
        ({"type": "group", "graph": {"nodes": {"a": {}}}}, "group of 1 node"),
        ({"type": "group", "graph": {"nodes": {"a": {}, "b": {}}}}, "group of 2 nodes"),
        ({"type": "group", "graph": {}}, "group of 0 nodes"),
    ],
)  # fmt: skip
def test_nodes(node: Any, text: str) -> None:
    assert wording.item_text(node) == text


def test_ends() -> None:
    assert wording.end_text({"type": "Image"}) == "Image"
    assert wording.end_text({"target": "a.b", "maximum": 2.0, "doc": "x"}) == 'a.b, doc "x", maximum 2'


def test_animations() -> None:
    keys = {9: {"value": 2.0, "interpolation": "linear"}, 1.5: {"value": 1.0, "left": [-1.0, 0.5]}}
    assert wording.animation_text({"keys": keys}, None) == "1 left (-1, 0.5) at 1.5, 2 linear at 9"
    assert wording.animation_text({"keys": {1: {"value": 0.0}}, "outside": "repeat"}, None) == "0 at 1, outside repeat"
    assert wording.animation_text({"expression": "frame * 2"}, None) == "= frame * 2"
    many = {frame: {"value": 1.0} for frame in range(20)}
    text = wording.animation_text({"keys": many}, None)
    assert len(text) == 60 and text.endswith("…") and "1 at 19" in wording.animation_text({"keys": many}, None, True)


def test_values_are_found_through_groups() -> None:
    inner = Graph({"blur": NODES["gaussian_blur"]()})
    graph = Graph({"light": NODES["exposure"](), "g": Group(inner)})
    sigma = wording.value_at(graph, ("nodes", "g", "graph", "nodes", "blur", "values", "sigma"))
    assert sigma is not None and sigma.unit == BLUR.unit
    assert wording.value_at(graph, ("nodes", "g", "graph", "animation", str(Port("blur", "sigma")))) == sigma
    stops = wording.value_at(graph, ("nodes", "light", "values", "stops"))
    assert stops is not None and wording.value_at(graph, ("animation", "light.stops")) == stops != sigma
    for at in (("nodes", "light", "graph", "nodes", "x"), ("nodes", "light"), ("links", "light.image"),
               ("nodes", "gone", "values", "stops"), ("animation",)):  # fmt: skip
        assert wording.value_at(graph, at) is None
