"""What is typed below the column of names sets one key: its frame, its value and its handles."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.authoring.commands import ReplaceGraph
from halation.authoring.session import Session
from halation.editor.curves.key_fields import KeyFields
from halation.editor.curves.state import CurvesState
from halation.editor.fields.fields import Edit
from halation.graph import Graph, Key, Keys, Port
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain

GAIN, TINT = Port("gain", "gain"), Port("gain", "tint")
RED, GREEN = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0)


@pytest.fixture
def frame() -> Any:
    session = Session(TOYS, sandbox=UNRESTRICTED)
    graph = Graph().add("gain", Gain()).animate(GAIN, Keys(tuple(Key(at, at / 5, "bezier") for at in (1, 10, 20))))
    session.apply(ReplaceGraph("Start", graph.animate(TINT, Keys((Key(1, RED), Key(10, GREEN))))))
    state = CurvesState(mode="curves", spots=frozenset({(GAIN, 10.0, 0)}))
    context = SimpleNamespace(session=session, curves=state)
    return SimpleNamespace(context=context, state=state, session=session, is_sheet=False)


def apply(frame: Any, name: str, *numbers: float) -> tuple[Key, ...]:
    frame.graph = frame.session.graph
    KeyFields()._apply(frame, name, Edit(numbers))  # pyright: ignore[reportPrivateUsage]
    return frame.session.graph.animation[GAIN].keys


def rows(frame: Any) -> dict[str, tuple[float, ...]]:
    frame.graph = frame.session.graph
    return {name: numbers for name, _, numbers, _ in KeyFields()._list_rows(frame)}  # pyright: ignore[reportPrivateUsage]


def test_the_frame_moves_the_key_and_it_stays_selected(frame: Any) -> None:
    assert [key.frame for key in apply(frame, "frame", 13.0)] == [1, 13, 20]
    assert frame.state.single == (GAIN, 13.0) and frame.session.history.steps[-1] == "Set frame of a key"
    assert rows(frame)["frame"] == (13.0,)


def test_the_value_is_set_channel_by_channel(frame: Any) -> None:
    assert [key.value for key in apply(frame, "value", 3.5)] == [0.2, 3.5, 4.0]
    assert frame.state.single == (GAIN, 10.0)
    frame.state.spots = frozenset({(TINT, 10.0, 1)})
    apply(frame, "value", 0.5, 0.25, 0.125, 1.0)
    assert [key.value for key in frame.session.graph.animation[TINT].keys] == [RED, (0.5, 0.25, 0.125, 1.0)]
    assert rows(frame) == {"frame": (10.0,), "value": (0.5, 0.25, 0.125, 1.0)}, "handles are those of single curves"


@pytest.mark.parametrize(
    ("name", "typed", "handle"),
    [("left", (-3.0, 0.5), (-3.0, 0.5)), ("left", (3.0, 0.5), (0.0, 0.5)), ("right", (4.0, -1.0), (4.0, -1.0)),
     ("right", (-4.0, -1.0), (0.0, -1.0))],
)  # fmt: skip
def test_handles_point_to_their_side(
    frame: Any, name: str, typed: tuple[float, float], handle: tuple[float, float]
) -> None:
    apply(frame, name, *typed)
    assert rows(frame)[name] == pytest.approx(handle)
    assert frame.state.free == {(GAIN, 10.0)} and frame.session.history.steps[-1] == f"Set {name} of a key"


def test_the_sheet_has_no_handles_and_ends_have_one(frame: Any) -> None:
    assert {*rows(frame)} == {"frame", "value", "left", "right"}
    frame.is_sheet = True
    assert {*rows(frame)} == {"frame", "value"}
    frame.is_sheet, frame.state.spots = False, frozenset({(GAIN, 1.0, 0)})
    assert {*rows(frame)} == {"frame", "value", "right"}
    frame.state.spots = frozenset({(GAIN, 1.0, 0), (GAIN, 10.0, 0)})
    assert rows(frame) == {}, "two keys have no fields"
    steps = len(frame.session.history.steps)
    apply(frame, "frame", 3.0)
    assert len(frame.session.history.steps) == steps
