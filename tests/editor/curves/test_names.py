"""The column of names: what a click at each place does, and what is drawn there."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from drawn_shapes import DrawnShapes
from halation.authoring.commands import ReplaceGraph
from halation.authoring.session import Session
from halation.editor.curves import frame as frames
from halation.editor.curves import names
from halation.editor.curves.names import NameColumn
from halation.editor.curves.state import CurvesState
from halation.editor.theme.palette import DARK
from halation.editor.theme.style import u32
from halation.graph import Expression, Graph, Key, Keys, Port
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain, Soften

GAIN, TINT, CENTER, CLAMP, STEPS = (Port("gain", name) for name in ("gain", "tint", "center", "clamp", "steps"))
SIGMA = Port("soften", "sigma")
LEFT, TOP, RIGHT = 100.0, 50.0, 300.0


class Column:
    """The names of animated values, 200 pixels wide; letters are half as wide as text is high."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, scale: float = 1.0) -> None:
        graph = Graph().add("gain", Gain()).add("soften", Soften()).animate(SIGMA, Expression("frame * 0.5"))
        values: dict[Port, Any] = {GAIN: 0.25, TINT: (1.0, 0.5, 0.0, 1.0), CENTER: (0.5, 0.25), CLAMP: True, STEPS: 3}
        for port, value in values.items():
            graph = graph.animate(port, Keys((Key(1, value), Key(9, value))))
        session = Session(TOYS, sandbox=UNRESTRICTED)
        session.apply(ReplaceGraph("Start", graph))
        self.shapes, self.state, self.session = DrawnShapes(16.0), CurvesState(mode="curves"), session
        self.io, self.is_double = SimpleNamespace(key_ctrl=False, key_shift=False), False
        imgui = SimpleNamespace(
            get_io=lambda: self.io, is_mouse_double_clicked=lambda button: self.is_double, get_font=lambda: None,
            MouseButton_=SimpleNamespace(left=0), get_window_draw_list=lambda: self.shapes,
            calc_text_size=self.shapes.measure, get_font_size=lambda: self.shapes.em,
        )  # fmt: skip
        for module in (names, frames):
            monkeypatch.setattr(module, "imgui", imgui)
        log = SimpleNamespace(attempt=lambda act: act())
        context = SimpleNamespace(session=session, log=log, palette=DARK, fonts=None, places={})
        self.rows = self.state.list_rows(graph, frozenset())
        self.frame: Any = SimpleNamespace(
            context=context, state=self.state, scale=scale, list=(LEFT, TOP, RIGHT, 400.0), rows=self.rows,
            is_sheet=False, pointer=(0.0, 0.0),
        )  # fmt: skip
        self.column: Any = NameColumn()

    def find_row(self, port: Port | str) -> Any:
        return next(row for row in self.rows if (row.port or row.node) == port)

    def click(self, port: Port | str, x: float, **keys: bool) -> None:
        self.io.__dict__.update({"key_ctrl": False, "key_shift": False} | keys)
        self.frame.pointer = (x, TOP)
        self.column._click(self.frame, self.find_row(port), None)


@pytest.fixture
def column(monkeypatch: pytest.MonkeyPatch) -> Column:
    return Column(monkeypatch)


def test_a_node_is_folded_at_its_arrow_or_by_a_double_click_and_chosen_elsewhere(column: Column) -> None:
    column.click("gain", LEFT + 21.0)
    assert column.state.folded == {"gain"}
    column.click("gain", LEFT + 21.0)
    assert not column.state.folded and not column.state.chosen_rows
    column.click("gain", LEFT + 23.0)
    assert column.state.chosen_rows == {GAIN, TINT, CENTER, CLAMP, STEPS} and not column.state.folded
    column.click("soften", LEFT + 50.0, key_ctrl=True)
    assert column.state.chosen_rows == {GAIN, TINT, CENTER, CLAMP, STEPS, SIGMA}
    column.click("soften", LEFT + 50.0, key_ctrl=True)
    assert SIGMA not in column.state.chosen_rows
    column.is_double = True
    column.click("gain", LEFT + 50.0)
    assert column.state.folded == {"gain"}


