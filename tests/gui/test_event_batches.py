"""All that is typed at once, between two frames: what follows the key that opens a field is the field's."""

from __future__ import annotations

from pathlib import Path

import pytest
from gui_events import Keyboard, Script, play
from halation import document, presets
from halation.authoring.edits.element_id import ElementId
from halation.editor.window.window import Window
from halation.resources.sandbox import UNRESTRICTED


@pytest.fixture
def look(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("HALATION_STATE", str(tmp_path / "state"))
    path = tmp_path / "look.json"
    document.save(document.load(presets.paths()[0], sandbox=UNRESTRICTED), path, sandbox=UNRESTRICTED)
    return path


def point_at(window: Window, keyboard: Keyboard, place: str, x: float = 0.5, y: float = 0.9) -> None:
    left, top, right, bottom = window.editor.places[place]
    keyboard.move(left + (right - left) * x, top + (bottom - top) * y)


def rest(window: Window, keyboard: Keyboard, frames: int = 12):
    """A question: whether the window has taken all events, and some frames have passed since."""
    since = [0]

    def is_at_rest() -> bool:
        since[0] = since[0] + 1 if keyboard.is_idle else 0
        return since[0] > frames

    return is_at_rest


@pytest.mark.parametrize(("chord", "node"), [("Tab", "blur"), ("Ctrl+P", "vignette"), ("Tab", "sharpen")])
def test_a_search_takes_what_is_typed_behind_its_key(tmp_path: Path, look: Path, chord: str, node: str) -> None:
    def script(window: Window, keyboard: Keyboard) -> Script:
        graph = window.editor.session.graph
        point_at(window, keyboard, "Graph")
        yield rest(window, keyboard)
        keyboard.press(chord)
        keyboard.type(node)
        keyboard.press("Enter")
        yield rest(window, keyboard)
        added = set(window.editor.session.graph.nodes) - set(graph.nodes)
        assert len(added) == 1 and node in added.pop()
        assert window.editor.session.history.steps[-1].startswith("Add") and not window.editor.dialogs.any

    play(script, tmp_path, look)


def test_a_path_behind_the_chord_that_asks_for_it(tmp_path: Path, look: Path) -> None:
    target = tmp_path / "elsewhere.json"

    def script(window: Window, keyboard: Keyboard) -> Script:
        point_at(window, keyboard, "Graph")
        yield rest(window, keyboard)
        graph = window.editor.session.graph
        keyboard.press("Ctrl+Shift+S")
        keyboard.press("Ctrl+A")
        keyboard.type(str(target))
        keyboard.press("Enter")
        yield rest(window, keyboard, 40)
        assert window.editor.session.graph == graph and target.exists()
        keyboard.press("Ctrl+O")
        keyboard.type(str(look))
        keyboard.press("Enter")
        keyboard.press("Tab")
        keyboard.type("vignette")
        keyboard.press("Enter")
        yield rest(window, keyboard, 40)
        assert window.editor.session.path == look and "vignette" in window.editor.session.graph.nodes

    play(script, tmp_path, look)


def test_a_new_name_behind_the_key_that_renames(tmp_path: Path, look: Path) -> None:
    def script(window: Window, keyboard: Keyboard) -> Script:
        session = window.editor.session
        node = next(iter(session.graph.nodes))
        session.select([ElementId(node)])
        point_at(window, keyboard, "Graph")
        yield rest(window, keyboard)
        keyboard.press("F2")
        keyboard.type("hm")
        keyboard.press("Enter")
        keyboard.press("M")
        yield rest(window, keyboard)
        assert "hm" in session.graph.nodes and node not in session.graph.nodes
        assert session.history.steps[-1].startswith("Mute")

    play(script, tmp_path, look)


def test_two_shortcuts_in_one_frame_both_run(tmp_path: Path, look: Path) -> None:
    def script(window: Window, keyboard: Keyboard) -> Script:
        session = window.editor.session
        session.select([ElementId(next(iter(session.graph.nodes)))])
        point_at(window, keyboard, "Graph")
        yield rest(window, keyboard)
        for key in "MHM":
            keyboard.press(key)
        yield rest(window, keyboard)
        assert len(session.history.steps) == 3

    play(script, tmp_path, look)
