"""Input from the window system, as the interface library sees it frame by frame."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from halation.editor.toolkit.keys import chord
from halation.editor.window.input_events import InputQueue
from imgui_bundle import imgui

import glfw  # isort: skip

NAMES = ("Ctrl+S", "S", "Ctrl+Shift+S", "Ctrl+A", "A", "Ctrl+Z", "Z", "Alt+X", "X")

KEYS = frozenset({*"aqzw", "_2", "_6", "_7", "_8", "minus", "comma", "semicolon", "backslash", "f5", "keypad7",
                  "left_arrow"})  # fmt: skip


@pytest.fixture
def queue() -> Iterator[InputQueue]:
    context = imgui.create_context()
    io = imgui.get_io()
    io.display_size = imgui.ImVec2(640.0, 480.0)
    io.backend_flags |= int(imgui.BackendFlags_.renderer_has_textures)
    io.set_ini_filename("")
    queue = InputQueue()
    for _ in range(3):
        frame(queue)
    yield queue
    imgui.destroy_context(context)


def frame(queue: InputQueue) -> list[str]:
    """The chords that the interface library sees pressed in one frame."""
    queue.forward()
    imgui.new_frame()
    held = int(imgui.get_io().key_mods)
    pressed = [
        name
        for name in NAMES
        if imgui.is_key_pressed(imgui.Key(chord(name.rpartition("+")[2])), False)
        and held == chord(name) - chord(name.rpartition("+")[2])
    ]
    imgui.end_frame()
    return pressed


def press(queue: InputQueue, key: int, bits: int = 0) -> None:
    queue.add_key(key, 0, glfw.PRESS, bits)


def release(queue: InputQueue, key: int, bits: int = 0) -> None:
    queue.add_key(key, 0, glfw.RELEASE, bits)


def tap_chord(queue: InputQueue, modifier: int, bit: int, key: int, modifier_first: bool) -> None:
    press(queue, modifier)
    press(queue, key, bit)
    if modifier_first:
        release(queue, modifier, bit)
        release(queue, key)
    else:
        release(queue, key, bit)
        release(queue, modifier, bit)


@pytest.mark.parametrize("modifier_first", [False, True])
def test_chords_between_two_frames_arrive_each_in_a_frame(queue: InputQueue, modifier_first: bool) -> None:
    for key in (glfw.KEY_S, glfw.KEY_A, glfw.KEY_Z):
        tap_chord(queue, glfw.KEY_LEFT_CONTROL, glfw.MOD_CONTROL, key, modifier_first)
    tap_chord(queue, glfw.KEY_RIGHT_ALT, glfw.MOD_ALT, glfw.KEY_X, modifier_first)
    press(queue, glfw.KEY_S)
    release(queue, glfw.KEY_S)
    seen = [name for _ in range(12) for name in frame(queue)]
    assert seen == ["Ctrl+S", "Ctrl+A", "Ctrl+Z", "Alt+X", "S"]
    assert not queue and int(imgui.get_io().key_mods) == 0


def test_shift_joins_control(queue: InputQueue) -> None:
    press(queue, glfw.KEY_LEFT_CONTROL)
    press(queue, glfw.KEY_LEFT_SHIFT, glfw.MOD_CONTROL)
    press(queue, glfw.KEY_S, glfw.MOD_CONTROL | glfw.MOD_SHIFT)
    release(queue, glfw.KEY_LEFT_SHIFT, glfw.MOD_CONTROL | glfw.MOD_SHIFT)
    release(queue, glfw.KEY_LEFT_CONTROL, glfw.MOD_CONTROL)
    release(queue, glfw.KEY_S)
    assert [name for _ in range(4) for name in frame(queue)] == ["Ctrl+Shift+S"]


def test_what_is_typed_behind_a_chord_is_text(queue: InputQueue) -> None:
    tap_chord(queue, glfw.KEY_LEFT_CONTROL, glfw.MOD_CONTROL, glfw.KEY_A, True)
    for character in "xyz":
        press(queue, ord(character.upper()))
        queue.add_text(ord(character))
        release(queue, ord(character.upper()))
    assert frame(queue) == ["Ctrl+A"]
    assert imgui.get_io().want_text_input is False
    assert [name for _ in range(8) for name in frame(queue)] == ["X", "Z"] and not queue


def test_text_without_a_key_has_the_modifiers_of_its_moment(queue: InputQueue) -> None:
    """Input methods send it so. The library drops text that comes while Ctrl is held."""
    queue.add_text(ord("é"))
    press(queue, glfw.KEY_LEFT_CONTROL)
    press(queue, glfw.KEY_S, glfw.MOD_CONTROL)
    assert frame(queue) == [] and int(imgui.get_io().key_mods) == 0
    assert [name for _ in range(3) for name in frame(queue)] == ["Ctrl+S"]


def test_a_click_has_the_modifiers_of_its_moment(queue: InputQueue) -> None:
    press(queue, glfw.KEY_LEFT_SHIFT)
    queue.add_button(0, glfw.PRESS, glfw.MOD_SHIFT)
    queue.add_button(0, glfw.RELEASE, glfw.MOD_SHIFT)
    release(queue, glfw.KEY_LEFT_SHIFT, glfw.MOD_SHIFT)
    queue.add_button(0, glfw.PRESS, 0)
    clicks = []
    for _ in range(6):
        frame(queue)
        if imgui.is_mouse_clicked(0):
            clicks.append(imgui.get_io().key_shift)
    assert clicks == [True, False]


@pytest.mark.parametrize(
    ("label", "key", "seen"),
    [
        ("a", glfw.KEY_Q, "a"), ("A", glfw.KEY_Q, "a"), (b"z", glfw.KEY_W, "z"), ("7", glfw.KEY_8, "_7"),
        ("-", glfw.KEY_6, "minus"), (";", glfw.KEY_COMMA, "semicolon"), ("\\", glfw.KEY_8, "backslash"),
        ("é", glfw.KEY_2, "_2"), ("", glfw.KEY_Q, "q"), (None, glfw.KEY_F5, "f5"), ("ab", glfw.KEY_Q, "q"),
        ("!", glfw.KEY_8, "_8"), ("7", glfw.KEY_KP_7, "keypad7"), (None, glfw.KEY_LEFT, "left_arrow"),
    ],
)  # fmt: skip
def test_keys_are_what_the_layout_prints_on_them(
    queue: InputQueue, monkeypatch: pytest.MonkeyPatch, label: str | bytes | None, key: int, seen: str
) -> None:
    """On a French keyboard the key right of Tab is A. What prints nothing that is known counts by its place."""
    monkeypatch.setattr(glfw, "get_key_name", lambda key, scancode: label)
    press(queue, key)
    queue.forward()
    imgui.new_frame()
    pressed = [name for name in imgui.Key.__members__ if name in KEYS and imgui.is_key_pressed(imgui.Key[name], False)]
    imgui.end_frame()
    assert pressed == [seen]


def test_a_modifier_released_over_another_window_is_not_held_for_ever(queue: InputQueue) -> None:
    press(queue, glfw.KEY_LEFT_CONTROL)
    press(queue, glfw.KEY_S, 0)
    assert [name for _ in range(3) for name in frame(queue)] == ["S"]


def test_the_wheel_waits_for_its_modifiers(queue: InputQueue) -> None:
    press(queue, glfw.KEY_A)
    press(queue, glfw.KEY_LEFT_CONTROL)
    queue.add_wheel(0.0, 1.0)
    turns = []
    for _ in range(3):
        queue.forward()
        imgui.new_frame()
        turns.append((imgui.get_io().mouse_wheel, imgui.get_io().key_ctrl))
        imgui.end_frame()
    assert turns == [(0.0, False), (1.0, True), (0.0, True)]


def test_text_arrives_in_one_frame_and_enter_behind_it(queue: InputQueue) -> None:
    def edit_frame(text: str, focus: bool = False) -> tuple[bool, str]:
        queue.forward()
        imgui.new_frame()
        imgui.begin("window")
        if focus:
            imgui.set_keyboard_focus_here()
        has_entered, text = imgui.input_text("field", text, imgui.InputTextFlags_.enter_returns_true)
        imgui.end()
        imgui.end_frame()
        return has_entered, text

    for index in range(4):
        edit_frame("", focus=index == 0)
    assert imgui.get_io().want_text_input
    for character in "/Tmp/My look.json":
        shift = glfw.MOD_SHIFT if character.isupper() else 0
        if shift:
            press(queue, glfw.KEY_LEFT_SHIFT)
        press(queue, ord(character.upper()), shift)
        queue.add_text(ord(character))
        release(queue, ord(character.upper()), shift)
        if shift:
            release(queue, glfw.KEY_LEFT_SHIFT, shift)
    press(queue, glfw.KEY_ENTER)
    release(queue, glfw.KEY_ENTER)
    frames = [edit_frame("") for _ in range(3)]
    assert (True, "/Tmp/My look.json") in frames[:2]
    press(queue, glfw.KEY_S)
    assert not imgui.get_io().want_text_input and [name for _ in range(4) for name in frame(queue)] == ["S"]


@pytest.mark.parametrize("has_keys", [True, False], ids=["keys", "composed"])
@pytest.mark.parametrize("delay", [0, 1])
@pytest.mark.parametrize("sort", ["popup", "window", "modal"])
def test_a_field_that_a_key_opens_gets_all_that_is_typed_behind_it(
    queue: InputQueue, sort: str, delay: int, has_keys: bool
) -> None:
    """Whatever opens the field: it appears in the frame of the key or in the next one, and asks for the focus. Input
    methods send text without keys.
    """
    text, opened_at, leaks = "", 0, []

    def draw(count: int) -> None:
        nonlocal text, opened_at
        queue.forward()
        imgui.new_frame()
        if imgui.is_key_pressed(imgui.Key.tab, False) and not opened_at:
            opened_at = count
        leaks.extend(name for name in ("X", "A", "S") if imgui.is_key_pressed(imgui.Key(chord(name)), False))
        begins = opened_at and count == opened_at + delay
        if begins and sort != "window":
            imgui.open_popup("field")
        shows = {
            "popup": lambda: imgui.begin_popup("field"),
            "modal": lambda: imgui.begin_popup_modal("field")[0],
            "window": lambda: bool(opened_at) and count >= opened_at + delay and imgui.begin("field")[0],
        }[sort]()
        if shows:
            if begins:
                imgui.set_keyboard_focus_here()
            _, text = imgui.input_text("##text", text)
            imgui.end() if sort == "window" else imgui.end_popup()
        imgui.end_frame()

    press(queue, glfw.KEY_TAB)
    release(queue, glfw.KEY_TAB)
    for character in "xaasx":
        if has_keys:
            press(queue, ord(character.upper()))
        queue.add_text(ord(character))
        if has_keys:
            release(queue, ord(character.upper()))
    for count in range(1, 30):
        draw(count)
    assert text == "xaasx" and not leaks


def test_the_character_of_a_shortcut_is_no_text_for_the_field_that_it_opens(queue: InputQueue) -> None:
    """The character comes with its key, and more of them while the key is held."""
    text, is_open = "", False
    for count in range(40):
        if count == 2:
            press(queue, glfw.KEY_X)
            queue.add_text(ord("x"))
        if count in (3, 9):
            queue.add_key(glfw.KEY_X, 0, glfw.REPEAT, 0)
            queue.add_text(ord("x"))
        if count == 20:
            release(queue, glfw.KEY_X)
            queue.add_text(ord("é"))  # an input method sends no key
        queue.forward()
        imgui.new_frame()
        begins = imgui.is_key_pressed(imgui.Key.x, False) and not is_open
        is_open |= begins
        if is_open:
            imgui.begin("field")
            if begins:
                imgui.set_keyboard_focus_here()
            _, text = imgui.input_text("##text", text)
            imgui.end()
        imgui.end_frame()
    assert text == "é"
