"""Small widgets with a window library that only writes down: questions, kept colors, marks of steps, grips."""

from __future__ import annotations

import math
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drawn_shapes import DrawnShapes
from halation.editor.dialogs import question
from halation.editor.fields import swatches
from halation.editor.history import panel as history
from halation.editor.shared.dialogs import Question
from halation.editor.theme.palette import DARK
from halation.editor.theme.style import u32
from halation.editor.viewer import grips, strokes

BLUE = (0.0, 0.25, 1.0, 1.0)
CLEAR = (1.0, 0.5, 0.0, 0.25)


@contextmanager
def enter(*words: Any, **options: Any):
    yield


class Asked:
    """A question with three answers, and what the user does in its next frame."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.given: list[str] = []
        self.keys, self.clicked = set[str](), None
        answers = tuple((name, lambda name=name: self.given.append(name)) for name in ("Save", "Discard", "Cancel"))
        self.dialogs = SimpleNamespace(question=Question("Close?", "It was changed.", answers))
        imgui = SimpleNamespace(
            text_unformatted=lambda text: None, text_wrapped=lambda text: None, dummy=lambda size: None
        )
        for name, part in (("imgui", imgui), ("dialog", enter), ("font", enter),
                           ("backdrop", lambda context, name: True), ("ui_scale", lambda: 1.0),
                           ("_draw_buttons", lambda context, question: self.clicked),
                           ("escape_pressed", lambda: "escape" in self.keys),
                           ("enter_pressed", lambda: "enter" in self.keys)):  # fmt: skip
            monkeypatch.setattr(question, name, part)
        log = SimpleNamespace(attempt=lambda act: act())
        context: Any = SimpleNamespace(dialogs=self.dialogs, log=log)
        self.dialog = next(
            part for part in vars(question).values() if isinstance(part, type) and part.__module__ == question.__name__
        )(context)


@pytest.mark.parametrize(
    ("keys", "clicked", "answer"),
    [
        ({"enter"}, None, "Save"),
        ({"escape"}, None, "Cancel"),
        (set(), 1, "Discard"),
        ({"escape", "enter"}, None, "Cancel"),
    ],
)
def test_a_question_is_answered_once(
    monkeypatch: pytest.MonkeyPatch, keys: set[str], clicked: Any, answer: str
) -> None:
    asked = Asked(monkeypatch)
    asked.dialog.draw()
    assert not asked.given and asked.dialogs.question is not None
    asked.keys, asked.clicked = keys, clicked
    asked.dialog.draw()
    asked.dialog.draw()
    assert asked.given == [answer] and asked.dialogs.question is None


class Swatches:
    """Kept colors in a row of fields of 20 pixels; `pressed` buttons are clicked."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, colors: tuple[Any, ...] = (BLUE, CLEAR)) -> None:
        self.pressed, self.hovered, self.focused, self.keys = set[str](), "", "", set[str]()
        self.gaps, self.last, self.added, self.removed = list[float](), "", list[Any](), list[Any]()
        imgui = SimpleNamespace(
            get_frame_height=lambda: 20.0, get_frame_height_with_spacing=lambda: 24.0, invisible_button=self.press,
            same_line=lambda start, gap: self.gaps.append(gap), is_item_hovered=lambda: self.last == self.hovered,
            is_item_focused=lambda: self.last == self.focused, Key=SimpleNamespace(delete="delete"),
            is_key_pressed=lambda key: key in self.keys, is_mouse_released=lambda button: "right" in self.keys,
            MouseButton_=SimpleNamespace(right=1),
        )  # fmt: skip
        monkeypatch.setattr(swatches, "imgui", imgui)
        monkeypatch.setattr(swatches, "quiet_button", lambda fields, icon, name, doc: name in self.pressed)
        for name in ("record", "draw_swatch", "item_rect", "tip"):
            monkeypatch.setattr(swatches, name, lambda *words: None)
        current = SimpleNamespace(swatches=colors)
        store = SimpleNamespace(current=current, add_swatch=self.added.append, remove_swatch=self.removed.append)
        self.fields: Any = SimpleNamespace(store=store, palette=DARK)

    def press(self, name: str, size: Any) -> bool:
        self.last = name.rpartition(" ")[2]
        return self.last in self.pressed

    def draw(self, **options: Any) -> Any:
        edit = swatches.draw_swatches(self.fields, "tint", (0.1, 0.2, 0.3, 0.4), 350.0, **options)
        return edit and edit.value


