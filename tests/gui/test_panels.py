"""Panels and dialogs in the real window, by mouse and keyboard."""

from __future__ import annotations

import shutil
from functools import partial
from pathlib import Path

import pytest
from halation import presets
from halation.authoring.commands import Disconnect, SetValue
from halation.editor.shared.dialogs import Question
from halation.graph import Port

PRESET = next(path for path in presets.paths() if path.stem == "soft_bloom")


@pytest.fixture
def look(tmp_path: Path) -> Path:
    """A preset in a folder of its own, with the picture that it reads."""
    shutil.copytree(PRESET.parent / "samples", tmp_path / "samples")
    return Path(shutil.copy(PRESET, tmp_path / "look.json"))


def tab(ui, title: str) -> None:
    """Bring a docked panel to the front."""
    ui.ctx.window_focus(f"//{title}")
    ui.wait()


def test_the_palette_runs_an_action(gui) -> None:
    def body(ui) -> None:
        ui.keys("Ctrl+P")
        ui.type("light th", enter=False)
        ui.shot("palette.png")
        ui.keys("Enter")
        assert not ui.editor.dialogs.any
        assert ui.editor.store.current.theme == "light"
        ui.keys("Ctrl+P")
        ui.type("gb", enter=False)
        ui.keys("DownArrow")
        ui.keys("UpArrow")
        ui.keys("Enter")
        assert "gaussian_blur" in {node.id for node in ui.session.graph.nodes.values()}
        ui.keys("Ctrl+P")
        ui.keys("Escape")
        assert not ui.editor.dialogs.any

    gui(body, PRESET)


def test_a_click_in_the_history_goes_there(gui) -> None:
    def body(ui) -> None:
        before = ui.session.graph
        ui.session.apply(SetValue(Port("bloom", "intensity"), 0.5))
        ui.session.apply(SetValue(Port("bloom", "intensity"), 0.9))
        tab(ui, "History")
        ui.shot("history.png")
        ui.click("history 0")
        assert ui.session.graph == before
        ui.click("history 1")
        assert ui.session.graph.value(Port("bloom", "intensity")) == 0.5

    gui(body, PRESET)


def test_a_click_on_a_problem_selects_the_node(gui) -> None:
    def body(ui) -> None:
        tab(ui, "Problems")
        assert "problem 0" not in ui.editor.places
        ui.session.apply(Disconnect(Port("bloom", "image")))
        ui.until(lambda: "problem 0" in ui.editor.places)
        ui.shot("problems.png")
        ui.click("problem 0")
        assert ui.session.selection == {"bloom"}

    gui(body, PRESET)


def test_a_panel_that_fails_is_listed_with_its_details(gui) -> None:
    def body(ui) -> None:
        ui.editor.faults["Viewer"] = "Traceback: the details"
        tab(ui, "Problems")
        assert "problem 0" in ui.editor.places
        ui.click("detail 0", fraction=(0.1, 0.5))
        ui.click("copy detail 0")
        assert ui.editor.clipboard.get() == "Traceback: the details"
        ui.editor.faults.clear()

    gui(body, PRESET)


def test_a_shortcut_that_is_taken_is_offered(gui) -> None:
    def body(ui) -> None:
        ui.keys("Ctrl+Comma")
        ui.click("page Shortcuts")
        ui.click("shortcut file.new")
        ui.keys("Ctrl+O")
        assert ui.editor.store.current.shortcuts == {}
        assert ui.editor.dialogs.browse is None
        ui.shot("conflict.png")
        ui.click("take over")
        assert dict(ui.editor.store.current.shortcuts) == {"file.new": "Ctrl+O", "file.open": ""}
        ui.click("shortcut file.new")
        ui.keys("Escape")
        assert "preferences" in ui.editor.dialogs.open
        ui.click("shortcut file.new")
        ui.keys("F7")
        assert ui.editor.store.current.shortcuts["file.new"] == "F7"
        ui.click("reset shortcuts")
        assert ui.editor.store.current.shortcuts == {}
        ui.keys("Escape")
        assert not ui.editor.dialogs.any

    gui(body, PRESET)


