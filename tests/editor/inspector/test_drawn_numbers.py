"""How a number field is drawn while nobody types in it: its bar, its text, and what goes where room is short."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from drawn_shapes import DrawnShapes
from halation.editor.canvas import legend
from halation.editor.canvas.legend import Legend
from halation.editor.fields import number_field
from halation.editor.fields.fields import Fields
from halation.editor.theme.palette import DARK
from halation.nodes import Value

PAD = 6.0
"""Three quarters of the padding of a frame."""

LETTER = 8.0


@pytest.fixture
def draw(monkeypatch: pytest.MonkeyPatch):
    """`draw(width, number, ...)`: the shapes of a field from 100 on, 20 high, and its words with their boxes."""
    shapes = DrawnShapes(2 * LETTER)
    words: list[tuple[tuple[float, ...], str, object]] = []
    style = SimpleNamespace(frame_padding=SimpleNamespace(x=PAD / 0.75), frame_rounding=3.0)
    fake = SimpleNamespace(
        get_style=lambda: style, get_window_draw_list=lambda: shapes, calc_text_size=lambda text: shapes.measure(text)
    )
    monkeypatch.setattr(number_field, "imgui", fake)
    monkeypatch.setattr(number_field, "background", lambda *words, **options: None)
    monkeypatch.setattr(number_field, "write", lambda box, text, color: words.append((box, text, color)))

    def draw(width: float, number: float, unit: str = "", label: str = "", **options: Any):
        shapes.shapes.clear()
        words.clear()
        value = Value("x", "float", 0.5, low=0.0, high=2.0)
        states = {"mixed": False, "hovered": False, "active": False, "plain": False, **options}
        rect = (100.0, 40.0, 100.0 + width, 60.0)
        number_field._draw(Fields(DARK), rect, number, value, unit, label, **states)
        return shapes.shapes[:], list(words)

    return draw


def test_the_number_stands_in_the_middle_and_its_bar_ends_at_its_place(draw) -> None:
    shapes, ((box, text, color),) = draw(200.0, 0.5)
    assert float(text) == 0.5 and color == DARK.text
    assert box == (200.0 - 0.5 * LETTER * len(text), 40.0, 300.0 - PAD, 60.0)
    clip, bar, unclip = shapes
    assert clip.points == ((100.0, 40.0), (150.0, 60.0)) and bar.points == ((100.0, 40.0), (300.0, 60.0))
    assert unclip.kind == "unclip"
    assert draw(200.0, 0.5, plain=True)[0] == draw(200.0, 0.5, mixed=True)[0] == []
    assert [part.color for part in draw(200.0, 0.5, active=True)[0]][1] != bar.color


def test_number_and_unit_stand_in_the_middle_together(draw) -> None:
    _, ((box, text, _), (unit_box, unit, color)) = draw(200.0, 0.5, "px")
    whole = LETTER * len(text + unit)
    assert unit == " px" and color == DARK.dim
    assert box[0] == 200.0 - 0.5 * whole and unit_box[0] == box[0] + LETTER * len(text)
    assert unit_box[2] == 300.0


def test_where_room_is_short_the_unit_goes_first_then_digits(draw) -> None:
    text = draw(200.0, 0.123)[1][0][1]
    room = LETTER * len(text)
    _, words = draw(room + 2 * PAD + 1.0, 0.123, "px")
    assert [word for _, word, _ in words] == [text]
    assert words[0][0][0] == pytest.approx(100.0 + PAD + 0.5)  # half of the point that is left
    _, words = draw(room + 2 * PAD - 1.0, 0.123)
    assert [word for _, word, _ in words] == [text[:-1]]
    _, words = draw(2 * PAD + 2.0, 0.123)  # less than a letter
    assert [word for _, word, _ in words] == ["0"] and words[0][0][0] == 100.0 + PAD


def test_a_label_stands_left_and_leaves_the_number_its_room(draw) -> None:
    _, ((label_box, label, dim), (box, text, _)) = draw(200.0, 0.5, label="x")
    assert (label, dim) == ("x", DARK.dim) and label_box[0] == 100.0 + PAD
    assert box[0] == 300.0 - PAD - LETTER * len(text) and label_box[2] == box[0] - PAD


def test_several_numbers_are_a_dash(draw) -> None:
    assert [word for _, word, _ in draw(200.0, 0.5, "px", mixed=True)[1]] == [number_field.NO_VALUE]


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_the_question_mark_is_in_the_lower_left_corner(monkeypatch: pytest.MonkeyPatch, scale: float) -> None:
    monkeypatch.setattr(legend, "ui_scale", lambda: scale)
    box = Legend(None).find_rect((10.0, 20.0, 500.0, 400.0))  # pyright: ignore[reportArgumentType]
    assert box == (10.0 + 12.0 * scale, 400.0 - 36.0 * scale, 10.0 + 36.0 * scale, 400.0 - 12.0 * scale)
