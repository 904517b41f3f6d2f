"""What differs between two graphs: laws on random edits, and what a person reads."""

from __future__ import annotations

import dataclasses
from random import Random
from typing import Any

import pytest
from edited_graphs import edit_randomly, make_graph, parse_graph
from halation.document import dumps
from halation.document.diff_merge import ABSENT, apply_difference, compare_graphs, describe_difference, describe_graph
from halation.document.diff_merge.parts import write_parts
from halation.graph import Expression, Graph, Group, Key, Keys, Output, Port, Settings, Unknown
from halation.nodes import catalogue
from hypothesis import given, settings
from hypothesis import strategies as st

NODES = catalogue()


@settings(max_examples=60)
@given(st.integers(0, 2**32))
def test_applying_a_difference_makes_the_other_graph(seed: int) -> None:
    """To the letter, if the layout is looked at; else all but the layout."""
    rng, before = Random(seed), make_graph(seed)
    after = before
    for _ in range(rng.randint(0, 6)):
        after = edit_randomly(rng, after)
    after = parse_graph(dumps(after))
    found = compare_graphs(before, after, layout=True)
    assert dumps(parse_graph(write_parts(apply_difference(before, found)))) == dumps(after)
    assert bool(found) == (dumps(before) != dumps(after))
    logic = compare_graphs(before, after)
    assert not compare_graphs(parse_graph(write_parts(apply_difference(before, logic))), after)
    assert len(describe_difference(logic, before, after)) > 0 or not logic
    assert (describe_graph(before) == describe_graph(after)) == (not logic)


@settings(max_examples=30)
@given(st.integers(0, 2**32))
def test_a_graph_does_not_differ_from_itself(seed: int) -> None:
    graph = make_graph(seed)
    assert not compare_graphs(graph, parse_graph(dumps(graph)), layout=True)


@settings(max_examples=40)
@given(st.integers(0, 2**32))
def test_renaming_is_told_from_removing_and_adding(seed: int) -> None:
    """Whatever else is in the graph, unless a twin stands beside the node."""
    rng, before = Random(seed), make_graph(seed)
    old = rng.choice([*before.nodes])
    found = compare_graphs(before, before.rename(old, "fresh"))
    assert [(one.old, one.new) for one in found.renamed] == [(old, "fresh")] and not found.changes


def chain(*names: str) -> Graph:
    """Nodes in a row from an input to an output: `id:type`."""
    graph = parse_graph('{"halation": 1, "inputs": {"beauty": {"type": "Image"}}}').add_output("image", Output())
    last = Port("inputs", "beauty")
    for name in names:
        id, _, kind = name.partition(":")
        graph = graph.add(id, NODES[kind]()).connect(last, Port(id, "image"))
        last = Port(id, "out")
    return graph.connect(last, Port("outputs", "image"))


def lines(before: Graph, after: Graph) -> list[str]:
    return [f"{line.sign} {line.words}" for line in describe_difference(compare_graphs(before, after), before, after)]


BASE = chain("blur:gaussian_blur", "light:exposure")


