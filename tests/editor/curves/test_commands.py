"""Commands of the Animation panel: what becomes of keys, what is chosen then, and how the step of undo is named."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.authoring.commands import AnimateValues, ReplaceGraph
from halation.authoring.session import Session
from halation.editor.curves import commands
from halation.editor.curves.shapes import ExpressionSamples
from halation.editor.curves.state import CurvesState
from halation.errors import GraphError, UsageError
from halation.graph import Expression, Graph, Key, Keys, Port
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain, Soften

GAIN, TINT, STEPS, SIGMA = Port("gain", "gain"), Port("gain", "tint"), Port("gain", "steps"), Port("soften", "sigma")
RED, GREEN = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0)


@pytest.fixture
def context() -> Any:
    graph = Graph().add("gain", Gain()).add("soften", Soften())
    graph = graph.animate(GAIN, Keys((Key(1, 0.0), Key(10, 2.0), Key(20, 4.0))))
    graph = graph.animate(TINT, Keys((Key(1, RED), Key(10, GREEN)))).animate(SIGMA, Expression("frame * 0.5"))
    session = Session(TOYS, sandbox=UNRESTRICTED)
    session.apply(ReplaceGraph("Start", graph))
    board = SimpleNamespace(text="")
    board.put, board.get = (lambda text: setattr(board, "text", text)), (lambda: board.text)
    return SimpleNamespace(session=session, curves=CurvesState(), clipboard=board)


def frames(context: Any, port: Port = GAIN) -> list[float]:
    animation = context.session.graph.animation.get(port)
    return [key.frame for key in animation.keys] if animation else []


def values(context: Any, port: Port = GAIN) -> list[Any]:
    return [key.value for key in context.session.graph.animation[port].keys]


def choose(context: Any, port: Port, *at: float, channels: int = 1) -> None:
    context.curves.choose(frozenset((port, float(frame), channel) for frame in at for channel in range(channels)))


def chosen(context: Any) -> set[tuple[Port, float]]:
    return {(port, frame) for port, frame, _ in context.curves.spots}


def name_step(context: Any) -> str:
    return context.session.history.steps[-1]


def test_keys_are_deleted_and_cut(context: Any) -> None:
    choose(context, GAIN, 10)
    commands.delete(context)
    assert frames(context) == [1, 20] and name_step(context) == "Delete a key"
    choose(context, GAIN, 1, 20)
    commands.cut(context)
    assert not frames(context) and name_step(context) == "Cut 2 keys"
    context.session.time.seek(5)
    commands.paste(context)
    assert frames(context) == [5, 24] and values(context) == [0.0, 4.0] and name_step(context) == "Paste 2 keys"
    assert chosen(context) == {(GAIN, 5.0), (GAIN, 24.0)}


def test_copies_go_into_the_chosen_row(context: Any) -> None:
    choose(context, GAIN, 10, 20)
    commands.copy(context)
    assert frames(context) == [1, 10, 20]
    context.curves.chosen_rows = frozenset({STEPS})
    context.session.time.seek(3)
    with pytest.raises(GraphError, match=r"gain\.steps at frame 3: 2\.0 does not fit"):
        commands.paste(context)
    context.session.apply(AnimateValues({SIGMA: None}, "No expression"))
    context.curves.chosen_rows = frozenset({SIGMA})
    commands.paste(context)
    assert frames(context) == [1, 10, 20] and frames(context, SIGMA) == [3, 13] and values(context, SIGMA) == [2.0, 4.0]
    context.clipboard.put("nothing")
    with pytest.raises(UsageError, match="holds no keys"):
        commands.paste(context)


def test_duplicates_follow_the_last_of_them(context: Any) -> None:
    choose(context, GAIN, 1, 10)
    commands.duplicate(context)
    assert frames(context) == [1, 10, 11, 20] and values(context)[:3] == [0.0, 2.0, 0.0]
    assert chosen(context) == {(GAIN, 11.0), (GAIN, 20.0)} and name_step(context) == "Duplicate 2 keys"
    commands.choose_none(context)
    with pytest.raises(UsageError, match="select what to duplicate"):
        commands.duplicate(context)


@pytest.mark.parametrize("command", [commands.delete, commands.cut, commands.make_free, commands.ease("in")])
def test_nothing_chosen_is_said(context: Any, command: Any) -> None:
    with pytest.raises(UsageError, match="no keys are selected"):
        command(context)
    assert not commands.has_chosen_keys(context)


def test_nudges_are_one_step(context: Any) -> None:
    choose(context, GAIN, 10)
    steps = len(context.session.history.steps)
    for _ in range(3):
        commands.nudge(2.0)(context)
    commands.nudge(-1.0)(context)
    assert frames(context) == [1, 15, 20] and chosen(context) == {(GAIN, 15.0)}
    assert len(context.session.history.steps) == steps + 1 and name_step(context) == "Move a key"


def test_all_keys_or_those_here_are_chosen(context: Any) -> None:
    commands.choose_all(context)
    assert chosen(context) == {(GAIN, 1), (GAIN, 10), (GAIN, 20), (TINT, 1), (TINT, 10)}
    assert commands.describe_keys(context.curves.spots) == "5 keys"
    context.session.time.seek(10)
    commands.choose_none(context)
    commands.choose_here(context)
    assert chosen(context) == {(GAIN, 10), (TINT, 10)}
    commands.swap_mode(context)
    context.curves.hidden = {(TINT, 1)}
    commands.choose_all(context)
    assert {channel for port, _, channel in context.curves.spots if port == TINT} == {0, 2, 3}
    context.curves.chosen_rows = frozenset({TINT})
    commands.choose_all(context)
    assert chosen(context) == {(TINT, 1), (TINT, 10)}, "curves of chosen rows alone are drawn"
    commands.swap_mode(context)
    commands.choose_all(context)
    assert {channel for port, _, channel in context.curves.spots if port == TINT} == {0, 1, 2, 3}
    assert {port for port, _ in chosen(context)} == {GAIN, TINT}, "the sheet shows all rows"


@pytest.mark.parametrize("how", ["constant", "linear", "bezier"])
def test_interpolation_is_that_of_the_chosen_keys(context: Any, how: Any) -> None:
    choose(context, GAIN, 10)
    commands.interpolate(how)(context)
    assert [key.interpolation for key in context.session.graph.animation[GAIN].keys] == ["smooth", how, "smooth"]
    assert name_step(context) == f"Make {how}: a key"


@pytest.mark.parametrize(
    ("how", "name"), [("in", "Ease into a key"), ("out", "Ease out of a key"), ("both", "Ease a key")]
)
def test_easing_has_a_name(context: Any, how: Any, name: str) -> None:
    choose(context, GAIN, 10)
    commands.ease(how)(context)
    assert name_step(context) == name


def test_handles_are_free_until_they_are_aligned(context: Any) -> None:
    choose(context, GAIN, 10)
    for command, free, name in (
        (commands.make_free, {(GAIN, 10.0)}, "Free handles of a key"),
        (commands.make_aligned, set(), "Align handles of a key"),
        (commands.make_free, {(GAIN, 10.0)}, "Free handles of a key"),
        (commands.make_automatic, set(), "Automatic handles of a key"),
    ):
        command(context)
        assert context.curves.free == free and name_step(context) == name


def test_extrapolation_is_that_of_chosen_keys_or_rows(context: Any) -> None:
    with pytest.raises(UsageError, match="select a key or a row first"):
        commands.extrapolate("linear")(context)
    assert not commands.extrapolates(context, "hold")
    context.curves.chosen_rows = frozenset({TINT})
    commands.extrapolate("linear")(context)
    assert commands.extrapolates(context, "linear") and not commands.extrapolates(context, "hold")
    choose(context, GAIN, 1)
    assert commands.extrapolates(context, "hold") and not commands.extrapolates(context, "linear")
    context.curves.spots |= {(TINT, 1.0, 0)}
    assert not commands.extrapolates(context, "hold") and not commands.extrapolates(context, "linear")
    context.curves.choose(frozenset())
    context.curves.chosen_rows = frozenset({SIGMA})
    assert not commands.extrapolates(context, "hold")


def test_keys_are_inserted_on_the_curve(context: Any) -> None:
    commands.insert(context, GAIN, 15.00000049)
    assert frames(context) == [1, 10, 15, 20] and chosen(context) == {(GAIN, 15.0)}
    assert name_step(context) == "Key gain.gain"
    steps = len(context.session.history.steps)
    commands.insert(context, SIGMA, 3.0)
    assert len(context.session.history.steps) == steps
    context.session.time.seek(4)
    commands.key_here(context)
    assert frames(context)[:2] == [1, 4] and frames(context, TINT) == [1, 4, 10]
    assert chosen(context) == {(GAIN, 4), (TINT, 4)} and name_step(context) == "Key at frame 4"


def test_values_without_animation_are_offered(context: Any) -> None:
    assert commands.list_animatable(context) == ()
    context.session.select(["gain"])
    offered = commands.list_animatable(context)
    assert STEPS in offered and not {GAIN, TINT, SIGMA} & {*offered}
    assert commands.bounds(context)(GAIN) == (0.0, 16.0)


def test_the_view_holds_what_is_fitted(context: Any) -> None:
    samples = ExpressionSamples()
    view = commands.fit_view(context, samples)
    last = max(20, context.session.time.frames[1])
    assert view.first < min(1, context.session.time.frames[0]) and last < view.last < 1.5 * last
    assert view.low < 0.0 and view.high > 0.5 * last > view.high / 2.0  # sigma is half the frame
    context.curves.chosen_rows = frozenset({GAIN})
    assert 4.0 < commands.fit_view(context, samples).high < 8.0
    context.curves.chosen_rows = frozenset()
    choose(context, TINT, 1, 10, channels=4)
    context.curves.pending_fit = "chosen"
    near = commands.fit_view(context, samples)
    assert -2.0 < near.first < 1.0 and 10.0 < near.last < 14.0 and -1.0 < near.low < 0.0 and 1.0 < near.high < 2.0
    choose(context, TINT, 10)
    alone = commands.fit_view(context, samples)  # red is 0 there
    assert alone.first < 10.0 < alone.last < 14.0 and alone.low < 0.0 < alone.high < 1.0
