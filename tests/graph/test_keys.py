"""Keys: the curves between them against scipy and closed forms, and the edits of a dope sheet."""

from __future__ import annotations

import math
from itertools import pairwise
from random import Random
from typing import Any

import numpy as np
import pytest
from halation.errors import GraphError
from halation.graph.keys import Extrapolation, Interpolation, Key, Keys, round_keys
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator
from scipy.optimize import brentq

WAYS: tuple[Interpolation, ...] = ("constant", "linear", "smooth", "bezier")
HEIGHT = st.one_of(st.integers(-3, 3).map(float), st.floats(-100, 100).map(lambda x: round(x, 6)))
HEIGHTS = st.lists(HEIGHT, min_size=2, max_size=8)


def keyed(frames, values, way: Interpolation = "smooth", outside: Extrapolation = "hold") -> Keys:
    return Keys(tuple(Key(frame, value, way) for frame, value in zip(frames, values, strict=True)), outside)


def eased(x1: float, y1: float, x2: float, y2: float) -> Keys:
    """The CSS easing cubic-bezier(x1, y1, x2, y2) from (0, 0) to (1, 1)."""
    return Keys((Key(0.0, 0.0, "bezier", right=(x1, y1)), Key(1.0, 1.0, "bezier", left=(x2 - 1.0, y2 - 1.0))))


@settings(max_examples=300)
@given(st.data())
def test_smooth_is_pchip_with_flat_ends(data: st.DataObject) -> None:
    values = data.draw(HEIGHTS)
    steps = data.draw(st.lists(st.floats(0.25, 40), min_size=len(values), max_size=len(values)))
    frames = np.cumsum(steps) - 20.0
    slopes = PchipInterpolator(frames, values).derivative()(frames)
    slopes[0] = slopes[-1] = 0.0
    keys, reference = keyed(frames.tolist(), values), CubicHermiteSpline(frames, values, slopes)
    for frame in np.linspace(frames[0], frames[-1], 57):
        assert keys.evaluate(float(frame)) == pytest.approx(float(reference(frame)), rel=1e-10, abs=1e-10)
    for frame, slope in zip(frames.tolist(), slopes, strict=True):
        assert keys.slopes(frame)[0] == pytest.approx(slope, rel=1e-6, abs=1e-9)


@settings(max_examples=200)
@given(HEIGHTS, st.floats(0, 1))
def test_smooth_stays_between_its_keys(values: list[float], u: float) -> None:
    keys = keyed(range(0, 10 * len(values), 10), values)
    for place, (a, b) in enumerate(pairwise(values)):
        assert min(a, b) - 1e-9 <= keys.evaluate(10 * (place + u)) <= max(a, b) + 1e-9


def test_vectors_go_channel_by_channel() -> None:
    rng = Random(4)
    frames = [1.0, 4.0, 4.5, 12.0, 20.0]
    values = [tuple(rng.uniform(-5, 5) for _ in range(4)) for _ in frames]
    for way in WAYS:
        keys = keyed(frames, values, way)
        parts = [keyed(frames, [value[channel] for value in values], way) for channel in range(4)]
        for frame in np.linspace(-1, 23, 99).tolist():
            assert keys.evaluate(frame) == tuple(part.evaluate(frame) for part in parts)


@settings(max_examples=300)
@given(st.floats(0, 1), st.floats(-3, 4), st.floats(0, 1), st.floats(-3, 4), st.floats(0.001, 0.999))
def test_bezier_against_a_root_finder(x1: float, y1: float, x2: float, y2: float, x: float) -> None:
    def place(t: float) -> float:
        return 3 * (1 - t) ** 2 * t * x1 + 3 * (1 - t) * t * t * x2 + t**3

    t = brentq(lambda t: place(t) - x, 0.0, 1.0, xtol=1e-15, rtol=1e-14)
    expected = 3 * (1 - t) ** 2 * t * y1 + 3 * (1 - t) * t * t * y2 + t**3
    speed = 3 * (1 - t) ** 2 * x1 + 6 * (1 - t) * t * (x2 - x1) + 3 * t * t * (1 - x2)
    if speed > 1e-3:
        assert eased(x1, y1, x2, y2).evaluate(x) == pytest.approx(expected, abs=1e-9)
    else:
        assert eased(x1, x1, x2, x2).evaluate(x) == pytest.approx(x, abs=1e-9)