def test_a_click_takes_a_kept_color(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = Swatches(monkeypatch)
    assert shown.draw() is None and shown.gaps == [10.0, 10.0], "twelve fields of 20 fill 350 with gaps of 10"
    shown.pressed = {"1"}
    assert shown.draw() == CLEAR and shown.draw(alpha=False) == (*CLEAR[:3], 0.4)
    shown.pressed = {"button keep tint"}
    assert shown.draw() is None and shown.added == [(0.1, 0.2, 0.3, 0.4)] and not shown.removed


@pytest.mark.parametrize(("place", "key"), [("hovered", "right"), ("focused", "delete")])
def test_a_kept_color_is_removed(monkeypatch: pytest.MonkeyPatch, place: str, key: str) -> None:
    shown = Swatches(monkeypatch)
    setattr(shown, place, "1")
    shown.draw()
    assert not shown.removed
    shown.keys = {"right", "delete"} - {key}
    shown.draw()
    assert not shown.removed, "the other key belongs to the other place"
    shown.keys = {key}
    shown.draw()
    assert shown.removed == [CLEAR]


def test_kept_colors_wrap_after_twelve(monkeypatch: pytest.MonkeyPatch) -> None:
    for count in (0, 11, 12, 23, 24):
        shown = Swatches(monkeypatch, (BLUE,) * count)
        shown.draw()
        assert len(shown.gaps) == count - count // 12
    shown.fields.store = None
    assert shown.draw() is None


@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize("first", [True, False])
def test_steps_are_dots_on_a_line(monkeypatch: pytest.MonkeyPatch, scale: float, first: bool) -> None:
    """The dot is left of its row, in its middle; the line begins below the dot of the row above, 20 pixels up."""
    shapes = DrawnShapes()
    imgui = SimpleNamespace(
        get_item_rect_min=lambda: SimpleNamespace(x=100.0 * scale, y=50.0 * scale), get_window_draw_list=lambda: shapes,
        get_item_rect_max=lambda: SimpleNamespace(x=300.0 * scale, y=66.0 * scale),
        get_text_line_height_with_spacing=lambda: 20.0 * scale,
    )  # fmt: skip
    monkeypatch.setattr(history, "imgui", imgui)
    monkeypatch.setattr(history, "ui_scale", lambda: scale)
    context: Any = SimpleNamespace(palette=DARK)
    history._draw_mark(context, BLUE[:3], first)  # pyright: ignore[reportPrivateUsage]
    (dot,) = shapes.list_kinds("disk")
    assert dot.points == ((90.0 * scale, 58.0 * scale),) and dot.color == u32(BLUE[:3]) and dot.lengths[0] < 5.0 * scale
    lines = shapes.list_kinds("line")
    assert len(lines) == (not first)
    for line in lines:
        (x0, y0), (x1, y1) = line.points
        assert x0 == x1 == 90.0 * scale and line.lengths == (2.0 * scale,)
        assert y1 < 58.0 * scale - dot.lengths[0] and y0 > 38.0 * scale + dot.lengths[0] and y1 - y0 == 10.0 * scale


@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize("lit", [False, True])
@pytest.mark.parametrize("shape", ["place", "corner", "turn", "size", "skew"])
def test_grips_lie_around_their_place_with_a_dark_border(
    monkeypatch: pytest.MonkeyPatch, shape: Any, lit: bool, scale: float
) -> None:
    for module in (grips, strokes):
        monkeypatch.setattr(module, "ui_scale", lambda: scale)
    drawn: Any = DrawnShapes()
    grips.draw_grip(drawn, (50.0, 80.0), shape, is_lit=lit)
    ink, shade = u32(strokes.CHOSEN if lit else strokes.WHITE), u32(strokes.BLACK, strokes.SHADE)
    if shape == "place":
        outer, inner = drawn.list_kinds("circle")
        assert outer.lengths[0] == inner.lengths[0] and outer.lengths[1] == 2.0 * inner.lengths[1] == 3.0 * scale
    elif shape in ("corner", "skew"):
        outer, inner = drawn.list_kinds("polygon")
        reach = [[math.dist(point, (50.0, 80.0)) for point in part.points] for part in (outer, inner)]
        assert np.ptp(reach[0]) < 1e-4 and reach[0][0] == pytest.approx(reach[1][0] + 1.5 * scale, abs=1e-4)
        upright = np.array(inner.points) - (50.0, 80.0)
        assert bool(np.abs(upright).min() < 1e-4) is (shape == "skew"), "a diamond, or a square"
    else:
        outer, inner = drawn.list_kinds("disk")
        assert outer.points == inner.points == ((50.0, 80.0),)
        assert outer.lengths[0] == inner.lengths[0] + 1.5 * scale
    assert (outer.color, inner.color) == (shade, ink)
    assert grips.is_near((50.0, 80.0), (50.0 + 9.5 * scale, 80.0)) and not grips.is_near(
        (50.0, 80.0), (50.0, 80.0 - 9.7 * scale)
    )
