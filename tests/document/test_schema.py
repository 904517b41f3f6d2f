"""The JSON Schema says what the format is, as an independent validator reads it."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from random import Random

import pytest
from halation import document
from halation.document import FORMAT
from halation.document.schema import schema
from halation.errors import DocumentError
from halation.graph import Control, Expression, Graph, Group, Key, Keys, Port, problems
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given, settings
from hypothesis import strategies as st
from json_schemas import make_validator
from random_graphs import random_graph
from toy_nodes import TOYS, Gain

PRESETS = sorted((Path(__file__).parents[2] / "presets").glob("*.json"))
SCHEMA = json.loads(json.dumps(schema(catalogue())))
VALIDATOR = make_validator(SCHEMA)
GRAPH = {
    "halation": FORMAT,
    "inputs": {"beauty": {"type": "Image"}},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {
        "bloom": {"type": "bloom", "version": 1, "values": {"intensity": 0.5}},
        "curve": {"type": "curves", "values": {}},
        "in": {"type": "group", "graph": {"nodes": {"dim": {"type": "exposure", "values": {"stops": -1.0}}}}},
    },
    "links": {"bloom.image": "inputs.beauty", "outputs.image": "bloom.out"},
    "animation": {"bloom.intensity": {"keys": [{"frame": 1, "value": 0.5}]}},
}


def changed(path: str, value: object) -> dict:
    """GRAPH with something else at `path`."""
    made = copy.deepcopy(GRAPH)
    *above, last = path.split("/")
    place = made
    for key in above:
        place = place.setdefault(key, {})
    place[last] = value
    return made


def refused(tree: dict) -> bool:
    try:
        document.loads(json.dumps(tree), catalogue=catalogue(), sandbox=UNRESTRICTED)
    except DocumentError:
        return True
    return False


def test_it_is_a_schema() -> None:
    VALIDATOR.check_schema(SCHEMA)
    assert not refused(GRAPH) and VALIDATOR.is_valid(GRAPH)


@pytest.mark.parametrize("path", PRESETS, ids=[path.stem for path in PRESETS])
def test_it_takes_every_preset(path) -> None:
    assert [error.message for error in VALIDATOR.iter_errors(json.loads(path.read_text()))] == []


@settings(max_examples=25)
@given(st.integers(0, 2**32))
def test_it_takes_what_is_saved(seed) -> None:
    graph = random_graph(seed, 6)
    name = next((id for id, node in graph.nodes.items() if any(v.type == "float" for v in node.values.values())), "")
    if name:
        port = Port(name, next(v.name for v in graph.nodes[name].values.values() if v.type == "float"))
        low = graph.nodes[name].values[port.socket].default
        moved = Keys((Key(1.0, low), Key(5.5, low))) if seed % 2 else Expression("frame * 0.01")
        graph = graph.animate(port, moved).add_control("turn", Control(port))
    outer = Graph(inputs=graph.inputs).add("inner", Group(graph))
    for each in (graph, outer):
        tree = json.loads(document.dumps(each))
        assert [error.message for error in VALIDATOR.iter_errors(tree)] == []


WRONG = st.sampled_from([None, True, "x", 7.25, [], {}, [1, 2], ["a"], {"a": 1}, -3, [[]]])


@settings(max_examples=120)
@given(st.integers(0, 2**16), st.randoms(use_true_random=False), WRONG)
def test_it_refuses_what_reading_refuses(seed, rng: Random, wrong) -> None:
    """Any part of a saved graph becomes something of another type."""
    tree = json.loads(document.dumps(random_graph(seed % 40, 4)))
    parts = [(tree, key) for key in tree if key not in ("ui", "halation")]
    for _ in range(rng.randrange(4)):
        holder, key = rng.choice(parts)
        inner = holder[key]
        below = (
            [(inner, k) for k in (inner if isinstance(inner, dict) else range(len(inner)))]
            if isinstance(inner, dict | list)
            else []
        )
        parts = below or parts
    holder, key = rng.choice(parts)
    holder[key] = wrong
    if refused(tree):
        assert not VALIDATOR.is_valid(tree), (key, wrong)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("halation", FORMAT + 1),
        ("halation", "1"),
        ("halation", 0),
        ("settings", []),
        ("settings/size", [0, 2]),
        ("settings/size", [1, 2, 3]),
        ("settings/rate", 0),
        ("settings/allow", ["loop"]),
        ("settings/allow", {"a": 1}),
        ("inputs/beauty/type", "Picture"),
        ("inputs/beauty/missing", "blue"),
        ("inputs/beauty/default", "red"),
        ("inputs/a.b", {}),
        ("outputs/image/view", 1),
        ("controls/glow", {}),
        ("controls/glow", {"target": "bloom"}),
        ("nodes/bloom", {}),
        ("nodes/bloom/type", 5),
        ("nodes/bloom/muted", 1),
        ("nodes/bloom/version", 2),
        ("nodes/bloom/version", "1"),
        ("nodes/bloom/values", 1),
        ("nodes/bloom/values/intensity", "1"),
        ("nodes/bloom/values/intensity", True),
        ("nodes/bloom/values/intensity", None),
        ("nodes/inputs", {"type": "a"}),
        ("nodes/", {"type": "a"}),
        ("nodes/in/path", "also.json"),
        ("nodes/in/graph", None),
        ("nodes/in/graph/nodes", 1),
        ("nodes/in/graph/nodes/dim/values/stops", "x"),
        ("links/bloom.image", 5),
        ("links/bloom.image", "bloom"),
        ("links/bloom", "inputs.beauty"),
        ("links/a.b.c", "inputs.beauty"),
        ("animation/bloom.intensity", {}),
        ("animation/bloom.intensity/expression", "1"),
        ("animation/bloom.intensity/keys", [{"frame": 1}]),
        ("animation/bloom.intensity/keys", [{"frame": 1, "value": "x"}]),
        ("animation/bloom.intensity/keys", [{"frame": 1, "value": 1, "interpolation": "quick"}]),
        ("nodes/w", {"type": "glsl"}),
        ("nodes/w", {"type": "glsl", "code": ["a"], "file": "a.glsl"}),
        ("nodes/w", {"type": "isf", "code": "void main() {}"}),
    ],
)
def test_both_refuse(path, value) -> None:
    tree = changed(path, value)
    assert refused(tree) and not VALIDATOR.is_valid(tree)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("$schema", "./graph.schema.json"),
        ("author", {"name": "me"}),
        ("nodes/x", {"type": "unheard of", "a": 1}),
        ("nodes/bloom/values/new", [1, "a"]),
        ("nodes/bloom/note", "kept"),
        ("settings/size", None),
        ("settings/allow", {"loop": "why"}),
        ("ui/anything", [1]),
        ("nodes/w", {"type": "glsl", "code": ["a", "b"]}),
        ("nodes/w", {"type": "isf", "file": "a.fs", "values": {"a": True}}),
    ],
)
def test_both_take(path, value) -> None:
    tree = changed(path, value)
    assert not refused(tree) and VALIDATOR.is_valid(tree)


@pytest.mark.parametrize(("name", "value"), [("intensity", -1e9), ("intensity", 1e9), ("no such quality", 0)])
def test_limits_are_those_of_check(name, value) -> None:
    tree = changed(f"nodes/bloom/values/{name}", value)
    errors = [
        one for one in problems(document.loads(json.dumps(tree), sandbox=UNRESTRICTED)) if one.rule.name == "bad-value"
    ]
    assert VALIDATOR.is_valid(tree) == (not errors)


def test_every_value_of_every_node_is_there_with_its_words() -> None:
    for id, node in catalogue().items():
        node_schema = SCHEMA["$defs"][f"node.{id}"]
        values = (node_schema.get("then") or node_schema)["properties"]["values"]["properties"]
        assert [*values] == [*node.values]
        assert all(value.doc in values[name].get("description", "") for name, value in node.values.items())


def test_values_of_an_older_version_are_not_looked_at() -> None:
    class NewGain(Gain):
        version = 3

    validator = make_validator(schema({**TOYS, "gain": NewGain}))
    for version, valid in ((1, True), (2, True), (3, False), (4, False)):
        tree = {"halation": FORMAT, "nodes": {"a": {"type": "gain", "version": version, "values": {"gain": "much"}}}}
        assert validator.is_valid(tree) == valid
