"""Buttons, lists and switches as the library lays them out: where they are, what they show, and what a click gives."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.editor.fields.choice_field import choose, toggle_field
from halation.editor.fields.fields import Fields
from halation.editor.theme.palette import DARK
from halation.editor.theme.style import mix, u32
from halation.editor.toolkit import buttons
from halation.nodes import Value
from imgui_bundle import imgui
from still_window import open_still

SCALES = pytest.mark.parametrize("scale", [1.0, 2.0])
ICON = "\uf013"
LONG = tuple(f"choice {number:02}" for number in range(40))
SWITCH = Value("x", "bool", True)


def make_surface() -> Any:
    return SimpleNamespace(palette=DARK, places={}, fonts=None)


def width_of(text: str) -> float:
    return imgui.calc_text_size(text).x


@SCALES
def test_icons_have_square_buttons_and_words_have_room(scale: float) -> None:
    surface = make_surface()
    with open_still(scale=scale) as pane:

        def body() -> tuple[float, float, float]:
            buttons.quiet_button(surface, ICON, "icon", "")
            buttons.quiet_button(surface, "Words", "words", "")
            buttons.quiet_button(surface, "Words", "wide", "", width=150.0 * scale)
            return (
                width_of("Words"),
                buttons.width_of_buttons(ICON, "Words"),
                buttons.width_of_buttons("Words", gap=1.0),
            )

        words, both, one = pane.draw(body, 2)
        left, top, right, bottom = surface.places["icon"]
        assert right - left == bottom - top == 24.0 * scale
        left, _, right, _ = surface.places["words"]
        assert right - left == words + 14.0 * scale == one
        assert both == 24.0 * scale + 8.0 * scale + words + 14.0 * scale
        left, _, right, _ = surface.places["wide"]
        assert right - left == 150.0 * scale


def test_a_button_that_is_off_cannot_be_clicked() -> None:
    surface = make_surface()
    with open_still() as pane:
        for enabled in (True, False):

            def body(enabled: bool = enabled) -> bool:
                return buttons.quiet_button(surface, "Words", "words", "", enabled=enabled)

            pane.draw(body)
            assert any(pane.click(surface.places["words"], body)) is enabled

            def main(enabled: bool = enabled) -> bool:
                return buttons.main_button(surface, "Words", "main", enabled=enabled, width=90.0)

            pane.draw(main)
            assert any(pane.click(surface.places["main"], main)) is enabled


@SCALES
def test_buttons_of_one_dialog_are_as_wide_as_the_widest(scale: float) -> None:
    with open_still(scale=scale) as pane:
        long = "a long label of a button"
        wide, short = pane.draw(lambda: (buttons.measure_buttons("OK", long), buttons.measure_buttons("OK")))
        assert wide == pane.draw(lambda: width_of(long)) + 28.0 * scale
        assert short == 96.0 * scale
        assert pane.draw(lambda: buttons.measure_buttons("OK", least=150.0)) == 150.0 * scale


@SCALES
def test_buttons_end_at_the_right_border(scale: float) -> None:
    surface = make_surface()
    with open_still(scale=scale) as pane:

        def body(before: float) -> float:
            imgui.dummy((before * scale, 10.0 * scale))
            right = imgui.get_cursor_screen_pos().x + imgui.get_content_region_avail().x
            top = imgui.get_item_rect_min().y
            buttons.align_right("One", ICON)
            buttons.quiet_button(surface, "One", "one", "")
            imgui.same_line()
            buttons.quiet_button(surface, ICON, "two", "")
            assert surface.places["two"][2] == right
            return surface.places["one"][1] - top

        assert pane.draw(lambda: body(100.0)) == 0.0
        assert pane.draw(lambda: body(290.0)) == 16.0 * scale, "the next line: they do not fit beside it"
        pane.draw(lambda: buttons.close_button(surface, "close"))
        assert surface.places["close"][2] == 332.0 * scale
        assert surface.places["close"][2] - surface.places["close"][0] == 96.0 * scale


def test_a_menu_opens_below_its_button_and_has_a_limit() -> None:
    surface, opened = make_surface(), list[tuple[float, ...]]()
    with open_still() as pane:

        def fill() -> None:
            for number in range(60):
                imgui.selectable(f"entry {number}", False)
            at, size = imgui.get_window_pos(), imgui.get_window_size()
            opened.append((at.x, at.y, size.x, size.y))

        def body() -> None:
            buttons.dropdown(surface, "More", "more", "", fill)

        pane.draw(body)
        assert not opened
        pane.click(surface.places["more"], body)
        left, _, _, bottom = surface.places["more"]
        x, y, width, height = opened[-1]
        assert (x, y, height) == (left, bottom + 2.0, 28 * 16.0) and width > 60.0


def choose_from(choices: Any, current: str, rect: Any = None) -> Any:
    fields = Fields(DARK)
    return fields, lambda: choose(fields, "op", current, choices, 200.0)


@pytest.mark.parametrize(("choices", "filtered"), [(LONG[:7], False), (LONG[:8], True), (LONG, True)])
def test_a_list_opens_below_its_field_as_wide_as_it(choices: Any, filtered: bool) -> None:
    _, body = choose_from(choices, choices[2])
    with open_still() as pane:
        pane.draw(body)
        field = pane.find("invisible_button").points
        assert field == ((28.0, 38.0), (228.0, 62.0))
        pane.click((*field[0], *field[1]), body)
        entries = [shape for shape in pane.widgets if shape.kind == "selectable"]
        assert [shape.text.split("##")[0] for shape in entries] == list(choices)
        search = [shape for shape in pane.widgets if shape.kind == "input_text_with_hint"]
        assert len(search) == filtered
        if filtered:
            (left, top), (right, _) = search[0].points
            assert (left, right) == (36.0, 220.0) and top == 70.0, "padding of 8 at each side"
        entry = next(shape for shape in entries if shape.text.startswith(choices[3]))
        rect = (*entry.points[0], *entry.points[1])
        assert 3 in pane.click(rect, body)
        assert not [shape for shape in pane.widgets if shape.kind == "selectable"], "it is closed"


def test_a_list_in_a_narrow_field_leaves_room_for_the_search() -> None:
    fields = Fields(DARK)
    with open_still() as pane:

        def body() -> Any:
            return choose(fields, "op", LONG[0], LONG, 30.0)

        pane.draw(body)
        pane.click((28.0, 38.0, 58.0, 62.0), body)
        (left, _), (right, _) = pane.find("input_text_with_hint").points
        line = pane.draw(imgui.get_text_line_height_with_spacing)
        assert right - left == 6 * line


def test_letters_search_short_and_long_lists() -> None:
    for choices, keys in (
        (("alpha", "beta", "gamma"), (imgui.Key.g,)),
        (("one", "two", "Tea"), (imgui.Key.t, imgui.Key.e)),
    ):
        fields, body = choose_from(choices, choices[0])
        with open_still() as pane:
            pane.draw(body)
            pane.click((28.0, 38.0, 228.0, 62.0), body)
            for key in keys:
                pane.press(key, body)
            assert fields.filter == "".join(key.name for key in keys)
            assert [shape.text for shape in pane.widgets if shape.kind == "selectable"] == [f"{choices[2]}##2"]
            assert pane.press(imgui.Key.enter, body) == 2
    fields, body = choose_from(("alpha", "beta", "gamma"), "beta")
    with open_still() as pane:
        pane.draw(body)
        pane.click((28.0, 38.0, 228.0, 62.0), body)
        pane.press(imgui.Key.z, body)
        assert len([shape for shape in pane.widgets if shape.kind == "selectable"]) == 3, "nothing matches: all stay"
        pane.press(imgui.Key.backspace, body)
        assert fields.filter == ""
        assert pane.press(imgui.Key.escape, body) is None
        assert not [shape for shape in pane.widgets if shape.kind == "selectable"]


@pytest.mark.parametrize(
    ("current", "wheel", "ctrl", "index"),
    [("beta", 1.0, True, 0), ("beta", -1.0, True, 2), ("beta", 1.0, False, None), ("alpha", 1.0, True, None),
     ("gamma", -1.0, True, None), ("other", 1.0, True, None)],
)  # fmt: skip
def test_the_wheel_steps_through_a_list_while_ctrl_is_held(
    current: str, wheel: float, ctrl: bool, index: int | None
) -> None:
    _, body = choose_from(("alpha", "beta", "gamma"), current)
    with open_still() as pane:
        pane.point((100.0, 50.0))
        pane.draw(body, 2)
        imgui.get_io().add_key_event(imgui.Key.mod_ctrl, ctrl)
        imgui.get_io().add_mouse_wheel_event(0.0, wheel)
        assert pane.draw(body) == index
        pane.point((100.0, 300.0))
        pane.draw(body, 2)
        imgui.get_io().add_mouse_wheel_event(0.0, wheel)
        assert pane.draw(body) is None, "the pointer is elsewhere"


def test_what_a_list_shows() -> None:
    fields = Fields(DARK)
    with open_still() as pane:
        pane.draw(lambda: choose(fields, "op", "b", ("a", "b"), 200.0))
        (text,) = pane.shapes.list_kinds("text")
        assert (text.text, text.points, text.color) == ("b", ((35.0, 42.0),), u32(DARK.text))
        pane.draw(lambda: choose(fields, "op", "lost", ("a", "b"), 200.0))
        assert pane.shapes.list_kinds("text")[0].color == u32(DARK.error)
        pane.draw(lambda: choose(fields, "op", "lost", ("a", "b"), 200.0, mixed=True))
        (text,) = pane.shapes.list_kinds("text")
        assert text.text not in ("lost", "a", "b") and text.color == u32(DARK.text)
        pane.draw(lambda: choose(fields, "op", "b", ("a", "b"), 200.0, label="name"))
        label, text = pane.shapes.list_kinds("text")
        assert (label.text, label.points, label.color) == ("name", ((35.0, 42.0),), u32(DARK.dim))
        arrow = 0.8 * 16.0
        assert text.points[0][0] + pane.draw(lambda: width_of("b")) == pytest.approx(228.0 - 7.0 - arrow)
        pane.draw(lambda: choose(fields, "op", "b", ("a", "b"), 200.0, label="a very long name of a field"))
        label, text = pane.shapes.list_kinds("text")
        inner = 200.0 - 14.0 - arrow
        assert label.text.endswith("…") and pane.draw(lambda: width_of(label.text)) <= 0.45 * inner
        letter = pane.draw(lambda: width_of("a"))
        assert pane.draw(lambda: width_of(label.text)) > 0.45 * inner - 2 * letter


@pytest.mark.parametrize("label", ["", "name"])
@pytest.mark.parametrize("value", [True, False])
@pytest.mark.parametrize("mixed", [True, False])
def test_a_switch_shows_its_side(label: str, value: bool, mixed: bool) -> None:
    fields = Fields(DARK)
    with open_still() as pane:

        def body() -> Any:
            return toggle_field(fields, "on", value, SWITCH, 200.0, label=label, mixed=mixed)

        pane.draw(body)
        (track,), (knob,), (text,) = (pane.shapes.list_kinds(kind) for kind in ("filled rect", "disk", "text"))
        (left, top), (right, bottom) = track.points
        height = 0.62 * 24.0
        assert (bottom - top, right - left) == pytest.approx((height, 1.8 * height))
        assert (top + bottom) / 2 == pytest.approx(50.0) and track.lengths == pytest.approx((height / 2,))
        assert (right == 228.0) if label else (left == 28.0)
        on = value and not mixed
        assert track.color == u32(DARK.accent if on else DARK.raised)
        assert knob.color == u32(DARK.on_accent if on else DARK.dim)
        middle = (left + right) / 2 if mixed else right - height / 2 if value else left + height / 2
        assert knob.points[0] == pytest.approx((middle, 50.0)) and knob.lengths == pytest.approx((0.36 * height,))
        words = label or ("On" if value else "Off")
        assert (text.text == words or (mixed and not label)) and text.color == u32(DARK.dim)
        assert text.points[0][0] == pytest.approx(28.0 if label else right + 6.0)
        edits = [edit.value for edit in pane.click((28.0, 38.0, 228.0, 62.0), body) if edit]
        assert edits == [not value]
        track = pane.shapes.list_kinds("filled rect")[0]
        assert track.color == u32(mix(DARK.accent, DARK.text, 0.15) if on else DARK.hover), "the pointer is over it"
