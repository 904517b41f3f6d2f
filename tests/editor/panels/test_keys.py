"""Shortcuts as text and as chords of the window library."""

from __future__ import annotations

import pytest
from halation.editor.toolkit.keys import chord, display_shortcut, text
from halation.errors import UsageError
from imgui_bundle import imgui


@pytest.mark.parametrize("written", ["Ctrl+Shift+S", "F5", "1", "Home", "Ctrl+Comma", "Alt+X", "Shift+Delete", "M"])
def test_text_and_back(written: str) -> None:
    assert text(chord(written)) == written


def test_a_chord_is_what_the_library_wants() -> None:
    assert chord("Ctrl+Z") == int(imgui.Key.mod_ctrl) | int(imgui.Key.z)
    assert chord("LeftBracket") == int(imgui.Key.left_bracket)


def test_one_chord_has_one_text() -> None:
    assert text(chord("Shift+Ctrl+S")) == text(chord("Ctrl+Shift+S")) == "Ctrl+Shift+S"


@pytest.mark.parametrize("wrong", ["", "Ctrl", "Ctrl+", "Ctrl+Ctrl+A", "Meta+A", "ctrl+a", "LeftCtrl", "MouseLeft"])
def test_what_is_no_shortcut(wrong: str) -> None:
    with pytest.raises(UsageError, match="is no shortcut; write it like"):
        chord(wrong)


def test_people_read_signs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    assert [display_shortcut(one) for one in ("Ctrl+Comma", "Shift+LeftBracket", "F1", "")] == [
        "Ctrl+,",
        "Shift+[",
        "F1",
        "",
    ]
    monkeypatch.setattr("sys.platform", "darwin")
    assert display_shortcut("Ctrl+S") == "Cmd+S"
