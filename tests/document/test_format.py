"""Text <-> graph: what is written, what comes back, what is kept."""

from __future__ import annotations

import dataclasses
import json
from itertools import zip_longest
from random import Random
from typing import Any

import pytest
from halation.document import FORMAT, dumps, find_first_difference, loads, records
from halation.document.canonical import WIDTH, pretty
from halation.errors import GraphError
from halation.graph import Control, Graph, Group, Input, Output, Port, Settings, Unknown, problems
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given, settings
from hypothesis import strategies as st
from toy_nodes import TOYS, Gain, Soften, random_graph, small


def read(text: str) -> Graph:
    return loads(text, catalogue=TOYS, sandbox=UNRESTRICTED)


def test_the_text_of_a_graph() -> None:
    assert (
        dumps(small())
        == """\
{
  "controls": {
    "glow": {"label": "Glow", "target": "gain.gain"}
  },
  "halation": FORMAT,
  "inputs": {
    "beauty": {"file": "shot.exr", "layer": "Combined", "type": "Image"}
  },
  "links": {
    "gain.image": "inputs.beauty",
    "outputs.image": "soften.out",
    "soften.image": "gain.out"
  },
  "nodes": {
    "gain": {"type": "gain", "values": {"gain": 2.0}, "version": 1},
    "soften": {"type": "soften", "values": {"sigma": 4.0}, "version": 1}
  },
  "outputs": {
    "image": {"type": "Image"}
  },
  "ui": {"nodes": {"gain": [10, 20.5], "soften": [200, 20]}, "zoom": 1.5}
}
""".replace("FORMAT", str(FORMAT))
    )


def test_an_empty_graph() -> None:
    assert json.loads(dumps(Graph())) == {"halation": FORMAT}
    assert read('{"halation": 1}') == Graph()


def test_only_what_differs_is_written() -> None:
    graph = Graph({"a": Gain(), "b": Gain(gain=1, steps=3, tint=(1, 1, 1, 1)), "c": Gain(gain=3, mode="soft light")})
    nodes = json.loads(dumps(graph))["nodes"]
    assert nodes["a"] == nodes["b"] == {"type": "gain", "version": 1}
    assert nodes["c"]["values"] == {"gain": 3.0, "mode": "soft light"}
    assert '"gain": 3.0' in dumps(graph)


def test_ends_of_every_type() -> None:
    inputs = {
        str(number): Input(kind, width)
        for number, (kind, width) in enumerate((kind, width) for kind in Kind for width in (2, 3, 4))
    }
    graph = Graph(
        inputs=inputs
        | {
            "n": Input(Kind.NUMBER, default=1, doc="How much."),
            "c": Input(Kind.COLOR, default=(1, 0, 0, 1)),
        },
        outputs={name: Output(end.kind, end.width, layer="l") for name, end in inputs.items()},
        settings=Settings((1920, 1080)),
    )
    text = dumps(graph)
    assert read(text) == graph
    assert dumps(read(text)) == text
    types = {end["type"] for end in json.loads(text)["inputs"].values()}
    assert types == {"Image", "Field", "Number", "Color", "Camera", "Vector", "Vector2", "Vector4"}
    assert read('{"halation": 1, "inputs": {"v": {"type": "Vector3"}}}').inputs["v"] == Input(Kind.VECTOR, 3)


@settings(max_examples=80)
@given(st.integers(0, 2**32))
def test_what_is_written_comes_back(seed: int) -> None:
    graph = random_graph(Random(seed), 40)
    text = dumps(graph)
    assert read(text) == graph
    assert dumps(read(text)) == text
    assert json.loads(text) == json.loads(json.dumps(json.loads(text), sort_keys=True))
    compact = json.dumps(json.loads(text), separators=(",", ":"))
    assert dumps(read(compact)) == text, "formatting of the source does not matter"


FILLED: dict[str, Any] = {
    "settings": {
        "size": [640, 360],
        "frames": [2, 9],
        "rate": 25.0,
        "preroll": 3,
        "reference_height": 1080,
        "overscan": 0.25,
        "color": {"config": "show.ocio", "working": "ACEScg"},
        "allow": {"no-output": "a part"},
    },
    "inputs": {
        "beauty": {
            "type": "Vector2",
            "file": "a.####.exr",
            "layer": "Combined",
            "missing": "hold",
            "color_space": "ACEScg",
            "default": [0.5, 0.25],
            "doc": "The picture.",
        }
    },
    "outputs": {"image": {"type": "Field", "layer": "glow", "view": "none", "overscan": True}},
    "controls": {"glow": {"target": "gain.gain", "label": "Glow", "doc": "More."}},
}
"""Every key of these sections, with another value than its default."""


