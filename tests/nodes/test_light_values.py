"""Lights as values: how they are held, checked and saved."""

from __future__ import annotations

import pytest
from halation.document import dumps, loads
from halation.graph import Graph
from halation.graph.values import coerce, value_fault
from halation.nodes import Filter, Image, Light, LightKind, LightList, lights_of, numbers_of
from halation.resources.sandbox import UNRESTRICTED

TWO = (
    Light(),
    Light(LightKind.SPOT, (1.0, 2.0, 3.0), (0.0, 1.0, 0.0), (1.0, 0.5, 0.0), -3.0, 8.0, 10.0, 25.0, 0.2, False),
)


class Lamps(Filter):
    """Lit."""

    image = Image()
    lights: LightList = numbers_of(TWO)


def test_lights_are_numbers_and_back():
    assert lights_of(numbers_of(TWO)) == TWO and lights_of(()) == ()
    value = Lamps.values["lights"]
    assert (value.type, value.length, value.glsl, value.wireable) == ("lights", 16, None, False)


@pytest.mark.parametrize(
    ("given", "fault"),
    [
        ((0.0,) * 15, "it takes a list of 16 numbers for every light"),
        ((7.0, *(0.0,) * 15), "light 1 is of kind 7: 0 is a point, 1 a spot, 2 a sun, 3 a sphere"),
        ((*(0.0,) * 15, float("inf")), "inf is not a finite number"),
        ((0.0,) * 16 * 1025, "1025 lights are too many: it takes at most 1024"),
    ],
)
def test_what_is_no_list_of_lights_is_said(given, fault):
    assert fault in (value_fault(Lamps.values["lights"], given) or "")


def test_any_number_of_lights_will_do():
    value = Lamps.values["lights"]
    assert coerce(value, []) == () and value_fault(value, ()) is None
    assert value_fault(value, numbers_of(TWO * 512)) is None


def test_they_are_saved_with_the_graph():
    types = {"lamps": Lamps}
    graph = Graph().add("lamps", Lamps(lights=numbers_of(TWO[1:])))
    assert loads(dumps(graph), catalogue=types, sandbox=UNRESTRICTED).nodes["lamps"] == graph.nodes["lamps"]
