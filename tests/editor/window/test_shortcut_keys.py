"""Keys run the actions whose shortcuts they are: all of them, in their panel, and where nothing else takes keys."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from halation.editor.shared.window_commands import PanelTitle
from halation.editor.window.shortcuts import note_scope, run_shortcuts
from halation.graph import Graph
from imgui_bundle import imgui
from still_editor import StillEditor, open_still_editor

SCOPES = {"": None, "graph": PanelTitle.GRAPH, "viewer": PanelTitle.VIEWER, "animation": PanelTitle.ANIMATION}
"""The panel in which the shortcuts of a scope work."""

MODIFIERS = {"Ctrl": imgui.Key.mod_ctrl, "Shift": imgui.Key.mod_shift, "Alt": imgui.Key.mod_alt}


class Keyboard:
    """An editor whose actions are only written down."""

    def __init__(self, still: StillEditor, patch: pytest.MonkeyPatch) -> None:
        self.still, self.ran = still, list[str]()
        self.body: Callable[[], object] = lambda: None
        patch.setattr(type(still.editor.actions), "run", lambda actions, id: self.ran.append(id))

    def press(self, text: str) -> list[str]:
        """Press the keys of a shortcut and let them go; the actions that ran, once each has had its frame."""
        io, editor = imgui.get_io(), self.still.editor
        *modifiers, name = text.split("+")
        key = next(key for key in imgui.Key if imgui.get_key_name(key) == name)

        def draw() -> None:
            note_scope(editor)
            run_shortcuts(editor)
            self.body()

        self.still.pane.draw(draw, 2)  # the library gives out keys one frame before they are pressed
        self.ran.clear()
        for is_down in (True, False):
            for each in [*(MODIFIERS[modifier] for modifier in modifiers), key][:: 1 if is_down else -1]:
                io.add_key_event(each, is_down)
            self.still.pane.draw(draw, 3)
        return [*self.ran]


@pytest.fixture
def keyboard(tmp_path: Path) -> Iterator[Keyboard]:
    with open_still_editor(tmp_path, Graph()) as still, pytest.MonkeyPatch.context() as patch:
        yield Keyboard(still, patch)


@pytest.mark.parametrize("scope", SCOPES)
def test_the_keys_of_a_shortcut_run_its_action_once(keyboard: Keyboard, scope: str) -> None:
    """Where the mouse is over the panel of the scope."""
    editor = keyboard.still.editor
    editor.interface.walked_panel, editor.interface.pointed_panel = None, SCOPES[scope]
    editor.canvas.hovered, editor.viewer.hovered, editor.curves.hovered = (
        scope == name for name in ("graph", "viewer", "animation")
    )
    shortcuts = [(action, text) for action, text in editor.actions.list_shortcuts(scope) if action.scope == scope]
    assert len(shortcuts) > 3
    for action, text in shortcuts:
        ran = keyboard.press(text)
        assert ran[:1] == [action.id] and (action.repeats or len(ran) == 1), (text, ran)


COUNTERPARTS = (
    ("previous", "next"), ("left", "right"), ("up", "down"), ("first", "last"), ("in", "out"), ("undo", "redo"),
    ("brighter", "darker"), ("larger", "smaller"), ("earlier", "later"), ("upstream", "downstream"),
)  # fmt: skip
"""Words of actions that do the same in two directions."""


def test_actions_in_two_directions_have_keys_alike(keyboard: Keyboard) -> None:
    """Both repeat while their keys are held, or neither does, and they work in the same places."""
    actions = {action.id: action for action in keyboard.still.editor.actions.all}
    pairs = 0
    for one, other in COUNTERPARTS:
        for id, action in actions.items():
            if (twin := actions.get(re.sub(rf"(?<![a-z]){one}(?![a-z])", other, id))) not in (None, action):
                assert twin is not None
                pairs += 1
                for fact in ("menu", "scope", "contexts", "repeats"):
                    assert getattr(action, fact) == getattr(twin, fact), (id, twin.id, fact)
                assert bool(action.shortcut) == bool(twin.shortcut), (id, twin.id)
    assert pairs > 20


def test_shortcuts_of_other_panels_do_not_run(keyboard: Keyboard) -> None:
    editor = keyboard.still.editor
    known = {text for _, text in editor.actions.list_shortcuts("")}
    for scope, other in (("graph", "viewer"), ("viewer", "animation"), ("animation", "graph")):
        editor.interface.walked_panel = SCOPES[scope]
        own = {text for _, text in editor.actions.list_shortcuts(scope)} | known
        foreign = [text for action, text in editor.actions.list_shortcuts(other) if action.scope and text not in own]
        assert foreign
        for text in foreign:
            assert keyboard.press(text) == [], (scope, text)


@pytest.mark.parametrize("hovered", ["graph", "viewer", "animation"])
def test_keys_go_to_the_panel_that_the_mouse_was_over_last(keyboard: Keyboard, hovered: str) -> None:
    editor = keyboard.still.editor
    states = {"graph": editor.canvas, "viewer": editor.viewer, "animation": editor.curves}
    editor.interface.walked_panel = None
    for scope in (hovered, "", "graph" if hovered != "graph" else "viewer", hovered):
        for name, state in states.items():
            state.hovered = name == scope
        note_scope(editor)
        expected = scope or hovered
        assert editor.scope == expected, "it stays where the mouse is over none of them"
    editor.interface.walked_panel = PanelTitle.INSPECTOR
    note_scope(editor)
    assert editor.scope == hovered, "a panel without shortcuts of its own takes none away"


@pytest.mark.parametrize("over", ["dialog", "popup"])
def test_no_key_runs_an_action_over_a_dialog_or_a_menu(keyboard: Keyboard, over: str) -> None:
    editor = keyboard.still.editor
    assert keyboard.press("F1") and keyboard.press("Space") == ["time.play"]

    def open_menu() -> None:
        imgui.open_popup("menu")
        if imgui.begin_popup("menu"):
            imgui.text("words")
            imgui.end_popup()

    if over == "popup":
        keyboard.body = open_menu
        keyboard.still.pane.draw(open_menu, 2)
    else:
        editor.dialogs.open.add("about")
    for text in ("F1", "Ctrl+N", "Space"):
        assert keyboard.press(text) == [], text


def test_in_a_text_field_only_keys_that_no_text_takes_run(keyboard: Keyboard) -> None:
    """What was typed counts first: the field gives up the keyboard, and the action runs a frame later."""
    words, order = [""], list[str]()
    actions, code = keyboard.still.editor.actions, keyboard.still.editor.code
    patch: Any = SimpleNamespace(flush=lambda: order.append("flush"))

    def draw_field() -> None:
        imgui.set_keyboard_focus_here()
        words[0] = imgui.input_text("##field", words[0])[1]

    keyboard.body = draw_field
    everywhere = [text for action, text in actions.list_shortcuts("") if not action.scope]
    editing = {f"Ctrl+{name}" for name in ("A", "C", "V", "X", "Y", "Z", "Home", "End", "Delete", "LeftArrow")}
    keyboard.still.editor.code = patch
    try:
        for text in everywhere:
            keyboard.still.pane.draw(draw_field, 3)
            assert imgui.get_io().want_text_input
            name = text.split("+")[-1]
            takes = "Ctrl+" in text and text not in editing and f"Ctrl+{name}" not in editing
            takes |= name[0] == "F" and name[1:].isdigit()
            order.clear()
            ran = keyboard.press(text)
            if name not in ("Tab", "Space", "Enter", "Insert", "Backspace", "PageUp", "PageDown"):
                assert bool(ran) is takes, text
                assert order == ["flush"] * len(ran)
    finally:
        keyboard.still.editor.code = code


def test_space_plays_when_it_was_tapped_and_not_when_it_let_the_mouse_pan(keyboard: Keyboard) -> None:
    io, pane = imgui.get_io(), keyboard.still.pane
    assert keyboard.press("Space") == ["time.play"]
    io.add_key_event(imgui.Key.space, True)
    pane.draw(lambda: run_shortcuts(keyboard.still.editor), 2)
    keyboard.ran.clear()
    for button in (0, 1, 2):
        io.add_mouse_button_event(button, True)
        pane.draw(lambda: run_shortcuts(keyboard.still.editor), 2)
        io.add_mouse_button_event(button, False)
        io.add_key_event(imgui.Key.space, False)
        pane.draw(lambda: run_shortcuts(keyboard.still.editor), 2)
        assert keyboard.ran == []
        io.add_key_event(imgui.Key.space, True)
        pane.draw(lambda: run_shortcuts(keyboard.still.editor), 2)