def test_preferences_hold_at_once(gui) -> None:
    def body(ui) -> None:
        ui.keys("Ctrl+Comma")
        ui.click("theme light", fraction=(0.1, 0.5))
        assert ui.editor.store.current.theme == "light"
        ui.click("preference thumbnails", fraction=(0.1, 0.5))
        assert not ui.editor.store.current.thumbnails
        ui.click("page System")
        ui.shot("system.png")
        ui.click("preference autosave", keys="Ctrl")
        ui.type("2")
        assert ui.editor.store.current.autosave == 2.0
        assert ui.editor.recovery.interval == 2.0
        ui.click("reset preferences")
        assert ui.editor.store.current.theme == "dark"
        assert ui.editor.recovery.interval == 5.0
        ui.click("close preferences")
        assert not ui.editor.dialogs.any

    gui(body, PRESET)


@pytest.mark.parametrize(("theme", "scale"), [("dark", 1.0), ("light", 2.0)])
def test_every_dialog_opens_and_escape_closes_it(gui, theme: str, scale: float) -> None:
    def body(ui) -> None:
        for name in ("shortcuts", "preferences", "about", "palette", "start"):
            ui.editor.dialogs.open.add(name)
            ui.wait(4)
            ui.shot(f"{name}_{theme}.png")
            ui.keys("Escape")
            assert not ui.editor.dialogs.any, name
        assert ui.editor.faults == {}

    gui(body, PRESET, likes={"theme": theme, "ui_scale": scale})


def test_questions_are_answered_by_click_and_key(gui, look: Path) -> None:
    def body(ui) -> None:
        ui.session.apply(SetValue(Port("bloom", "intensity"), 0.5))
        ui.keys("Ctrl+N")
        assert ui.editor.dialogs.question is not None
        ui.shot("question.png")
        ui.keys("Escape")
        assert ui.editor.dialogs.question is None
        assert ui.session.dirty
        ui.keys("Ctrl+N")
        ui.click("answer 1")
        assert ui.session.graph.nodes == {}

    gui(body, look)


def test_enter_takes_the_answer_in_the_focus_ring(gui) -> None:
    def body(ui) -> None:
        answers: list[str] = []
        names = ("Replace", "Keep both", "Cancel")
        question = Question("Replace?", "It is there.", tuple((name, partial(answers.append, name)) for name in names))
        for keys, answer in (
            (["Enter"], "Replace"),
            (["RightArrow", "Enter"], "Keep both"),
            (["RightArrow", "RightArrow", "Enter"], "Cancel"),
            (["RightArrow", "LeftArrow", "Enter"], "Replace"),
            (["Tab", "Tab", "KeypadEnter"], "Cancel"),
            (["RightArrow", "Space"], "Keep both"),
            (["RightArrow", "Escape"], "Cancel"),
        ):
            answers.clear()
            ui.editor.dialogs.question = question
            ui.wait(3)
            for key in keys:
                ui.keys(key)
            ui.wait(2)
            assert (keys, answers) == (keys, [answer])

    gui(body, PRESET)


def test_messages_make_room_for_the_search(gui) -> None:
    def body(ui) -> None:
        ui.editor.log.add("saved", "info")
        ui.wait(3)
        before = ui.editor.places["toast 0"]
        ui.move("Graph", (0.97, 0.8))
        ui.wait(2)
        ui.keys("Tab")
        ui.wait(3)
        search, toast = ui.editor.places["search field"], ui.editor.places["toast 0"]
        assert search[2] > before[0]
        assert toast[0] >= 0.0 and toast[2] < search[0]
        ui.shot("toast_beside_search.png")
        ui.keys("Escape")
        ui.wait(3)
        assert ui.editor.places["toast 0"] == before

    gui(body, PRESET)


