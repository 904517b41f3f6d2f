"""The window opens, shows a graph, and closes."""

from __future__ import annotations

from halation import presets


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
