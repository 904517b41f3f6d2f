"""Lights as named items: how they are held, checked, converted and saved."""

from __future__ import annotations

import json

import pytest
from halation.document import dumps, loads
from halation.errors import DocumentError, GraphError
from halation.graph import Graph, Port, problems
from halation.graph.values import coerce, value_fault
from halation.nodes import (
    Filter,
    Image,
    Light,
    LightKind,
    LightSet,
    lights_of,
    name_lights,
    natural_order,
    number_lights,
)
from halation.resources.sandbox import UNRESTRICTED

SPOT = Light(
    LightKind.SPOT, (1.0, 2.0, 3.0), (0.0, 1.0, 0.0), (1.0, 0.5, 0.0), -3.0, reach=8.0, inner=10.0, outer=25.0, on=False
)
OLD = (
    (0.0, 0.0, 0.0, 2.0, 0.0, 0.0, -1.0, 1.0, 1.0, 1.0, 10.0, 0.0, 20.0, 30.0, 0.1, 1.0),
    (1.0, 1.0, 2.0, 3.0, 0.0, 1.0, 0.0, 1.0, 0.5, 0.0, -3.0, 8.0, 10.0, 25.0, 0.2, 0.0),
    (2.0, 9.0, 9.0, 9.0, 0.5, 0.5, -1.0, 1.0, 1.0, 1.0, 2.0, 4.0, 20.0, 30.0, 0.1, 1.0),
    (3.0, 1.0, 1.0, 1.0, 0.0, 0.0, -1.0, 1.0, 1.0, 1.0, 5.0, 0.0, 20.0, 30.0, 0.7, 1.0),
)


class Lamps(Filter):
    """Lit."""

    image = Image()
    lights: LightSet = name_lights(key=Light(), back=SPOT)


LIGHTS = Lamps.values["lights"]
TYPES = {"lamps": Lamps}


def document(lights: object) -> str:
    return json.dumps({"halation": 1, "nodes": {"lamps": {"type": "lamps", "values": {"lights": lights}}}})


def read(lights: object) -> Graph:
    return loads(document(lights), "f.json", catalogue=TYPES, sandbox=UNRESTRICTED)


def test_lights_are_items_and_back():
    assert lights_of(Lamps().lights) == (SPOT, Light()) and tuple(Lamps().lights) == ("back", "key")
    assert (LIGHTS.type, LIGHTS.glsl, LIGHTS.wireable) == ("items", None, False)


def test_names_are_in_natural_order():
    names = [f"lamp_{number}" for number in range(1, 13)]
    assert sorted(set(names), key=natural_order) == names
    assert tuple(number_lights([Light()] * 12)) == tuple(names)


@pytest.mark.parametrize(
    ("given", "fault"),
    [
        ((0.0,) * 15, "it takes lights by name"),
        ((7.0, *(0.0,) * 15), "it takes lights by name"),
        ({"key": {"kind": "spot", "intensity": float("inf")}}, "key.intensity: inf is not a finite number"),
        ({"key": {"kind": "spot", "inner": 200.0}}, "key.inner: 200.0 is outside the range 0 to 180"),
        ({"key": {"kind": "sun", "inner": 20.0}}, "key.inner: a sun has no field 'inner'"),
        ({"key": {"kind": "spt"}}, "key.kind: 'spt' is no kind of light; did you mean 'spot'?"),
        ({"key": {"kind": "spot", "intensity": "a"}}, "key.intensity: expected a number"),
        ({"key": 5}, "key: a light is an object of fields"),
        ({"a.b": {"kind": "sun"}}, "a light cannot be called 'a.b'"),
        ({f"lamp_{number}": {} for number in range(1025)}, "1025 lights are too many: it takes at most 1024"),
    ],
)
def test_what_is_no_light_is_said(given, fault):
    assert fault in (value_fault(LIGHTS, given) or "")


def test_any_number_of_lights_will_do():
    assert len(coerce(LIGHTS, {})) == 0 and value_fault(LIGHTS, {}) is None
    assert value_fault(LIGHTS, number_lights((SPOT, Light()) * 512)) is None