def test_every_key_of_a_section_is_saved() -> None:
    """What reading knows and writing forgets is lost without a word: `overscan` of an output was."""
    entries = [
        FILLED["settings"],
        *(entry for part in ("inputs", "outputs", "controls") for entry in FILLED[part].values()),
    ]
    kinds = (records.SettingsRecord, records.InputRecord, records.OutputRecord, records.ControlRecord)
    for entry, kind in zip(entries, kinds, strict=True):
        assert entry.keys() == {*kind.__struct_fields__}, "a key is missing here"
        assert entry["color"].keys() == {*records.ColorRecord.__struct_fields__} if "color" in entry else True
    raw = {"halation": FORMAT, "nodes": {"gain": {"type": "gain"}}, **FILLED}
    saved = json.loads(dumps(read(json.dumps(raw))))
    assert {name: saved[name] for name in FILLED} == FILLED


def sprinkle(rng: Random, tree: Any, path: tuple[str, ...] = ()) -> None:
    """Put unknown keys into every object whose keys are not names."""
    if not isinstance(tree, dict) or (path and path[0] == "ui"):
        return
    for key, part in list(tree.items()):
        sprinkle(rng, part, () if key == "graph" else (*path, key))
    is_list_of_names = (len(path) == 1 and path[0] != "settings") or (len(path) == 4 and path[2] == "values")
    is_unknown_node = tree.get("type") in ("lens", "gain9")
    if not is_list_of_names and not is_unknown_node and rng.random() < 0.6:
        tree[rng.choice(["later", "x.y", "ä"])] = rng.choice([None, 1, 1.5, [], {"a": {}}, "text", [True, {"b": [1]}]])


@settings(max_examples=80)
@given(st.integers(0, 2**32))
def test_unknown_nodes_and_keys_are_kept_to_the_byte(seed: int) -> None:
    rng = Random(seed)
    raw = json.loads(dumps(random_graph(rng, 30)))
    sprinkle(rng, raw)
    text = pretty(raw)
    assert dumps(read(text)) == text
    assert dumps(loads(text, catalogue={}, sandbox=UNRESTRICTED)) == text, "without any node type at all"


def test_where_unknown_keys_are_kept() -> None:
    raw = {
        "halation": FORMAT,
        "author": "me",
        "settings": {"fps": 24},
        "nodes": {
            "a": {"type": "gain", "version": 1, "memo": [1], "values": {"gian": 2}},
            "z": {"type": "lens", "f": 2},
        },
        "inputs": {"i": {"type": "Image", "raw": True}},
    }
    graph = read(json.dumps(raw))
    assert {path: dict(keys) for path, keys in graph.extra.items()} == {
        "": {"author": "me"},
        "settings": {"fps": 24},
        "nodes.a": {"memo": (1,)},
        "nodes.a.values": {"gian": 2},
        "inputs.i": {"raw": True},
    }
    assert graph.nodes["z"] == Unknown("lens", {"f": 2})
    assert dumps(graph) == pretty(raw)
    renamed = json.loads(dumps(graph.rename("a", "b")))
    assert renamed["nodes"]["b"] == raw["nodes"]["a"]
    assert json.loads(dumps(graph.remove("a").remove_input("i"))) == {
        "halation": FORMAT,
        "author": "me",
        "settings": {"fps": 24},
        "nodes": {"z": {"type": "lens", "f": 2}},
    }


def test_unknown_nodes_can_be_muted() -> None:
    graph = Graph({"z": Unknown("lens", {"f": 2})}).mute("z")
    assert json.loads(dumps(graph))["nodes"]["z"] == {"type": "lens", "f": 2, "muted": True}
    assert read(dumps(graph)) == graph
    assert "muted" not in dumps(read(dumps(graph)).mute("z", False))


def test_what_is_out_of_range_loads_and_is_a_problem() -> None:
    graph = read('{"halation": 1, "nodes": {"a": {"type": "gain", "values": {"gain": 99, "mode": "no", "steps": 0}}}}')
    assert graph.nodes["a"] == Gain(gain=99.0, mode="no", steps=0)
    errors = {problem.socket for problem in problems(graph, TOYS) if problem.severity == "error"}
    assert errors == {"gain", "mode", "steps"}
    assert read(dumps(graph)) == graph


def test_numbers_are_exact() -> None:
    for number in (0.1, 1 / 3, 1e-7, 5e-324, 1.5e300, 12345678.9):
        assert read(dumps(Graph({"a": Soften(sigma=number)}))).nodes["a"].sigma == number
    ui = {"big": 2**70, "whole": 3, "float": 3.0, "small": -0.0}
    assert '"big": 1180591620717411303424, "float": 3.0, "small": -0.0, "whole": 3' in dumps(Graph(ui=ui))


