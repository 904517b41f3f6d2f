"""Text that the editor places itself: cut to its box, aligned in it, and notes that stay inside of the window."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from drawn_shapes import DrawnShapes
from halation.editor.theme.palette import DARK
from halation.editor.theme.style import u32
from halation.editor.toolkit import words

LETTER = 8.0


@pytest.fixture
def shapes(monkeypatch: pytest.MonkeyPatch) -> DrawnShapes:
    """What is drawn in a window of 400x300 pixels whose corner is at (50, 20)."""
    drawn = DrawnShapes(2 * LETTER)
    view = SimpleNamespace(pos=SimpleNamespace(x=50.0, y=20.0), size=SimpleNamespace(x=400.0, y=300.0))
    fake = SimpleNamespace(
        calc_text_size=drawn.measure,
        get_window_draw_list=lambda: drawn,
        get_foreground_draw_list=lambda: drawn,
        get_main_viewport=lambda: view,
        get_font_size=lambda: drawn.em,
        get_font=lambda: None,
        get_style=lambda: SimpleNamespace(frame_padding=SimpleNamespace(x=6.0, y=4.0), frame_rounding=3.0),
    )
    monkeypatch.setattr(words, "imgui", fake)
    return drawn


@pytest.mark.parametrize(
    ("room", "end", "middle"),
    [
        (9, "halation", "halation"),
        (8, "halation", "halation"),
        (7, "halati…", "hal…ion"),
        (4, "hal…", "h…on"),
        (2, "h…", "…n"),
        (1, "", ""),
        (0, "", ""),
    ],
)
def test_a_text_is_cut_to_its_room(shapes: DrawnShapes, room: int, end: str, middle: str) -> None:
    assert words.cut_end("halation", LETTER * room) == end
    assert words.cut_middle("halation", LETTER * room) == middle


@pytest.mark.parametrize(("align", "x"), [(0.0, 100.0), (0.5, 134.0), (1.0, 168.0)])
def test_a_line_is_aligned_in_its_box(shapes: DrawnShapes, align: float, x: float) -> None:
    assert words.write((100.0, 40.0, 200.0, 70.0), "glow", DARK.text, align, 0.5) == 4 * LETTER
    (line,) = shapes.shapes
    assert line.points == ((x, 47.0),)  # 16 high in a box of 30
    assert (line.text, line.color) == ("glow", u32(DARK.text, 0.5))


def test_a_line_without_room_is_cut(shapes: DrawnShapes) -> None:
    words.write((100.0, 40.0, 100.0 + 3 * LETTER, 70.0), "glowing", DARK.text, 1.0)
    assert [(line.text, line.points) for line in shapes.shapes] == [("gl…", ((100.0, 47.0),))]


@pytest.mark.parametrize(("left", "x"), [(60.0, 60.0), (430.0, 450.0 - 12.0 - 5 * LETTER), (0.0, 50.0)])
def test_a_note_is_below_its_field_and_inside_of_the_window(shapes: DrawnShapes, left: float, x: float) -> None:
    words.note_below(DARK, (left, 100.0, left + 20.0, 120.0), "wrong", DARK.error)
    ground, frame, text = shapes.shapes
    low, high = (x, 124.0), (x + 5 * LETTER + 12.0, 124.0 + 16.0 + 8.0)
    assert ground.points == frame.points == (low, high)
    assert text.points == ((x + 6.0, 128.0),) and text.color == frame.color == u32(DARK.error)
    assert ground.color == u32(DARK.window)


def test_a_long_note_takes_several_rows(shapes: DrawnShapes) -> None:
    words.note_below(DARK, (60.0, 100.0, 80.0, 120.0), "n" * 60, DARK.error)
    wrap: Any = min(2 * LETTER * 20, 400.0)
    rows = -(-60 * LETTER // wrap)
    assert shapes.shapes[0].points == ((60.0, 124.0), (60.0 + wrap + 12.0, 124.0 + rows * 16.0 + 8.0))
    assert shapes.shapes[2].lengths[1] == wrap