def test_messages_cover_no_button_of_a_dialog(gui) -> None:
    def body(ui) -> None:
        ui.editor.log.add("saved", "info")
        ui.wait(3)
        before = ui.editor.places["toast 0"]
        ui.keys("Shift+F1")  # nearly as wide as the window
        ui.wait(3)
        assert "toast 0" not in ui.editor.places
        ui.editor.log.add("the disk is full", "error")
        ui.wait(3)
        assert "toast 0" in ui.editor.places and "toast 1" not in ui.editor.places
        ui.editor.log.entries.pop()
        ui.keys("Escape")
        ui.wait(3)
        assert ui.editor.places["toast 0"] == before

    gui(body, PRESET)


def test_messages_show_up_and_go_at_a_click(gui) -> None:
    def body(ui) -> None:
        ui.editor.log.add("the first", "warning")
        ui.editor.log.add("the second", "error")
        ui.wait(4)
        ui.shot("toasts.png")
        assert {"toast 0", "toast 1"} <= ui.editor.places.keys()
        ui.click("toast 0")
        assert "toast 1" not in ui.editor.places
        tab(ui, "Log")
        ui.click("log error")
        assert "log entry 0" in ui.editor.places
        assert "log entry 1" not in ui.editor.places
        ui.click("clear log")
        assert not ui.editor.log.entries

    gui(body, PRESET)


def test_the_start_screen_opens_a_preset(gui) -> None:
    def body(ui) -> None:
        assert "start" in ui.editor.dialogs.open
        ui.shot("start_screen.png")
        ui.click("preset agx_look")
        assert "punch" in ui.session.graph.nodes
        assert ui.session.path is None
        assert not ui.editor.dialogs.any
        ui.settled()
        assert not ui.editor.preview.faults

    gui(body)


def test_recent_files_are_offered_and_forgotten(gui, look: Path) -> None:
    def first(ui) -> None:
        ui.editor.store.note_opened(look.parent / "gone.json")

    def second(ui) -> None:
        assert [Path(one.path).name for one in ui.editor.store.current.recent] == ["gone.json", "look.json"]
        ui.shot("start.png")
        ui.click("recent 0")
        assert "start" in ui.editor.dialogs.open
        ui.move("recent 0")
        ui.wait(2)
        ui.click("forget 0")
        ui.click("recent 0")
        assert ui.session.path == look

    gui(first, look)
    gui(second)


def test_unsaved_work_is_offered_again(gui, look: Path, tmp_path: Path) -> None:
    def crash(ui) -> None:
        ui.session.apply(SetValue(Port("bloom", "intensity"), 0.875))
        ui.wait()
        ui.editor.recovery.close(keep=True)

    def again(ui) -> None:
        ui.shot("recover.png")
        ui.click("recover 0")
        assert ui.session.graph.value(Port("bloom", "intensity")) == 0.875
        assert ui.session.path == look
        assert ui.session.dirty
        assert not ui.editor.dialogs.any

    gui(crash, look)
    gui(again)


def test_a_render_from_the_form(gui, look: Path) -> None:
    def body(ui) -> None:
        tab(ui, "Renders")
        ui.shot("renders.png")
        ui.click("render")
        (export,) = ui.editor.exports.all
        ui.until(lambda: export.state != "running", 60)
        assert (export.state, export.failure) == ("done", "")
        assert (look.parent / "look.exr").is_file()
        ui.click("copy path 0")
        assert ui.editor.clipboard.get() == str(look.parent / "look.exr")
        ui.click("clear renders")
        assert ui.editor.exports.all == ()

    gui(body, look)


def test_the_passes_of_the_viewer_are_cards_and_a_click_selects_their_nodes(gui) -> None:
    def body(ui) -> None:
        tab(ui, "Passes")
        ui.until(lambda: "pass 2" in ui.editor.places)
        ui.shot("passes.png")
        assert ui.editor.passes.passes[0].reads == ("neon.exr Combined",)
        ui.click("pass 1")
        assert ui.session.selection == {"bloom"}
        revision = ui.editor.passes.revision
        ui.session.apply(SetValue(Port("bloom", "radius"), 0.02))
        ui.until(lambda: ui.editor.passes.revision > revision)
        ui.session.files.new()  # the viewer shows nothing now
        ui.until(lambda: not ui.editor.passes.passes)

    gui(body, PRESET)