@pytest.mark.parametrize(
    ("after", "wanted"),
    [
        (BASE.set(Port("blur", "sigma"), 8.5), ["~ blur.sigma: 5 px (default) -> 8.5 px"]),
        (BASE.rename("blur", "soft"), ["~ node blur is now called soft"]),
        (BASE.mute("blur"), ["~ node blur is muted"]),
        (BASE.replace("blur", NODES["box_blur"]()), ["~ node blur: gaussian_blur -> box_blur"]),
        (BASE.remove("blur"), ["- node blur: gaussian_blur", "~ link light.image: blur.out -> inputs.beauty"]),
        (BASE.add("more", NODES["exposure"](stops=2.0)), ["+ node more: exposure, stops 2 EV"]),
        (BASE.disconnect(Port("light", "image")), ["- link light.image <- blur.out"]),
        (
            BASE.animate(Port("blur", "sigma"), Keys((Key(1, 2.0), Key(9, 3.0, "linear")))),
            ["+ animation of blur.sigma: 2 px at 1, 3 px linear at 9"],
        ),
        (BASE.animate(Port("light", "stops"), Expression("frame * 2")), ["+ animation of light.stops: = frame * 2"]),
        (
            BASE.rename_input("beauty", "plate"),
            ["~ link blur.image: inputs.beauty -> inputs.plate", "- input beauty: Image", "+ input plate: Image"],
        ),
        (dataclasses.replace(BASE, settings=Settings((64, 32))), ["~ settings.size: not set -> (64, 32)"]),
        (BASE.add("odd", Unknown("later", {"x": [1]})), ["+ node odd: later"]),
        (dataclasses.replace(BASE, ui={"nodes": {"blur": {"x": 1}}}), []),
    ],
)
def test_what_is_said(after: Graph, wanted: list[str]) -> None:
    assert lines(BASE, after) == wanted


def test_values_of_a_node_that_became_another_are_told_by_their_names() -> None:
    before = BASE.set(Port("blur", "sigma"), 8.5)
    assert lines(before, BASE.replace("blur", NODES["box_blur"](radius=9.0))) == [
        "~ node blur: gaussian_blur -> box_blur",
        "~ blur.radius: not set -> 9 px",
        "~ blur.sigma: 8.5 px -> not set",
    ]


def test_keys_are_told_one_by_one() -> None:
    def keyed(*keys: Key) -> Graph:
        return BASE.animate(Port("blur", "sigma"), Keys(keys))

    before = keyed(Key(1, 2.0), Key(5, 3.0), Key(9, 4.0))
    assert lines(before, keyed(Key(1, 2.5), Key(9, 4.0), Key(12.5, 1.0))) == [
        "~ blur.sigma at 1: 2 px -> 2.5 px",
        "- key of blur.sigma at 5: 3 px",
        "+ key of blur.sigma at 12.5: 1 px",
    ]


def test_groups_are_looked_into() -> None:
    def outer(inner: Graph) -> Graph:
        return Graph().add("glow", Group(Graph().add("deep", Group(inner))))

    after = BASE.set(Port("blur", "sigma"), 8.0).rename("light", "lit")
    assert lines(outer(BASE), outer(after)) == [
        "~ node glow/deep/light is now called lit",
        "~ glow/deep/blur.sigma: 5 px (default) -> 8 px",
    ]


def test_small_differences_have_as_many_digits_as_they_need() -> None:
    one, other = (BASE.set(Port("blur", "sigma"), sigma) for sigma in (3.0, 3.0000000001))
    assert lines(one, other) == ["~ blur.sigma: 3 px -> 3.0000000001 px"]


def test_code_is_compared_line_by_line() -> None:
    def coded(*code: str) -> Graph:
        return Graph().add("wave", Unknown("later", {"code": code}))

    before, after = coded("one", "two", "three", "four"), coded("one", "two", "3", "four")
    found = describe_difference(compare_graphs(before, after), before, after)
    assert [(line.words, line.below) for line in found] == [
        ("wave.code:", ("@@ -2,3 +2,3 @@", " two", "-three", "+3", " four"))
    ]


def test_twins_are_not_said_to_be_renamed() -> None:
    """Two equal nodes side by side became two others: which is which nobody can say."""
    twins = Graph().add("a", NODES["exposure"]()).add("b", NODES["exposure"]())
    found = compare_graphs(twins, twins.rename("a", "c").rename("b", "d"))
    assert not found.renamed
    assert {(change.at[-1], change.after is ABSENT) for change in found.changes} == {
        ("a", True),
        ("b", True),
        ("c", False),
        ("d", False),
    }


def test_a_chain_that_was_renamed_as_a_whole() -> None:
    after: Any = BASE.rename("blur", "x").rename("light", "y")
    assert lines(BASE, after) == ["~ node blur is now called x", "~ node light is now called y"]
