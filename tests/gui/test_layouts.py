"""Layouts of panels by task: each shows what it is for, and all of it fits into the window."""

from __future__ import annotations

from gui_driver import Ui
from halation import presets
from halation.editor.shared.window_commands import PanelTitle
from halation.editor.window.layouts import LAYOUTS, find_panel


def overlap(first: tuple[float, ...], second: tuple[float, ...]) -> bool:
    return (
        min(first[2], second[2]) - max(first[0], second[0]) > 2
        and min(first[3], second[3]) - max(first[1], second[1]) > 2
    )


def test_each_layout_shows_its_panels_side_by_side(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        for number, (name, layout) in enumerate(LAYOUTS.items(), 1):
            ui.keys(f"Ctrl+F{number}")
            ui.wait(25)
            shown = {title: ui.editor.places[title] for title in PanelTitle if title in ui.editor.places}
            assert set(layout.front) <= shown.keys(), name
            panels = list(shown.values())
            assert not any(overlap(a, b) for i, a in enumerate(panels) for b in panels[:i]), name
            for left, top, right, bottom in panels:
                assert right - left > 150 and bottom - top > 100, (name, shown)
            for title in PanelTitle:
                assert find_panel(ui.window.params, title).is_visible == (title not in layout.hidden), (name, title)
            ui.shot(f"layout_{name}.png")
        beside = LAYOUTS["beside"]
        assert beside.find_dock(PanelTitle.GRAPH, "Lower") == "Lower"
        ui.keys("Ctrl+F2")
        ui.wait(25)
        viewer, graph = ui.editor.places["Viewer"], ui.editor.places["Graph"]
        assert graph[0] >= viewer[2] - 3 and abs(graph[1] - viewer[1]) < 3

    gui(body, presets.paths()[0])


def test_a_hidden_panel_comes_back_where_its_dock_is(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        ui.keys("Ctrl+F5")
        ui.wait(25)
        assert "Graph" not in ui.editor.places
        ui.editor.commands.show_panel(PanelTitle.GRAPH)
        ui.wait(10)
        left, top, right, bottom = ui.editor.places["Graph"]
        assert right - left > 150 and bottom - top > 100
        ui.editor.actions.run("view.reset_layout")
        ui.wait(25)
        assert {"Viewer", "Graph", "Inspector", "Scopes"} <= ui.editor.places.keys()

    gui(body, presets.paths()[0])
