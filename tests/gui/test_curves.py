"""Keys and curves in the real window, by mouse and keyboard."""

from __future__ import annotations

import pytest
from halation.authoring.commands import ReplaceGraph, SetFrameRange, SetValue
from halation.authoring.edits.element_id import ElementId
from halation.graph import Expression, Graph, Key, Keys, Port
from toy_nodes import Gain, Soften

GAIN, TINT, SIGMA = Port("one", "gain"), Port("one", "tint"), Port("two", "sigma")


def start(ui, mode: str = "sheet") -> int:
    """A graph with keys, seen in the panel; how many steps the history has."""
    graph = Graph().add("one", Gain()).add("two", Soften())
    graph = graph.animate(GAIN, Keys((Key(1, 0.5), Key(11, 2.0), Key(21, 1.0))))
    graph = graph.animate(TINT, Keys((Key(1, (1.0, 0.0, 0.5, 1.0)), Key(11, (0.0, 1.0, 0.5, 1.0)))))
    graph = graph.animate(SIGMA, Expression("4 + sin(frame)"))
    ui.session.apply(ReplaceGraph("Add", graph))
    ui.session.apply(SetFrameRange(1, 24))
    ui.editor.dialogs.open.clear()
    ui.editor.curves.mode = mode
    ui.ctx.window_focus("//Animation")
    ui.wait(4)
    ui.editor.curves.fit()
    ui.wait(4)
    return len(ui.session.history.steps)


def frames(ui, port: Port = GAIN) -> tuple[float, ...]:
    return ui.session.graph.animation[port].frames


def per_frame(ui) -> float:
    """Pixels."""
    left, _, right, _ = ui.editor.places["keys area"]
    return (right - left) / (ui.editor.curves.view.last - ui.editor.curves.view.first)


def per_unit(ui) -> float:
    _, top, _, bottom = ui.editor.places["keys area"]
    return (bottom - top) / (ui.editor.curves.view.high - ui.editor.curves.view.low)


def beside(ui, place: str, frames: float = 0.0, up: float = 0.0) -> tuple[float, float]:
    """A point so many frames later, and so much higher, than a key."""
    x, y = ui.at(place)
    return x + frames * per_frame(ui), y - up * (per_unit(ui) if up else 0.0)


def test_a_key_is_dragged_in_the_sheet(gui) -> None:
    def body(ui) -> None:
        steps = start(ui)
        ui.drag("key one.gain 11", beside(ui, "key one.gain 11", 4.3))
        assert frames(ui) == (1.0, 15.0, 21.0) and len(ui.session.history.steps) == steps + 1
        assert ui.editor.curves.spots == {(GAIN, 15.0, 0)}
        ui.keys("Ctrl+Z")
        assert frames(ui) == (1.0, 11.0, 21.0)
        ui.drag("key one.gain 11", beside(ui, "key one.gain 11", 4.3), keys="Shift")
        assert frames(ui)[1] == pytest.approx(15.3, abs=0.1)
        ui.keys("Ctrl+Z")

        ui.drag("key one.gain 11", beside(ui, "key one.gain 11", 10.0), release=False)
        assert frames(ui) == (1.0, 21.0)
        ui.ctx.mouse_move_to_pos((ui.at("keys area")[0], ui.at("key one.gain 1")[1]))
        ui.wait(2)
        assert len(frames(ui)) == 3
        ui.keys("Escape")
        ui.ctx.mouse_up(0)
        ui.wait(2)
        assert frames(ui) == (1.0, 11.0, 21.0) and len(ui.session.history.steps) == steps

    gui(body)


def test_a_box_chooses_and_its_keys_move_together(gui) -> None:
    def body(ui) -> None:
        steps = start(ui)
        row = ui.editor.places["keys row one.tint"]
        ui.drag((ui.at("key one.gain 11")[0] + 25, row[1] - 28), (ui.at("key one.gain 1")[0] + 40, row[3] - 1))
        assert {spot[:2] for spot in ui.editor.curves.spots} == {(GAIN, 11.0), (TINT, 11.0)}
        ui.click("key one.gain 1", keys="Shift")
        assert len(ui.editor.curves.spots) == 6
        ui.drag("key one.tint 11", beside(ui, "key one.tint 11", 3.0))
        assert frames(ui) == (4.0, 14.0, 21.0) and frames(ui, TINT) == (1.0, 14.0)
        assert len(ui.session.history.steps) == steps + 1

        ui.drag("keys right end", beside(ui, "keys right end", 10.0))
        assert frames(ui) == (4.0, 21.0, 24.0)[:1] + tuple(sorted({21.0, 24.0})) and frames(ui, TINT) == (1.0, 24.0)
        assert len(ui.session.history.steps) == steps + 2
        ui.keys("Ctrl+Z")
        ui.keys("Ctrl+Z")
        assert frames(ui) == (1.0, 11.0, 21.0) and frames(ui, TINT) == (1.0, 11.0)
        ui.click("key one.gain 1", keys="Ctrl")
        ui.click("keys area", fraction=(0.5, 0.95))
        assert not ui.editor.curves.spots

    gui(body)


