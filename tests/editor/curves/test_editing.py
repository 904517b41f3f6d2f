"""What gestures make of keys."""

from __future__ import annotations

import json

import pytest
from halation.editor.curves import editing
from halation.editor.curves.copying import decode_keys, encode_keys, paste_keys
from halation.editor.curves.gestures import HandleDrag, KeyMove, KeyScale
from halation.editor.curves.rows import find_limits, list_spots, make_rows
from halation.editor.curves.state import CurvesState
from halation.errors import UsageError
from halation.graph import Expression, Graph, Key, Keys, Port
from toy_nodes import Gain, Soften

GAIN, TINT, STEPS, CLAMP = (Port("gain", name) for name in ("gain", "tint", "steps", "clamp"))
SIGMA = Port("soften", "sigma")


def graph() -> Graph:
    made = Graph().add("gain", Gain()).add("soften", Soften())
    made = made.animate(GAIN, Keys((Key(1, 0.0), Key(10, 2.0), Key(20, 4.0))))
    made = made.animate(TINT, Keys((Key(1, (1.0, 0.0, 0.0, 1.0)), Key(10, (0.0, 1.0, 0.0, 1.0)))))
    made = made.animate(CLAMP, Keys((Key(5, True),)))
    return made.animate(SIGMA, Expression("frame * 0.5"))


def at(port: Port, *frames: float, channel: int = 0) -> frozenset:
    return frozenset((port, float(frame), channel) for frame in frames)


def test_rows_are_grouped_by_node_and_selected_ones_come_first() -> None:
    found = make_rows(graph(), {"soften"})
    assert [(row.node, row.label) for row in found] == [
        ("soften", "soften"),
        ("soften", "sigma"),
        ("gain", "gain"),
        ("gain", "gain"),
        ("gain", "clamp"),
        ("gain", "tint"),
    ]
    assert [row.channels for row in found][-1] == "rgba"
    assert found[1].keys is None and found[2].ports == (GAIN, CLAMP, TINT)
    assert [row.node for row in make_rows(graph(), {"soften"}, only=True)] == ["soften", "soften"]
    assert len(make_rows(graph(), folded={"gain"})) == 3
    assert list_spots(TINT, graph().animation[TINT], (1.0,)) == {(TINT, 1.0, channel) for channel in range(4)}
    assert find_limits(graph(), GAIN) == (0.0, 16.0)


def test_what_is_gone_is_no_longer_chosen() -> None:
    state, made = CurvesState(), graph()
    state.choose(at(GAIN, 1, 10, 99) | at(SIGMA, 1))
    state.chosen_rows, state.hidden = frozenset({GAIN, STEPS}), {(STEPS, 0)}
    state.tidy(made)
    assert state.spots == at(GAIN, 1, 10) and state.chosen_rows == {GAIN} and not state.hidden
    assert state.single is None
    state.choose(at(GAIN, 10), "remove")
    assert state.single == (GAIN, 1.0)
    state.choose(at(GAIN, 1, 20), "toggle")
    assert state.spots == at(GAIN, 1, 20)
    state.choose(at(GAIN, 20), "toggle")
    assert state.spots == at(GAIN, 1)
    first = state.list_rows(made, frozenset())
    assert state.list_rows(made, frozenset()) is first and state.list_rows(made, frozenset({"soften"})) is not first


def test_keys_move_together_and_come_back_from_where_they_pushed() -> None:
    animation = graph().animation
    drag = KeyMove(animation, at(GAIN, 1, 10) | at(TINT, 1), 1.0, (1.3, 0.0), "m")
    far = drag.change((11.2, 0.0), True, editing.allow_any_number)
    assert far.new_keys[GAIN].frames == (11.0, 20.0) and far.new_keys[GAIN].evaluate(20) == 2.0
    assert far.new_keys[TINT].frames == (10.0, 11.0)
    assert far.spots == at(GAIN, 11, 20) | at(TINT, 11)
    near = drag.change((2.31, 0.0), True, editing.allow_any_number)
    assert near.new_keys[GAIN].frames == (2.0, 11.0, 20.0)
    assert drag.change((2.31, 0.0), False, editing.allow_any_number).new_keys[GAIN].frames == (2.01, 11.01, 20.0)
    still = drag.change((9.0, 1.0), True, editing.allow_any_number, across=False)
    assert still.new_keys[GAIN].frames == (1.0, 10.0, 20.0) and still.new_keys[GAIN].evaluate(1) == 1.0
    assert still.new_keys[TINT].evaluate(1)[0] == 2.0 and still.new_keys[TINT].evaluate(1)[1] == 0.0


