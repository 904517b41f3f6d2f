"""The window opens, shows a graph, and closes."""

from __future__ import annotations

from halation import presets
from imgui_bundle import imgui


def test_opens_a_graph_and_shows_its_picture(gui) -> None:
    path = presets.paths()[0]

    def body(ui) -> None:
        ui.settled()
        assert ui.session.path == path
        shown = ui.editor.preview.find_whole_image("A")
        assert shown is not None and shown.full_size[0] > 100
        assert ui.pixels().std() > 5

    gui(body, path)


def test_starts_without_a_graph(gui) -> None:
    def body(ui) -> None:
        assert "start" in ui.editor.dialogs.open
        assert ui.session.graph.nodes == {}

    gui(body)


def test_keys_go_to_the_start_screen_whatever_took_the_focus(gui) -> None:
    """On a real display the bars of the window appear after it, and take the focus."""

    def body(ui) -> None:
        ui.ask(lambda: imgui.set_window_focus("Viewer"))
        ui.wait(2)
        ui.keys("Escape")
        assert "start" not in ui.editor.dialogs.open

    gui(body)
