"""A panel that fails is told once, closes what it has begun, and does not end the program."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from halation.editor.window.guard import draw_failure, draw_guarded
from imgui_bundle import imgui
from still_editor import StillEditor, open_still_editor


@pytest.fixture
def still(tmp_path) -> Iterator[StillEditor]:
    with open_still_editor(tmp_path) as still:
        yield still


def fail() -> None:
    imgui.begin_group()
    raise ValueError("out of ink")


def test_a_failure_is_told_once_and_gone_when_the_panel_draws_again(still) -> None:
    editor, answers = still.editor, list[bool]()
    for draw in (fail, fail, lambda: imgui.text("fine"), fail):
        imgui.new_frame()
        imgui.begin("pane")
        answers.append(draw_guarded(editor, "Scopes", draw))
        assert ("Scopes" in editor.faults) != answers[-1]
        if not answers[-1]:
            assert "out of ink" in editor.faults["Scopes"] and "Traceback" in editor.faults["Scopes"]
        imgui.end()
        imgui.end_frame()
    assert answers == [False, False, True, False]
    entries = [(entry.sentence, entry.level) for entry in editor.log.entries]
    sentence = "the panel Scopes failed (ValueError: out of ink); the document is safe"
    assert {*entries} == {(sentence, "error")} and 1 <= len(entries) <= 2
    assert "Traceback" in editor.log.entries[0].detail


def test_try_again_forgets_the_failure(still) -> None:
    still.editor.faults["Scopes"] = "Traceback"
    pane = still.pane

    def draw() -> None:
        draw_failure(still.editor, "Scopes")

    pane.draw(draw, 2)
    assert any("Scopes could not be drawn" in text for text in pane.list_texts())
    (button,) = [widget for widget in pane.widgets if widget.kind == "button"]
    pane.click((*button.points[0], *button.points[1]), draw)
    assert "Scopes" not in still.editor.faults