def test_a_lifted_key_stays_within_its_limits_and_type() -> None:
    animation = graph().animate(STEPS, Keys((Key(1, 3), Key(9, 6)))).animation
    made = editing.move_keys(
        animation, at(GAIN, 20) | at(STEPS, 1) | at(CLAMP, 5), 0.0, 40.0, lambda p: find_limits(graph(), p)
    )
    assert made.new_keys[GAIN].evaluate(20) == 16.0
    assert made.new_keys[STEPS].key(1).value == 43 and isinstance(made.new_keys[STEPS].key(1).value, int)
    down = editing.move_keys(animation, at(CLAMP, 5), 0.0, -0.8)
    assert down.new_keys[CLAMP].key(5).value is False


def test_a_frame_at_an_odd_place_lands_on_whole_ones() -> None:
    animation = {GAIN: Keys((Key(2.5, 0.0), Key(7.0, 1.0)))}
    drag = KeyMove(animation, at(GAIN, 2.5), 2.5, (2.5, 0.0), "m")
    assert drag.change((3.1, 0.0), True, editing.allow_any_number).new_keys[GAIN].frames == (3.0, 7.0)


def test_the_ends_of_the_bar_draw_keys_out() -> None:
    animation = graph().animation
    drag = KeyScale(animation, at(GAIN, 1, 10, 20), 1.0, 20.0, 20.4, "s")
    assert drag.change(39.4, True).new_keys[GAIN].frames == (1.0, 19.0, 39.0)
    assert drag.change(39.4, True).spots == at(GAIN, 1, 19, 39)
    assert drag.change(-50.0, False).new_keys[GAIN].frames[0] == 1.0
    loose = drag.change(21.4, False)
    assert loose.new_keys[GAIN].frames == tuple(sorted(frame for _, frame, _ in loose.spots))


def test_handles_turn_together_or_alone() -> None:
    keys = Keys(tuple(Key(frame, value, "bezier") for frame, value in ((0, 0.0), (9, 1.0), (18, 0.0), (30, 1.0))))
    drag = HandleDrag(keys, GAIN, 9.0, 0, "right", 1.0, (0.5, 0.25), True, "b")
    made = drag.change((9.0 + 0.5 + 4.0, 1.0 + 0.25 + 2.0), True)
    assert made.key(9).right == (4.0, 2.0)
    assert made.key(9).left == pytest.approx((-3.0, -1.5)) and editing.has_aligned_handles(made, 9.0)
    assert made.evaluate(0) == 0.0 and made.evaluate(12) > 1.0
    alone = drag.change((13.5, 3.25), False)
    assert alone.key(9).left == () and not editing.has_aligned_handles(alone, 9.0)
    assert drag.change((13.5, 3.25), True, flat=True).key(9).right == (4.0, 0.0)
    behind = drag.change((0.0, 2.25), True)
    assert behind.key(9).right == (0.0, 1.0) and behind.key(9).left == (0.0, -1.0)


def test_a_handle_of_one_channel_keeps_the_slopes_of_the_others() -> None:
    keys = Keys((Key(0, (0.0, 0.0), "bezier", right=(3.0, 1.0, 6.0)), Key(9, (1.0, 1.0))))
    made = editing.pull_handle(keys, 0.0, 0, "right", (4.5, 5.0), False)
    assert made.key(0).right == (4.5, 5.0, 9.0)


