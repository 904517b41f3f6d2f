"""Editing curves and color ramps, without a window."""

from __future__ import annotations

import pytest
from halation.editor.fields.points import (
    CURVES,
    RAMPS,
    find_nearest,
    insert_point,
    invert,
    move_point,
    remove_point,
    scale_curve,
)
from halation.graph.values import value_fault
from hypothesis import given
from hypothesis import strategies as st
from toy_nodes import Tint

LINE = (0.0, 0.0, 0.5, 0.5, 1.0, 1.0)
CURVE, RAMP = Tint.values["curve"], Tint.values["ramp"]


@pytest.mark.parametrize("numbers", CURVES.values(), ids=CURVES)
def test_presets_of_curves_are_legal(numbers):
    assert value_fault(CURVE, numbers) is None
    assert value_fault(CURVE, invert(numbers, 2)) is None
    assert scale_curve(numbers, -2.0, 2.0)[1] in (-2.0, 2.0)


@pytest.mark.parametrize("numbers", RAMPS.values(), ids=RAMPS)
def test_presets_of_ramps_are_legal(numbers):
    assert value_fault(RAMP, numbers) is None
    assert value_fault(RAMP, invert(numbers, 5)) is None
    assert invert(invert(numbers, 5), 5) == pytest.approx(numbers)


edits = st.lists(
    st.tuples(
        st.sampled_from(["move", "add", "remove"]), st.integers(0, 9), st.floats(-1.0, 2.0), st.floats(-9.0, 9.0)
    ),
    max_size=12,
)


@given(edits, st.sampled_from([2, 5]))
def test_whatever_is_done_leaves_a_legal_value(edits, width):
    numbers = LINE if width == 2 else RAMPS["Fire"]
    for act, index, x, y in edits:
        point = (x, *[y] * (width - 1))
        index %= len(numbers) // width
        if act == "move":
            numbers = move_point(numbers, width, index, point)
        elif act == "add":
            numbers, _ = insert_point(numbers, width, (min(max(x, 0.0), 1.0), *point[1:]))
        else:
            numbers = remove_point(numbers, width, index)
        assert value_fault(CURVE if width == 2 else RAMP, numbers) is None


def test_points():
    assert move_point(LINE, 2, 1, (7.0, 3.0)) == (0.0, 0.0, 0.999, 3.0, 1.0, 1.0)
    assert insert_point(LINE, 2, (0.25, 2.0)) == ((0.0, 0.0, 0.25, 2.0, 0.5, 0.5, 1.0, 1.0), 1)
    assert insert_point(LINE, 2, (0.5, 2.0)) == (LINE, 1)
    full = tuple(part for at in range(17) for part in (at / 16, 0.5))
    assert insert_point(full, 2, (0.27, 2.0)) == (full, 4)
    assert remove_point(LINE, 2, 0) == (0.5, 0.5, 1.0, 1.0)
    assert remove_point((0.0, 0.0, 1.0, 1.0), 2, 0) == (0.0, 0.0, 1.0, 1.0)
    assert find_nearest(LINE, 2, 0.52, 0.47, (0.05, 0.05)) == 1
    assert find_nearest(LINE, 2, 0.52, 0.2, (0.05, 0.05)) == -1
    assert invert(LINE, 2) == (0.0, 1.0, 0.5, 0.5, 1.0, 0.0)