def test_text_is_exact() -> None:
    graph = Graph({"a": Gain(note='über \u2028 \x00 \U0001f600 \\ "')})
    assert read(dumps(graph)) == graph
    assert "über" in dumps(graph)


def test_lines_are_as_long_as_they_may_be() -> None:
    """An entry that ends at column 100 stays whole, one column more breaks it."""
    fits = {"halation": FORMAT, "x": "y" * (WIDTH - 2 - len('"x": "",'))}
    for length in range(70, 110):
        document = {"a": {"k": "v" * length}, "halation": FORMAT}
        line = '  "a": {"k": "' + "v" * length + '"},'
        assert (line in pretty(document)) == (len(line) <= WIDTH)
    assert max(map(len, pretty(fits).splitlines())) <= WIDTH


def test_a_node_is_a_line_in_a_diff() -> None:
    before = dumps(small()).splitlines()
    after = dumps(small().set(Port("soften", "sigma"), 5)).splitlines()
    assert [(old, new) for old, new in zip(before, after, strict=True) if old != new] == [
        (
            '    "soften": {"type": "soften", "values": {"sigma": 4.0}, "version": 1}',
            '    "soften": {"type": "soften", "values": {"sigma": 5.0}, "version": 1}',
        )
    ]


@pytest.mark.parametrize(
    ("graph", "says"),
    [
        (Graph({"a": Gain(gain=float("nan"))}), "nodes.a.values.gain: nan cannot be saved"),
        (Graph({"a": Gain(gain="x")}), "nodes.a.values.gain: 'x' cannot be saved; set a number"),
        (Graph({"a": Gain(tint=(1.0,))}), "set a list of 4 numbers"),
        (Graph(ui={"x": object()}), "ui.x: .* cannot be saved; JSON has no object"),
        (Graph(ui={"x": {1: 2}}), "ui.x: the key 1 cannot be saved; JSON has only text as keys"),
        (Graph({"a": Gain(note="\ud800")}), "not valid Unicode"),
        (Graph({"a.b": Gain()}), "leave out dots"),
        (Graph(inputs={"a": Input(default="red")}), "inputs.a.default: 'red' cannot be saved"),
    ],
)
def test_what_could_not_be_read_again_is_not_written(graph: Graph, says: str) -> None:
    with pytest.raises(GraphError, match=says):
        dumps(graph)


def test_groups_nested_too_deep_to_be_read_are_not_written() -> None:
    graph = small()
    for _ in range(30):
        graph = Graph({"g": Group(graph)})
    with pytest.raises(GraphError, match="nests deeper than 64"):
        dumps(graph)


def test_inline_groups() -> None:
    body = dataclasses.replace(small(), ui={}).add_control("blur", Control(Port("soften", "sigma")))
    graph = Graph({"g": Group(Graph({"h": Group(body, values={"blur": 9.0})}))}).mute("g")
    raw = json.loads(dumps(graph))["nodes"]["g"]
    assert raw["muted"] is True
    assert "halation" not in raw["graph"]
    assert raw["graph"]["nodes"]["h"]["values"] == {"blur": 9.0}
    assert read(dumps(graph)) == graph


def test_unknown_controls_of_groups_are_kept() -> None:
    raw = {"halation": FORMAT, "nodes": {"g": {"type": "group", "graph": {}, "values": {"gone": 1}}}}
    graph = read(json.dumps(raw))
    assert graph.extra["nodes.g.values"] == {"gone": 1}
    assert dumps(graph) == pretty({**raw, "nodes": {"g": raw["nodes"]["g"]}})


@settings(max_examples=200)
@given(st.integers(0, 2**32), st.randoms(use_true_random=False), st.sampled_from(["cut", "insert", "replace", "add"]))
def test_the_first_line_that_differs_from_the_canonical_text(seed: int, rng: Random, change: str) -> None:
    graph = random_graph(Random(seed))
    text = canonical = dumps(graph)
    assert find_first_difference(graph, canonical) is None
    at, letters = rng.randrange(len(text)), rng.choice(("\n", "x", "\n\n", '"', "}\n"))
    match change:
        case "cut":
            text = text[:at]
        case "insert":
            text = text[:at] + letters + text[at:]
        case "replace":
            text = text[:at] + letters + text[at + 1 :]
        case _:
            text += letters
    pairs = enumerate(zip_longest(text.split("\n"), canonical.split("\n")), 1)
    assert find_first_difference(graph, text) == next((line for line, (here, there) in pairs if here != there), None)