def test_a_curve_that_gets_handles_keeps_its_shape() -> None:
    keys = Keys((Key(0, 0.0), Key(6, 3.0), Key(12, 4.0, "linear"), Key(20, 0.0)))
    for place in (0, 1, 2):
        made = editing.convert_to_bezier(keys, place)
        assert made.keys[place].interpolation == "bezier"
        for frame in range(21):
            assert made.evaluate(frame) == pytest.approx(keys.evaluate(frame), abs=1e-9)
    held = editing.convert_to_bezier(Keys((Key(0, 1.0, "constant"), Key(8, 3.0))), 0)
    assert held.evaluate(4) == pytest.approx(2.0)


def test_easing_lays_handles_flat() -> None:
    animation = {GAIN: Keys((Key(0, 0.0, "linear"), Key(10, 1.0, "linear"), Key(20, 2.0, "linear")))}
    made = editing.ease_keys(animation, at(GAIN, 10), "both")[GAIN]
    assert made.key(10).left[1] == made.key(10).right[1] == 0.0
    slope = (made.evaluate(10.01) - made.evaluate(9.99)) / 0.02
    assert abs(slope) < 0.01
    begin = (made.evaluate(0.01) - made.evaluate(0.0)) / 0.01
    assert begin == pytest.approx(0.1, rel=0.05)
    into = editing.ease_keys(animation, at(GAIN, 10), "in")[GAIN]
    assert into.evaluate(15) == 1.5 and into.evaluate(8) > 0.8
    assert editing.ease_keys(animation, at(GAIN, 0), "in")[GAIN] == animation[GAIN]


def test_kinds_of_handles() -> None:
    animation = {
        GAIN: Keys(
            (
                Key(0, 0.0, "bezier"),
                Key(10, 1.0, "bezier", left=(-2.0, 0.0), right=(4.0, 4.0)),
                Key(20, 2.0, "bezier"),
            )
        )
    }
    straight = editing.align_handles(animation, at(GAIN, 10))[GAIN]
    assert editing.has_aligned_handles(straight, 10.0) and straight.key(10).left[0] == -2.0
    assert editing.reset_handles(animation, at(GAIN, 10))[GAIN].key(10).left == ()
    put = editing.fix_handles(animation, at(GAIN, 0))[GAIN]
    assert len(put.key(0).right) == 2 and put.evaluate(4) == pytest.approx(animation[GAIN].evaluate(4))
    assert editing.extrapolate_keys(animation, (GAIN, TINT), "loop")[GAIN].outside == "loop"
    assert editing.interpolate_keys({CLAMP: Keys((Key(1, True),))}, at(CLAMP, 1), "linear") == {}
    assert editing.remove_keys(animation, at(GAIN, 0, 10, 20))[GAIN].keys == ()


def test_keys_pass_the_clipboard() -> None:
    made = graph()
    text = encode_keys(made.animation, at(GAIN, 10, 20) | at(TINT, 10))
    assert json.loads(text)["halation keys"]["gain.gain"][0]["frame"] == 0.0
    change = paste_keys(made, decode_keys(text), 31.0)
    assert change.new_keys[GAIN].frames == (1.0, 10.0, 20.0, 31.0, 41.0)
    assert change.new_keys[TINT].evaluate(31) == (0.0, 1.0, 0.0, 1.0)
    assert change.spots >= at(GAIN, 31, 41) | at(TINT, 31, channel=3)
    other = paste_keys(made, decode_keys(encode_keys(made.animation, at(GAIN, 10))), 3.0, (STEPS,))
    assert list(other.new_keys) == [STEPS]
    for bad in ("", "{}", '{"halation keys": {"a.b": [{"frame": 1}]}}', '{"halation keys": 3}'):
        with pytest.raises(UsageError, match="no keys"):
            decode_keys(bad)
    with pytest.raises(UsageError, match="no keys are selected"):
        encode_keys(made.animation, ())
    with pytest.raises(UsageError, match="not in this graph"):
        paste_keys(Graph(), decode_keys(text), 1.0)