def test_bezier_closed_values() -> None:
    """Symmetric easings pass the middle; a straight one is the identity; frame(t) = t^3, value(t) = t has a root."""
    assert eased(0.42, 0.0, 0.58, 1.0).evaluate(0.5) == pytest.approx(0.5, abs=1e-12)
    assert eased(0.25, 0.25, 0.75, 0.75).evaluate(0.3) == pytest.approx(0.3, abs=1e-12)
    for x in (1e-6, 0.001, 0.2, 0.7, 0.999):
        assert eased(0.0, 1 / 3, 0.0, 2 / 3).evaluate(x) == pytest.approx(x ** (1 / 3), abs=1e-9)
        assert eased(1 / 3, 0.0, 2 / 3, 0.0).evaluate(x) == pytest.approx(x**3, abs=1e-12)


def test_automatic_handles_are_smooth() -> None:
    frames, values = [0.0, 3.0, 10.0, 11.0, 30.0], [1.0, 4.0, 4.5, -2.0, 7.0]
    smooth, bezier = keyed(frames, values), keyed(frames, values, "bezier")
    for frame in np.linspace(-2, 33, 141).tolist():
        assert bezier.evaluate(frame) == pytest.approx(smooth.evaluate(frame), abs=1e-12)


def test_handles_are_shortened_to_their_segment() -> None:
    long = Keys((Key(0.0, 0.0, "bezier", right=(30.0, 30.0)), Key(10.0, 0.0, "bezier", left=(-5.0, 0.0))))
    short = long.with_handles(0.0, right=(10.0, 10.0))
    back = long.with_handles(0.0, right=(-4.0, 3.0))
    upright = long.with_handles(0.0, right=(0.0, 3.0))
    for frame in np.linspace(0, 10, 41).tolist():
        assert long.evaluate(frame) == pytest.approx(short.evaluate(frame), abs=1e-12)
        assert back.evaluate(frame) == pytest.approx(upright.evaluate(frame), abs=1e-12)
    assert long.handles(0.0) == ((), (10.0, 10.0))
    assert long.handles(10.0) == ((-5.0, 0.0), ())


def test_held_frames_take_no_part_in_curves() -> None:
    keys = keyed([0.0, 10.0, 20.0, 30.0], [0.5, 1.0, 2.0, 4.0])
    alone = keyed([10.0, 20.0, 30.0], [1.0, 2.0, 4.0])
    held = keys.with_interpolation([0.0], "constant")
    assert [held.evaluate(frame) for frame in (0.0, 5.0, 9.99)] == [0.5, 0.5, 0.5]
    assert [held.evaluate(frame) for frame in range(10, 31)] == [alone.evaluate(frame) for frame in range(10, 31)]
    assert keys.evaluate(12.0) != alone.evaluate(12.0)


@pytest.mark.parametrize("first", [3, -4])
@pytest.mark.parametrize(("outside", "mode"), [("loop", "wrap"), ("mirror", "reflect")])
def test_periods_begin_at_the_first_key(outside: Extrapolation, mode: Any, first: int) -> None:
    """Wherever that is: as numpy repeats the seven values between the keys, and mirrors them."""
    heights = [0.0, 2.0, 5.0, 1.0, 0.5, -1.0, 4.0] + ([0.0] if outside == "loop" else [])
    keys = keyed([float(first + place) for place in range(len(heights))], heights, "linear", outside)
    table = np.pad(heights[:7], 23, mode)
    assert [keys.evaluate(float(first + place)) for place in range(-23, 30)] == pytest.approx(table.tolist(), abs=1e-12)