def test_interpolation_by_button_key_and_menu(gui) -> None:
    def body(ui) -> None:
        steps = start(ui)
        ui.click("key one.gain 11")
        ui.click("button keys.linear")
        assert [key.interpolation for key in ui.session.graph.animation[GAIN].keys] == ["smooth", "linear", "smooth"]
        ui.move("key one.gain 11")
        ui.keys("C")
        assert ui.session.graph.animation[GAIN].key(11).interpolation == "constant"
        ui.click("key one.gain 1", button=1)
        ui.ctx.item_click("//$FOCUSED/keys interpolation")
        ui.click("menu keys.bezier")
        assert ui.session.graph.animation[GAIN].key(1).interpolation == "bezier"
        assert len(ui.session.history.steps) == steps + 3
        ui.keys("E")
        assert ui.session.graph.animation[GAIN].key(1).right[1] == 0.0

    gui(body)


def test_keys_are_copied_duplicated_and_deleted(gui) -> None:
    def body(ui) -> None:
        start(ui)
        ui.click("key one.gain 1")
        ui.click("key one.gain 11", keys="Ctrl")
        ui.keys("Ctrl+C")
        ui.session.time.seek(30)
        ui.keys("Ctrl+V")
        assert frames(ui) == (1.0, 11.0, 21.0, 30.0, 40.0)
        ui.keys("Delete")
        assert frames(ui) == (1.0, 11.0, 21.0)
        ui.click("key one.gain 11")
        ui.keys("Ctrl+D")
        assert frames(ui) == (1.0, 11.0, 12.0, 21.0)
        ui.session.time.seek(1)
        ui.keys("Ctrl+A")
        ui.keys("Delete")
        assert list(ui.session.graph.animation) == [SIGMA] and ui.session.graph.value(GAIN) == 0.5
        ui.keys("Ctrl+Z")
        assert frames(ui) == (1.0, 11.0, 12.0, 21.0)
        ui.click("keys diamond one.gain")
        assert frames(ui) == (11.0, 12.0, 21.0)

    gui(body)


def test_a_key_is_dragged_in_both_axes(gui) -> None:
    def body(ui) -> None:
        steps = start(ui, "curves")
        ui.click("keys row one.gain", fraction=(0.3, 0.5))
        assert "key one.tint 1 0" not in ui.editor.places
        ui.drag("key one.gain 11 0", beside(ui, "key one.gain 11 0", 3.2, -0.5))
        assert frames(ui) == (1.0, 14.0, 21.0)
        assert ui.session.graph.animation[GAIN].evaluate(14) == pytest.approx(1.5, abs=2.0 / per_unit(ui))
        assert len(ui.session.history.steps) == steps + 1
        before = ui.session.graph.animation[GAIN]
        ui.drag("key one.gain 14 0", beside(ui, "key one.gain 14 0", 3.0, 0.3), keys="Shift")
        assert frames(ui) == (1.0, 17.0, 21.0) and ui.session.graph.animation[GAIN].evaluate(17) == before.evaluate(14)
        ui.drag("key one.gain 17 0", beside(ui, "key one.gain 17 0", 3.0, 0.3), keys="Ctrl")
        assert (
            frames(ui) == (1.0, 17.0, 21.0)
            and ui.session.graph.animation[GAIN].evaluate(17) > before.evaluate(14) + 0.2
        )
        assert ui.editor.curves.spots == {(GAIN, 17.0, 0)}

        ui.click("field keys frame")
        ui.type("13")
        ui.click("field keys value")
        ui.type("0.75")
        assert ui.session.graph.animation[GAIN].key(13).value == 0.75
        ui.keys("Ctrl+Z")
        ui.keys("Ctrl+Z")
        assert frames(ui) == (1.0, 17.0, 21.0)

    gui(body)


