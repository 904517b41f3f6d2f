"""Editing lists of lights, without a window."""

from __future__ import annotations

import pytest
from halation.editor.fields.fields import Fields
from halation.editor.fields.lights import (
    PARTS,
    change_kind,
    count_lights,
    describe_count,
    describe_intensity,
    insert_light,
    light_at,
    light_title,
    make_light,
    move_light,
    parts_of,
    remove_light,
    replace_light,
)
from halation.editor.fields.lights_field import find_selected
from halation.editor.theme.palette import DARK
from halation.graph.values import value_fault
from halation.nodes import MAX_LIGHTS, Light, LightKind, lights_of, numbers_of
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs
from toy_nodes import Lamps

LIGHTS = Lamps.values["lights"]
PART = {part.name: part for part in PARTS}
A, B, C = (Light(place=(float(index), 0.0, 0.0)) for index in range(3))
THREE = numbers_of((A, B, C))

edits = st.lists(
    st.tuples(
        st.sampled_from(["add", "double", "remove", "move", "turn", "set"]),
        st.integers(0, 9),
        st.sampled_from(LightKind),
        st.sampled_from(PARTS),
        st.floats(0.0, 90.0),
    ),
    max_size=16,
)


@given(edits)
def test_whatever_is_done_leaves_a_legal_value(edits):
    numbers, chosen = THREE, 0
    for act, index, kind, part, number in edits:
        count = count_lights(numbers)
        at = index % count if count else -1
        if act == "add":
            numbers, chosen = insert_light(numbers, at, make_light(kind))
        elif at < 0:
            continue
        elif act == "double":
            numbers, chosen = insert_light(numbers, at, light_at(numbers, at))
        elif act == "remove":
            numbers, chosen = remove_light(numbers, at)
        elif act == "move":
            numbers, chosen = move_light(numbers, at, index - 5)
        elif act == "turn":
            numbers = replace_light(numbers, at, change_kind(light_at(numbers, at), kind))
        else:
            old = part.read_from(light_at(numbers, at))
            new = tuple(number for _ in old) if isinstance(old, tuple) else number
            numbers = replace_light(numbers, at, part.apply_to(light_at(numbers, at), new))
        assert value_fault(LIGHTS, numbers) is None
        assert count_lights(numbers) == 0 or 0 <= min(chosen, count_lights(numbers) - 1) < count_lights(numbers)


def test_the_list():
    assert insert_light(THREE, 0, A) == (numbers_of((A, A, B, C)), 1)
    assert insert_light((), -1, A) == (A.numbers, 0)
    assert remove_light(THREE, 1) == (numbers_of((A, C)), 1)
    assert remove_light(THREE, 2) == (numbers_of((A, B)), 1)
    assert remove_light(A.numbers, 0) == ((), -1)
    assert move_light(THREE, 0, 1) == (numbers_of((B, A, C)), 1)
    assert move_light(THREE, 2, -2) == (numbers_of((C, A, B)), 0)
    assert move_light(THREE, 2, 1) == (THREE, 2)
    assert replace_light(THREE, 1, C) == numbers_of((A, C, C))
    full = A.numbers * MAX_LIGHTS
    assert insert_light(full, 3, B) == (full, 3) and move_light(full, 3, 2) == (full, 5)


@pytest.mark.parametrize("kind", LightKind)
def test_parts(kind):
    parts = parts_of(kind)
    assert all(value_fault(part.declaration, part.read_from(make_light(kind))) is None for part in parts)
    assert all(part.apply_to(make_light(kind), part.declaration.default) == make_light(kind) for part in parts)
    assert lights_of(make_light(kind).numbers) == (make_light(kind),)


def test_each_kind_has_what_it_needs():
    names = {kind: {part.name for part in parts_of(kind)} for kind in LightKind}
    assert names == {
        LightKind.POINT: {"place", "color", "intensity", "reach"},
        LightKind.SPOT: {"place", "direction", "color", "intensity", "reach", "inner", "outer"},
        LightKind.SUN: {"direction", "color", "intensity"},
        LightKind.SPHERE: {"place", "color", "intensity", "reach", "size"},
    }
    assert set(Light.__struct_fields__) == {*PART, "kind", "on"}


def test_what_is_set_of_a_light():
    assert PART["color"].read_from(A) == (1.0, 1.0, 1.0, 1.0)
    assert PART["color"].apply_to(A, (1.0, 2.0, 3.0, 0.5)).color == (1.0, 2.0, 3.0)
    assert PART["direction"].apply_to(A, (0.0, 0.0, 0.0)) == A
    assert PART["intensity"].apply_to(A, -4.0).intensity == -4.0
    assert PART["inner"].apply_to(A, 40.0) == structs.replace(A, inner=40.0, outer=40.0)
    assert PART["outer"].apply_to(A, 5.0) == structs.replace(A, inner=5.0, outer=5.0)
    assert (PART["intensity"].unit(LightKind.SUN), PART["intensity"].unit(LightKind.SPOT)) == ("W/m²", "W/sr")
    assert PART["outer"].unit(LightKind.SPOT) is None


def test_another_kind_keeps_what_was_set():
    assert change_kind(A, LightKind.SUN) == structs.replace(make_light(LightKind.SUN), place=A.place)
    assert change_kind(change_kind(A, LightKind.SUN), LightKind.POINT) == A
    bright = structs.replace(A, intensity=7.0)
    assert change_kind(bright, LightKind.SUN) == structs.replace(bright, kind=LightKind.SUN)


def test_words():
    assert [describe_count(()), describe_count(A.numbers), describe_count(THREE)] == [
        "no lights",
        "1 light",
        "3 lights",
    ]
    assert light_title(Light(LightKind.SPOT), 1) == "Spot 2"
    numbers = (0.0, -3.0, 0.125, 1234.5, 1e7)
    lights = [structs.replace(A, intensity=number) for number in numbers]
    assert [describe_intensity(light) for light in lights] == ["0", "-3", "0.125", "1234", "1e+07"]


def test_one_is_selected():
    state = Fields(DARK)
    assert find_selected(state, "a", THREE) == 0 and find_selected(state, "a", ()) == -1
    state.lights["a"] = 2
    assert find_selected(state, "a", THREE) == 2 and find_selected(state, "a", A.numbers) == 0