def test_a_click_at_the_right_sets_a_key_or_removes_it(column: Column) -> None:
    column.session.time.seek(5)
    for expected in ([1, 5, 9], [1, 9]):
        column.click(GAIN, RIGHT - 19.0)
        assert [key.frame for key in column.session.graph.animation[GAIN].keys] == expected
    steps = len(column.session.history.steps)
    column.click(SIGMA, RIGHT - 10.0)
    assert len(column.session.history.steps) == steps and column.state.chosen_rows == {SIGMA}, "an expression has none"


def test_places_to_click_grow_with_the_interface(monkeypatch: pytest.MonkeyPatch) -> None:
    column = Column(monkeypatch, 2.0)
    column.session.time.seek(5)
    column.click("gain", LEFT + 43.0)
    assert column.state.folded == {"gain"}
    column.click("gain", LEFT + 45.0)
    assert column.state.folded == {"gain"} and column.state.chosen_rows
    column.click(GAIN, RIGHT - 39.0)
    assert [key.frame for key in column.session.graph.animation[GAIN].keys] == [1, 5, 9]
    column.click(GAIN, RIGHT - 41.0)
    assert [key.frame for key in column.session.graph.animation[GAIN].keys] == [1, 5, 9]


def test_letters_hide_their_channel(column: Column) -> None:
    """Four letters of 15 pixels end 24 before the right border, so they begin at 216."""
    for place in range(4):
        column.click(TINT, 216.5 + 15.0 * place)
        assert column.state.hidden == {(TINT, place)}
        column.click(TINT, 230.5 + 15.0 * place)
        assert not column.state.hidden
    column.click(TINT, 215.0)
    assert not column.state.hidden and column.state.chosen_rows == {TINT}, "left of them the row is chosen"
    column.frame.is_sheet = True
    column.click(TINT, 230.0)
    assert not column.state.hidden, "the sheet has no letters"
    column.frame.is_sheet = False
    column.click(GAIN, 270.0)
    assert not column.state.hidden, "a number has none"


def test_rows_are_chosen_alone_with_others_or_up_to_one(column: Column) -> None:
    order = [row.port for row in column.rows if row.port]
    first, second, third = order[:3]
    column.click(first, 130.0)
    assert column.state.chosen_rows == {first}
    column.click(third, 130.0, key_shift=True)
    assert column.state.chosen_rows == {first, second, third} and column.state.anchor == first
    column.click(second, 130.0, key_ctrl=True)
    assert column.state.chosen_rows == {first, third} and column.state.anchor == second
    column.click(first, 130.0, key_shift=True)
    assert column.state.chosen_rows == {first, second}
    column.click(third, 130.0)
    column.click(third, 130.0)
    assert column.state.chosen_rows == frozenset(), "once more lets go"