def test_a_handle_bends_the_curve_as_the_cubic_says(gui) -> None:
    def body(ui) -> None:
        steps = start(ui, "curves")
        ui.click("keys row one.gain", fraction=(0.3, 0.5))
        ui.click("key one.gain 1 0")
        ui.keys("B")
        left, right = ui.session.graph.animation[GAIN].handles(1.0)
        assert left == () and right == pytest.approx((10 / 3, 0.0))
        handle = "handle one.gain 1 0 right"
        ui.drag(handle, beside(ui, handle, 2.0, 0.6))
        assert len(ui.session.history.steps) == steps + 2
        keys = ui.session.graph.animation[GAIN]
        across, up = keys.key(1).right
        assert (across, up) == (pytest.approx(10 / 3 + 2.0, abs=0.1), pytest.approx(0.6, abs=3.0 / per_unit(ui)))
        back = keys.handles(11.0)[0]
        for t in (0.1, 0.35, 0.6, 0.9):
            weights = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
            frame = sum(w * at for w, at in zip(weights, (1.0, 1.0 + across, 11.0 + back[0], 11.0), strict=True))
            value = sum(w * at for w, at in zip(weights, (0.5, 0.5 + up, 2.0 + back[1], 2.0), strict=True))
            assert keys.evaluate(frame) == pytest.approx(value, abs=1e-9)
        ui.keys("Ctrl+Z")
        assert ui.session.graph.animation[GAIN].key(1).right == ()

    gui(body)


def test_the_mouse_moves_the_view_and_the_frame(gui) -> None:
    def body(ui) -> None:
        steps = start(ui, "curves")
        state = ui.editor.curves
        ui.drag("keys ruler", beside(ui, "key one.gain 11 0", 0.2))
        assert ui.session.time.frame == 11
        x, y = ui.at("keys now")
        ui.drag((x, y), (x + 5 * per_frame(ui), y))
        assert ui.session.time.frame == 16 and len(ui.session.history.steps) == steps
        ui.move("keys area", (0.25, 0.5))
        before = state.view
        with ui.held("Ctrl"):
            ui.wheel(3)
        assert (state.view.low, state.view.high) == (before.low, before.high)
        assert state.view.last - state.view.first < before.last - before.first
        with ui.held("Shift"):
            ui.wheel(3)
        assert state.view.high - state.view.low < before.high - before.low
        ui.keys("A")
        assert state.view == before
        ui.drag("keys area", (ui.at("keys area")[0] + 100.0, ui.at("keys area")[1] + 50.0), button=2)
        assert state.view.first == pytest.approx(before.first - 100.0 / per_frame(ui), abs=0.3)
        assert state.view.low > before.low
        ui.click("key one.gain 11 0")
        ui.keys("F")
        assert state.view.first == 10.0 and state.view.last == 12.0
        ui.keys("Tab")
        assert state.mode == "sheet" and state.view.first == 10.0
        ui.click("keys row one", fraction=(0.05, 0.5))
        assert "keys row one.gain" not in ui.editor.places and state.folded == {"one"}

    gui(body)


def test_a_double_click_puts_a_key_on_the_curve(gui) -> None:
    def body(ui) -> None:
        start(ui, "curves")
        ui.click("keys row one.gain", fraction=(0.3, 0.5))
        keys = ui.session.graph.animation[GAIN]
        ui.move((3.0, 3.0))
        x = ui.at("key one.gain 1 0")[0] + 5 * per_frame(ui)
        y = ui.at("key one.gain 1 0")[1] - (keys.evaluate(6) - 0.5) * per_unit(ui)
        ui.double_click((x, y))
        assert frames(ui) == (1.0, 6.0, 11.0, 21.0)
        assert ui.session.graph.animation[GAIN].evaluate(6) == pytest.approx(keys.evaluate(6))
        ui.click("keys channel one.tint b")
        assert ui.editor.curves.hidden == {(TINT, 2)}

    gui(body)


def test_an_empty_graph_is_asked_for_a_first_key(gui) -> None:
    def body(ui) -> None:
        ui.session.apply(ReplaceGraph("Add", Graph().add("one", Gain())))
        ui.editor.dialogs.open.clear()
        ui.ctx.window_focus("//Animation")
        ui.session.select([ElementId("one")])
        ui.wait(4)
        ui.click("button keys add")
        ui.ctx.item_click("//$FOCUSED/one.gain")
        ui.wait(3)
        assert frames(ui) == (1.0,)
        ui.session.time.seek(10)
        ui.session.apply(SetValue(GAIN, 3.0))
        ui.wait(3)
        assert "key one.gain 10" in ui.editor.places

    gui(body)


@pytest.mark.parametrize("mode", ["sheet", "curves"])
def test_many_curves_are_drawn_and_moved(gui, mode: str) -> None:
    def body(ui) -> None:
        graph = Graph()
        for place in range(50):
            keys = tuple(Key(1 + 5 * at, (at * 7 + place) % 5 / 2.0, ("smooth", "bezier")[at % 2]) for at in range(20))
            graph = graph.add(f"n{place}", Gain()).animate(Port(f"n{place}", "gain"), Keys(keys))
        ui.session.apply(ReplaceGraph("Add", graph))
        ui.editor.dialogs.open.clear()
        ui.editor.curves.mode = mode
        ui.ctx.window_focus("//Animation")
        for _ in range(10):
            ui.editor.curves.view = ui.editor.curves.view.pan(0.3, 0.0)
            ui.wait(1)
        assert not ui.editor.faults

    gui(body)