def test_outside_of_the_keys() -> None:
    frames, values = [10.0, 15.0, 20.0], [1.0, 3.0, 4.0]

    def at(outside: Extrapolation, frame: float, way: Interpolation = "linear") -> float:
        return keyed(frames, values, way, outside).evaluate(frame)

    assert (at("hold", -5), at("hold", 99)) == (1.0, 4.0)
    assert (at("linear", 5), at("linear", 25)) == (pytest.approx(-1.0), pytest.approx(5.0))
    assert (at("linear", 5, "constant"), at("linear", 25, "constant")) == (1.0, 4.0)
    assert [at("loop", frame) for frame in (21, 31, 9, -1, 30)] == pytest.approx([1.4, 1.4, 3.8, 3.8, 1.0])
    assert [at("mirror", frame) for frame in (21, 31, 9, -1, 30, 40)] == pytest.approx([3.8, 1.4, 1.4, 3.8, 1.0, 4.0])
    assert at("linear", 25, "smooth") == at("linear", 25, "bezier") == 4.0
    tilted = keyed(frames, values, "bezier", "linear").with_handles(20.0, left=(-1.0, -0.5))
    assert (tilted.evaluate(21.0), tilted.evaluate(30.0)) == pytest.approx((4.5, 9.0))
    upright = keyed(frames, values, "bezier", "linear").with_handles(20.0, left=(0.0, -1.0))
    assert math.isfinite(upright.evaluate(30.0))
    assert Keys((Key(1.0, 7.0),), "loop").evaluate(99) == 7.0


def test_what_is_no_number_is_held() -> None:
    keys = keyed([1.0, 5.0], [True, False], "linear", "linear")
    assert [keys.evaluate(frame) for frame in (0, 1, 4.9, 5, 6)] == [True, True, True, False, False]
    assert keyed([1.0, 5.0], [(1.0, 2.0), (1.0, 2.0, 3.0)]).evaluate(3) == (1.0, 2.0)


def test_between_whole_numbers_are_numbers() -> None:
    keys = keyed([0.0, 4.0], [-1, 1], "linear")
    assert [keys.evaluate(frame) for frame in range(5)] == [-1.0, -0.5, 0.0, 0.5, 1.0]
    assert [round_keys(x) for x in (0.5, 1.5, 2.5, -0.5, -1.5, 0.49999999999999994, 2.4)] == [1, 2, 3, -1, -2, 0, 2]


def test_faults() -> None:
    for wrong in (math.nan, math.inf):
        with pytest.raises(GraphError):
            Key(wrong, 1.0)
    with pytest.raises(GraphError):
        Keys().evaluate(1.0)
    keys = keyed([1.0, 2.0], [0.0, 1.0])
    for edit in (
        lambda: keys.scale(None, 0.0, 1.0),
        lambda: keys.with_handles(3.0),
        lambda: keys.move(None, 1.0, (1.0, 2.0)),
        lambda: keys.with_handles(1.0, left=(1.0, 2.0, 3.0)),
        lambda: keys.with_handles(1.0, left=(1.0, math.nan)),
    ):
        with pytest.raises(GraphError):
            edit()


def test_keys_are_in_order_and_one_per_frame() -> None:
    keys = keyed([5.0, 1.0, 5.0], [1.0, 2.0, 3.0])
    assert [(key.frame, key.value) for key in keys.keys] == [(1.0, 2.0), (5.0, 3.0)]


def test_setting_a_key() -> None:
    keys = Keys().set(1.0, 2.0)
    assert keys.keys == (Key(1.0, 2.0, "smooth"),)
    assert Keys().set(1.0, True).keys[0].interpolation == "constant"
    keys = keys.set(9.0, 4.0, "linear").set(1.0, 3.0, "bezier").with_handles(1.0, right=(1.0, 1.0))
    assert keys.set(1.0, 0.0).keys[0] == Key(1.0, 0.0, "bezier", right=(1.0, 1.0))
    assert [keys.set(frame, 0.0).key(frame).interpolation for frame in (0, 4, 12)] == ["bezier", "bezier", "linear"]
    assert keys.remove(1.0).frames == (9.0,) and keys.remove(2.0) == keys