@pytest.mark.parametrize(
    ("port", "text"), [(GAIN, "0.25"), (STEPS, "3"), (CLAMP, "on"), (CENTER, "0.50  0.25"), (TINT, ""), (SIGMA, "2.5")]
)
def test_the_value_is_that_of_the_frame(column: Column, port: Port, text: str) -> None:
    column.session.time.seek(5)
    wide = column.column._draw_value(column.frame, column.find_row(port), 280.0, 60.0)
    assert [shape.text for shape in column.shapes.shapes] == [text] * bool(text)
    assert wide == (pytest.approx(4.0 + len(text) * 0.5 * column.shapes.shapes[0].lengths[0]) if text else 0.0)
    if port == SIGMA:
        column.session.time.seek(8)
        column.column._draw_value(column.frame, column.find_row(port), 280.0, 60.0)
        assert column.shapes.shapes[-1].text == "4"


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_letters_and_diamonds_are_where_they_are_clicked(monkeypatch: pytest.MonkeyPatch, scale: float) -> None:
    column = Column(monkeypatch, scale)
    places = column.frame.context.places
    column.state.hidden = {(TINT, 1)}
    start = column.column._draw_channels(column.frame, column.find_row(TINT), 60.0)
    assert start == RIGHT - 84.0 * scale
    for at, letter in enumerate("rgba"):
        left, top, right, bottom = places[f"keys channel {TINT} {letter}"]
        assert (left, right) == (start + 15.0 * at * scale, start + 15.0 * (at + 1) * scale) and (
            top + bottom
        ) / 2 == 60.0
        assert column.column._find_letter(column.frame, column.find_row(TINT), (left + right) / 2) == at
    colors = [shape.color for shape in column.shapes.shapes]
    assert colors[0] == u32(frames.color_of(column.frame.context, column.find_row(TINT), 0, 0)) and len({*colors}) == 4
    column.shapes.shapes.clear()
    column.session.time.seek(5)
    column.column._draw_diamond(column.frame, column.find_row(GAIN), 60.0, False)
    left, top, right, bottom = places[f"keys diamond {GAIN}"]
    assert ((left + right) / 2, (top + bottom) / 2) == (RIGHT - 12.0 * scale, 60.0) and right - left == 14.0 * scale
    (empty,) = column.shapes.shapes
    assert empty.kind == "outlined ngon" and empty.points == ((RIGHT - 12.0 * scale, 60.0),) and empty.text == "4"
    column.session.time.seek(9)
    column.column._draw_diamond(column.frame, column.find_row(GAIN), 60.0, False)
    assert column.shapes.shapes[1].kind != "outlined ngon", "a key is filled"
    column.column._draw_diamond(column.frame, column.find_row(SIGMA), 60.0, False)
    assert column.shapes.shapes[-1].text == "=" and f"keys diamond {SIGMA}" not in places


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_rows_have_their_parts_from_left_to_right(monkeypatch: pytest.MonkeyPatch, scale: float) -> None:
    column = Column(monkeypatch, scale)
    column.frame.row_height = 22.0 * scale
    for name, part in (("push_font", lambda font, size: None), ("pop_font", lambda: None),
                       ("get_style", lambda: SimpleNamespace(font_scale_main=scale))):  # fmt: skip
        setattr(names.imgui, name, part)
    monkeypatch.setattr(names, "cut_end", lambda text, room: f"{text}|{room:.0f}")
    places, middle = column.frame.context.places, 100.0 + 11.0 * scale

    def draw(port: Port | str, *, hot: bool = False) -> list[Any]:
        column.shapes.shapes.clear()
        row = column.find_row(port)
        column.column._draw_row(column.frame, row, 100.0, column.rows.index(row), hot)
        return [*column.shapes.shapes]

    ground, arrow, label = draw("gain")
    assert places["keys row gain"] == (LEFT, 100.0, RIGHT, 100.0 + 22.0 * scale)
    assert ground.kind == "filled rect" and ground.points == ((LEFT, 100.0), (RIGHT, 100.0 + 22.0 * scale))
    assert arrow.points[0][0] == LEFT + 10.0 * scale and label.points[0][0] == LEFT + 24.0 * scale
    assert label.text == f"gain|{200.0 - 30.0 * scale:.0f}" and label.color == u32(DARK.text)
    column.state.folded = {"gain"}
    assert draw("gain")[1].text != arrow.text
    grounds = [shape.color for shape in (draw("gain")[0], draw(GAIN, hot=True)[0])]
    column.state.chosen_rows = frozenset({GAIN})
    grounds += [draw(GAIN)[0].color, draw(GAIN, hot=True)[0].color]
    assert grounds[2] == grounds[3] == u32(DARK.accent, 0.16) and len({*grounds}) == 3
    column.state.chosen_rows = frozenset()
    dot, value, label, *_ = draw(GAIN)
    assert dot.kind == "disk" and dot.points == ((LEFT + 18.0 * scale, middle),)
    assert value.text == "0.25" and label.text.startswith("gain|") and label.points[0][0] == LEFT + 28.0 * scale
    above = sum(row.port is not None for row in column.rows[: column.rows.index(column.find_row(GAIN))])
    assert dot.color == u32(frames.color_of(column.frame.context, column.find_row(GAIN), 0, above))
    letters = [shape.text for shape in draw(TINT)]
    assert letters[:4] == [*"rgba"] and letters[4] == f"tint|{max(200.0 - (84.0 + 28.0 + 6.0) * scale, 0.0):.0f}"
    column.frame.is_sheet = True
    assert "r" not in [shape.text for shape in draw(TINT)] and draw(GAIN)[0].kind == "text", "the sheet has values"
