"""Curves and color ramps as values: how they are declared, checked, saved, and what they are between their points."""

from __future__ import annotations

from typing import Annotated

import numpy as np
import pytest
from halation.document import dumps, loads
from halation.graph import Graph, Port
from halation.graph.values import coerce, value_fault
from halation.nodes import Curve, Filter, Image, Points, Stops, curve_at, ramp_at
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator
from toy_nodes import TOYS, Tint

RAMP = (0.25, 0.0, 2.0, 0.0, 1.0, 0.75, 1.0, 0.0, 0.5, 0.0)


def test_declarations():
    curve, ramp = Tint.values["curve"], Tint.values["ramp"]
    assert (curve.type, curve.low, curve.high, curve.length) == ("curve", 0.0, 1.0, 2)
    assert (ramp.type, ramp.length) == ("ramp", 5)
    assert (curve.glsl, curve.wireable, ramp.glsl, ramp.wireable) == ("vec4[17]", False, "vec4[34]", False)


def test_a_list_of_any_length_must_say_what_it_is():
    with pytest.raises(TypeError, match="'many': a list of any length is a Curve, a ColorRamp, a Spline or a Stroke"):
        type("Wrong", (Filter,), {"__annotations__": {"many": tuple[float, ...]}, "many": (0.0,), "image": Image()})


@pytest.mark.parametrize(
    ("name", "given", "fault"),
    [
        ("curve", (0, 0), "does not fit: it takes a list of x, y"),
        ("curve", (0, 0, 1), "does not fit"),
        ("curve", (0, 0, 1, float("nan")), "nan is not a finite number"),
        ("curve", (0, 0, 1.5, 1), "x = 1.5 is outside the range 0 to 1"),
        ("curve", (0.5, 0, 0.5, 1), "list the points from left to right"),
        ("curve", [x / 40 for x in range(36)], "18 points are too many: it takes at most 17"),
        ("curve", (0.0, -7.0, 0.5, 12.0, 0.75, 0.0), None),
        ("ramp", (0.0, 1.0, 1.0, 1.0, 1.0), "it takes a list of t, red"),
        ("ramp", (*RAMP[5:], *RAMP[:5]), "t = 0.25 follows 0.75"),
        ("ramp", (*RAMP, *RAMP[5:]), None),
    ],
)
def test_faults(name, given, fault):
    found = value_fault(Tint.values[name], given)
    assert found is None if fault is None else fault in found


def test_the_hard_range_of_a_curve_is_that_of_its_heights():
    class Limited(Filter):
        image = Image()
        curve: Annotated[Points, Curve(minimum=0.0, maximum=0.5)] = (0.0, 0.0, 1.0, 0.5)

    value = Limited.values["curve"]
    assert value_fault(value, (0.0, 0.5, 1.0, 0.0)) is None
    assert "outside the range 0 to 0.5" in value_fault(value, (0.0, 0.0, 1.0, 1.0))


def test_they_are_saved_and_read():
    graph = Graph({"tint": Tint()})
    graph = graph.set(Port("tint", "curve"), [0, 0.5, 0.25, -1, 1, 2]).set(Port("tint", "ramp"), RAMP + RAMP[5:])
    found = loads(dumps(graph), catalogue=TOYS, sandbox=UNRESTRICTED)
    assert found == graph
    assert found.value(Port("tint", "curve")) == (0.0, 0.5, 0.25, -1.0, 1.0, 2.0)
    assert coerce(Tint.values["ramp"], [0, 0, 0, 0, "1"]) is None


points = st.lists(
    st.tuples(st.integers(0, 64), st.integers(-50, 50)), min_size=2, max_size=9, unique_by=lambda point: point[0]
).map(lambda found: tuple(part for x, y in sorted(found) for part in (x / 64, y / 10)))


@given(points, st.floats(0.0, 1.0))
def test_a_curve_is_scipys_and_monotone_between_points(points, x):
    xs, ys = points[0::2], points[1::2]
    inside = min(max(x, xs[0]), xs[-1])
    assert curve_at(points, x) == pytest.approx(float(PchipInterpolator(xs, ys)(inside)), abs=1e-9)
    right = next((index for index, place in enumerate(xs) if place >= inside), len(xs) - 1)
    low, high = sorted((ys[max(right - 1, 0)], ys[right]))
    assert low - 1e-9 <= curve_at(points, inside) <= high + 1e-9


def test_a_straight_curve_is_the_identity():
    assert [curve_at((0.0, 0.0, 0.5, 0.5, 1.0, 1.0), x / 8) for x in range(9)] == [x / 8 for x in range(9)]


def test_ramps():
    assert ramp_at(RAMP, -1.0) == ramp_at(RAMP, 0.25) == (0.0, 2.0, 0.0, 1.0)
    assert ramp_at(RAMP, 0.5) == (0.5, 1.0, 0.25, 0.5)
    assert ramp_at(RAMP, 0.375, smooth=True) == pytest.approx((0.15625, 2 - 0.3125, 0.078125, 1 - 0.15625))
    assert ramp_at(RAMP, 1.0) == (1.0, 0.0, 0.5, 0.0)


def test_two_stops_at_one_place_are_a_hard_edge():
    stops = (0.0, 0.0, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 0.0, 1.0, 0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0)
    assert (ramp_at(stops, np.nextafter(0.5, 0))[0], ramp_at(stops, 0.5)[0]) == (0.0, 1.0)


def test_stops_are_a_kind_of_value_too():
    class Colored(Filter):
        image = Image()
        ramp: Stops = RAMP

    assert Colored.values["ramp"].default == RAMP