@pytest.mark.parametrize("way", WAYS)
def test_a_key_put_on_the_curve(way: Interpolation) -> None:
    keys = keyed([0.0, 8.0, 20.0], [(0.0, 1.0), (4.0, -1.0), (1.0, 0.0)], way)
    keys = keys.with_handles(8.0, left=(-3.0, 4.0, -9.0)).insert(5.0)
    assert keys.frames == (0.0, 5.0, 8.0, 20.0) and keys.insert(5.0) == keys
    before = (
        keys.remove(5.0)
        if way != "bezier"
        else keyed([0.0, 8.0, 20.0], [(0.0, 1.0), (4.0, -1.0), (1.0, 0.0)], way).with_handles(
            8.0, left=(-3.0, 4.0, -9.0)
        )
    )
    assert keys.evaluate(5.0) == pytest.approx(before.evaluate(5.0))
    if way != "smooth":
        for frame in np.linspace(0, 8, 81).tolist():
            assert keys.evaluate(frame) == pytest.approx(before.evaluate(frame), abs=1e-9)


def test_moving_keys() -> None:
    keys = keyed([1.0, 5.0, 9.0], [1.0, 2.0, 3.0], "linear")
    assert keys.move([1.0], 4.0, 0.5).keys == (Key(5.0, 1.5, "linear"), Key(9.0, 3.0, "linear"))
    assert keys.move([1.0, 5.0], 4.0).keys == (Key(5.0, 1.0, "linear"), Key(9.0, 2.0, "linear"))
    assert keys.move([9.0], -20.0).frames == (-11.0, 1.0, 5.0)
    assert keys.move(None, 0.1).move(None, 0.2).frames == (1.3, 5.3, 9.3)
    assert keyed([1.0], [(1.0, 2.0)]).move(None, 0.0, (0.0, 1.0)).evaluate(1) == (1.0, 3.0)
    assert keyed([1.0], [True]).move(None, 1.0, 5.0).evaluate(2) is True
    assert keyed([1.0], [1]).move(None, 0.0, 0.5).evaluate(1) == 2


def test_scaling_keys() -> None:
    keys = keyed([1.0, 5.0, 9.0], [1.0, 2.0, 3.0], "bezier").with_handles(5.0, left=(-1.0, 2.0), right=(2.0, 1.0))
    wide = keys.scale(None, 2.0, 1.0)
    assert wide.frames == (1.0, 9.0, 17.0) and wide.key(9.0).left == (-2.0, 2.0) and wide.key(9.0).right == (4.0, 1.0)
    for frame in np.linspace(1, 9, 33).tolist():
        assert wide.evaluate(1 + 2 * (frame - 1)) == pytest.approx(keys.evaluate(frame), abs=1e-9)
    assert keys.scale([5.0, 9.0], 0.3, 1.0, whole=True).frames == (1.0, 2.0, 3.0)
    assert wide.scale(None, 0.5, 1.0) == keys


def some_edit(rng: Random, keys: Keys) -> Keys:
    some = rng.sample(keys.frames, rng.randint(1, len(keys.frames)))
    return rng.choice(
        (
            lambda: keys.set(rng.randrange(40), rng.uniform(-1, 1), rng.choice((*WAYS, None))),
            lambda: keys.insert(rng.uniform(0, 40)),
            lambda: keys.move(some, rng.randint(-5, 5), rng.uniform(-1, 1)),
            lambda: keys.scale(some, rng.uniform(0.5, 1.5), 10.0, rng.random() < 0.5),
            lambda: keys.with_interpolation(some, rng.choice(WAYS)),
            lambda: keys.with_handles(some[0], *((rng.uniform(-9, 9), rng.uniform(-2, 2)) for _ in "lr")),
            lambda: keys.remove(some[0]) if len(keys.keys) > 1 else keys,
        )
    )()


@settings(max_examples=200)
@given(st.integers(0, 2**32))
def test_any_edits_leave_keys_that_have_values(seed: int) -> None:
    rng = Random(seed)
    keys = Keys((), rng.choice(("hold", "linear", "loop", "mirror"))).set(rng.randrange(9), rng.uniform(-1, 1))
    for _ in range(30):
        keys = some_edit(rng, keys)
        assert list(keys.frames) == sorted(set(keys.frames))
        assert all(math.isfinite(keys.evaluate(rng.uniform(-60, 100))) for _ in range(4))
        for frame in keys.frames:
            assert keys.evaluate(frame) == keys.key(frame).value
            for side, back in zip(keys.handles(frame), (True, False), strict=True):
                assert not side or (side[0] <= 0.0 if back else side[0] >= 0.0)