def test_lights_of_the_first_version_are_the_same_lights():
    lights = coerce(LIGHTS, tuple(part for light in OLD for part in light))
    assert tuple(lights) == ("lamp_1", "lamp_2", "lamp_3", "lamp_4")
    assert lights_of(lights) == (
        Light(),
        SPOT,
        Light(LightKind.SUN, direction=(0.5, 0.5, -1.0), intensity=2.0),
        Light(LightKind.SPHERE, (1.0, 1.0, 1.0), intensity=5.0, size=0.7),
    )
    assert read([part for light in OLD for part in light]).value(Port("lamps", "lights")) == lights


def test_each_field_has_a_key_and_defaults_are_left_out():
    graph = Graph().add("lamps", Lamps(lights=name_lights(key=Light(intensity=3.0), back=SPOT)))
    text = dumps(graph)
    lights = json.loads(text)["nodes"]["lamps"]["values"]["lights"]
    assert lights["key"] == {"kind": "point", "intensity": 3.0}
    assert set(lights["back"]) == {"kind", "place", "direction", "color", "intensity", "reach", "inner", "outer", "on"}
    assert loads(text, catalogue=TYPES, sandbox=UNRESTRICTED) == graph


def test_what_a_newer_version_has_is_kept():
    text = document({"key": {"kind": "spot", "glow": 3}, "beam": {"kind": "laser", "power": 2}})
    graph = loads(text, catalogue=TYPES, sandbox=UNRESTRICTED)
    assert tuple(graph.value(Port("lamps", "lights"))) == ("key",)
    sentences = [problem.sentence for problem in problems(graph) if problem.rule.name == "unknown-key"]
    assert "nodes.lamps.values.lights.beam means nothing to this version" in sentences[0]
    assert "nodes.lamps.values.lights.key.glow means nothing to this version" in sentences[1]
    renamed = graph.rename("lamps", "relight")
    lights = json.loads(dumps(renamed))["nodes"]["relight"]["values"]["lights"]
    assert lights == {"key": {"kind": "spot", "glow": 3}, "beam": {"kind": "laser", "power": 2}}


@pytest.mark.parametrize(
    ("lights", "sentence"),
    [
        (
            {"key": {"kind": "spot", "intensity": "a"}},
            "f.json: nodes.lamps.values.lights.key.intensity: expected a number",
        ),
        ([1.0, 2.0], "f.json: nodes.lamps.values.lights: expected lights by name"),
        ({"key": {"kind": 5}}, "f.json: nodes.lamps.values.lights.key.kind: 5 is no kind of light"),
    ],
)
def test_a_damaged_file_names_the_light_and_the_field(lights, sentence):
    with pytest.raises(DocumentError) as error:
        read(lights)
    assert sentence in str(error.value)


@pytest.mark.parametrize(
    ("path", "setting", "sentence"),
    [
        ("lamps.kay.intensity", 2, "'lamps.lights' has no light 'kay'; did you mean 'key'?"),
        ("lamps.lights.key.intnsity", 2, "light 'lamps.lights.key', a point, has no field 'intnsity'; did you mean"),
        ("lamps.lights.key", 2, "'lamps.lights.key' is a light: name one of its fields"),
        ("lamps.key.reach", -2, "lamps.lights.key.reach: -2 is outside the range of 0 and more"),
        ("lamps.key.kind", "spt", "lamps.lights.key.kind: 'spt' is not a choice"),
    ],
)
def test_a_wrong_path_or_setting_is_said(path, setting, sentence):
    with pytest.raises(GraphError) as error:
        Graph().add("lamps", Lamps()).override(path, setting)
    assert sentence in str(error.value)


def test_a_field_is_set_by_its_path_with_or_without_the_value():
    graph = Graph().add("lamps", Lamps())
    for path in ("lamps.lights.key.intensity", "lamps.key.intensity"):
        changed = graph.override(path, 2).value(Port("lamps", "lights"))
        assert lights_of(changed) == (SPOT, Light(intensity=2.0))
    assert graph.override("lamps.key.intensity", 10) == graph
    assert lights_of(graph.override("lamps.back.kind", "sun").value(Port("lamps", "lights")))[0].kind is LightKind.SUN
