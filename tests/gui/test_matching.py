"""The window that finds values which make the picture like a reference."""

from __future__ import annotations

import json
from pathlib import Path

import halation as hal
import numpy as np
import pytest
from gui_driver import Ui
from halation.authoring.commands import AddNode
from halation.authoring.edits.element_id import ElementId
from halation.graph import Port
from imgui_bundle import imgui

STOPS = 0.8
"""What the reference was made with; the document has none."""


GRAPH = {
    "halation": 1,
    "inputs": {"light": {"type": "Image", "file": "light.exr"}},
    "nodes": {"expose": {"type": "exposure"}, "grade": {"type": "saturation"}},
    "outputs": {"image": {"type": "Image"}},
    "links": {"expose.image": "inputs.light", "grade.image": "expose.out", "outputs.image": "grade.out"},
}


@pytest.fixture
def reference(tmp_path: Path) -> tuple[Path, Path]:
    """A graph, and the picture that it makes with a brighter exposure."""
    graph, target = tmp_path / "graph.json", tmp_path / "reference.exr"
    light = np.random.default_rng(7).uniform(0.0, 1.0, (54, 96, 3)).astype(np.float32)
    hal.write(tmp_path / "light.exr", light)
    hal.write(target, light * np.float32(2.0**STOPS))
    graph.write_text(json.dumps(GRAPH))
    return graph, target


def open_match(ui: Ui, reference: Path, patterns: str) -> None:
    ui.settled()
    ui.window._contexts.dialogs.actions.run("file.match")
    ui.wait(4)
    ui.click("match reference")
    ui.wait(2)
    browse, ui.editor.dialogs.browse = ui.editor.dialogs.browse, None
    browse.then(reference)
    ui.click("match values")
    ui.type(patterns)
    ui.wait(3)


def test_values_follow_the_search_and_are_one_step(gui, reference) -> None:
    graph, target = reference

    def body(ui: Ui) -> None:
        open_match(ui, target, "expose.stops")
        window, root, steps = ui.window._overlays["Match"], ui.session.root, ui.session.history.position
        assert window._search.count_numbers(window._patterns) == (1, "")
        ui.shot("match.png")
        ui.click("match start")
        ui.until(lambda: window._search.outcome is not None, seconds=100)
        ui.wait(4)
        assert not window._search.outcome.fault
        ui.shot("match_found.png")
        assert ui.session.root.value(Port("expose", "stops")) == pytest.approx(STOPS, abs=0.02)
        assert ui.session.history.position == steps + 1
        ui.click("match keep")
        ui.wait(2)
        ui.session.undo()
        assert ui.session.root == root

    gui(body, graph)


def test_values_are_put_back_and_faults_are_said(gui, reference) -> None:
    graph, target = reference

    def body(ui: Ui) -> None:
        open_match(ui, target, "expose.stop")
        window, root = ui.window._overlays["Match"], ui.session.root
        count, fault = window._search.count_numbers(window._patterns)
        assert count == 0 and "did you mean 'expose.stops'" in fault
        ui.click("match start")
        ui.wait(2)
        assert not window._search.is_open, "there is nothing to look for"
        ui.click("match values")
        ui.type("expose.*, grade.*")
        ui.wait(3)
        ui.click("match start")
        ui.until(lambda: window._search.outcome is not None, seconds=100)
        ui.wait(3)
        assert ui.session.root != root
        ui.click("match back")
        ui.wait(3)
        assert ui.session.root == root and not window._search.is_open

    gui(body, graph)


def test_controls_are_what_is_matched_and_the_window_grows_upwards(gui, reference, tmp_path: Path) -> None:
    _, target = reference
    graph = tmp_path / "controlled.json"
    graph.write_text(json.dumps(GRAPH | {"controls": {"brighter": {"target": "expose.stops"}}}))

    def body(ui: Ui) -> None:
        ui.settled()
        ui.window._contexts.dialogs.actions.run("file.match")
        ui.wait(4)
        window = ui.window._overlays["Match"]
        assert window._patterns == "brighter" and window._search.count_numbers("brighter") == (1, "")
        bottom = ui.ask(find_bottom)
        window._reference = target
        ui.wait(3)
        ui.click("match start")
        ui.until(lambda: window._search.outcome is not None, seconds=100)
        ui.wait(4)
        assert ui.ask(find_bottom) <= bottom + 1.0
        ui.click("match back")

    gui(body, graph)


def find_bottom() -> float:
    """The lower border of the window."""
    window = next(window for window in imgui.get_current_context().windows if window.name.endswith("###match"))
    return window.pos.y + window.size.y


def test_escape_closes_the_window_but_not_out_of_a_field(gui, reference) -> None:
    def body(ui: Ui) -> None:
        open_match(ui, reference[1], "expose.stops")
        ui.click("match values")
        ui.keys("Escape")  # leaves the field
        ui.wait(2)
        assert ui.editor.dialogs.matches
        ui.click("match way")
        ui.wait(2)
        ui.keys("Escape")  # closes the list
        ui.wait(2)
        assert ui.editor.dialogs.matches
        ui.keys("Escape")
        ui.wait(2)
        assert not ui.editor.dialogs.matches

    gui(body, reference[0])


def test_a_selected_node_without_numbers_is_not_proposed(gui, reference) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        luminance = ui.session.apply(AddNode("unpremultiply"))
        ui.session.select([ElementId(luminance)])
        ui.window._contexts.dialogs.actions.run("file.match")
        ui.wait(4)
        assert ui.window._overlays["Match"]._patterns == "*.*"

    gui(body, reference[0])
