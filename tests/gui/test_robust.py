"""Faults in panels: the program goes on, says what is wrong, and the document can be saved."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from halation import document, presets
from halation.authoring.commands import SetValue
from halation.editor.problems.findings import list_problems
from halation.editor.shared.dialogs import Question
from halation.graph import Port
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui

LOOK = next(path for path in presets.paths() if path.stem == "agx_look")
STOPS = Port("tone", "exposure")

BEGUN: dict[str, Callable[[], object]] = {
    "window": lambda: imgui.begin("Another"),
    "child": lambda: imgui.begin_child("child"),
    "table": lambda: (imgui.begin_table("table", 3), imgui.table_next_column()),
    "popup": lambda: (imgui.open_popup("popup"), imgui.begin_popup("popup")),
    "modal": lambda: (imgui.open_popup("modal"), imgui.begin_popup_modal("modal")),
    "combo": lambda: imgui.begin_combo("combo", "one"),
    "tabs": lambda: (imgui.begin_tab_bar("bar"), imgui.begin_tab_item("tab")),
    "menu": lambda: imgui.begin_menu("menu"),
    "tooltip": lambda: imgui.begin_tooltip(),
    "tree": lambda: (imgui.set_next_item_open(True), imgui.tree_node("tree")),
    "group": lambda: imgui.begin_group(),
    "columns": lambda: imgui.columns(3),
    "disabled": lambda: imgui.begin_disabled(),
    "id": lambda: imgui.push_id("id"),
    "font": lambda: imgui.push_font(None, 30.0),
    "color": lambda: imgui.push_style_color(imgui.Col_.text, 0),
    "style": lambda: imgui.push_style_var(imgui.StyleVar_.alpha, 0.1),
    "clip": lambda: imgui.push_clip_rect(imgui.ImVec2(0, 0), imgui.ImVec2(4, 4), True),
    "width": lambda: imgui.push_item_width(10),
    "picker in a popup": lambda: (
        imgui.open_popup("pick"),
        imgui.begin_popup("pick"),
        imgui.color_picker4("picker", [1.0, 0.0, 0.0, 1.0]),
    ),
    "one in another": lambda: (
        imgui.begin_child("outer"),
        imgui.begin_table("inner", 2),
        imgui.table_next_column(),
        imgui.push_id(3),
        imgui.begin_child("innermost"),
        imgui.push_font(None, 9.0),
    ),
}


class Failing:
    """A panel that begins something and fails before it ends it."""

    def __init__(self) -> None:
        self.begin: Callable[[], object] | None = None

    def draw(self) -> None:
        imgui.text("here")
        if self.begin is not None:
            self.begin()
            raise ValueError("a bug")


@pytest.mark.parametrize("place", ["Inspector", "Messages"])
def test_a_panel_may_fail_anywhere(gui, tmp_path: Path, place: str) -> None:
    path = tmp_path / "look.json"

    def body(ui) -> None:
        panel = Failing()
        (ui.window._panels if place in ui.window._panels else ui.window._overlays)[place] = panel
        for number, (name, begin) in enumerate(BEGUN.items()):
            panel.begin = begin
            ui.wait(4)
            assert place in ui.editor.faults, name
            (found,) = [one for one in list_problems(ui.window._contexts.problems) if place in one.sentence]
            assert "ValueError: a bug" in found.detail, name
            panel.begin = None
            ui.editor.faults.clear()
            ui.wait(2)
            assert not ui.editor.faults, name
            ui.session.apply(SetValue(STOPS, number / 8))
            ui.session.files.save_as(path)
            assert document.load(path, sandbox=UNRESTRICTED).value(STOPS) == number / 8

    gui(body, LOOK, faulty=True)


def test_a_panel_that_failed_can_be_tried_again(gui) -> None:
    def body(ui) -> None:
        panel, good = Failing(), ui.window._panels["Inspector"]
        ui.window._panels["Inspector"], panel.begin = panel, BEGUN["child"]
        ui.wait(4)
        ui.window._panels["Inspector"] = good
        ui.wait(4)
        assert "Inspector" in ui.editor.faults, "it waits to be asked"
        ui.ctx.item_click("//Inspector/Try again")
        ui.wait(4)
        assert not ui.editor.faults

    gui(body, LOOK, faulty=True)


def test_a_dialog_that_fails_is_closed_and_keys_work_again(gui) -> None:
    def body(ui) -> None:
        ui.window._overlays["Question"] = panel = Failing()
        panel.begin = lambda: ui.editor.dialogs.question and BEGUN["modal"]()
        ui.editor.dialogs.question = Question("Sure?", "Is it?", (("Yes", bool), ("No", bool)))
        ui.wait(4)
        assert not ui.editor.dialogs.any
        before = ui.session.graph.value(STOPS)
        ui.session.apply(SetValue(STOPS, 2.5))
        ui.move("Graph")
        ui.keys("Ctrl+Z")
        assert ui.session.graph.value(STOPS) == before

    gui(body, LOOK, faulty=True)


def test_a_fault_in_an_action_or_while_rendering_is_told_and_nothing_else_happens(gui, monkeypatch) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError("a bug")

    def body(ui) -> None:
        before = ui.session.root
        ui.editor.log.attempt(broken)
        assert "ZeroDivisionError" in ui.editor.log.entries[-1].sentence and ui.editor.log.entries[-1].detail
        with monkeypatch.context() as patch:
            patch.setattr(ui.editor.preview, "work", broken)
            ui.wait(3)
            assert "Rendering" in ui.editor.faults
            ui.session.apply(SetValue(STOPS, 1.5))
            ui.wait(3)
        ui.settled()
        assert not ui.editor.faults and ui.editor.preview.find_whole_image("A") is not None
        ui.session.undo()
        assert ui.session.root == before

    gui(body, LOOK, faulty=True)


def test_a_fault_fails_a_test(gui) -> None:
    def body(ui) -> None:
        ui.window._panels["Inspector"] = panel = Failing()
        panel.begin = BEGUN["id"]
        ui.wait(4)

    with pytest.raises(AssertionError, match="the panel Inspector failed"):
        gui(body, LOOK)


def test_opengl_as_on_a_mac_will_do(gui, monkeypatch) -> None:
    monkeypatch.setenv("HALATION_TEST_FORM", "fragment")

    def body(ui) -> None:
        ui.settled()
        assert ui.window.device.target.form == "fragment"
        assert not ui.editor.preview.faults and ui.editor.preview.find_whole_image("A") is not None
        ui.session.apply(SetValue(STOPS, 1.5))
        ui.settled()
        left, top, right, bottom = map(int, ui.editor.places["viewer image"])
        assert ui.pixels()[top:bottom, left:right].std() > 20.0

    gui(body, LOOK)
