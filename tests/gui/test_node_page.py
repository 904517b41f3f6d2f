"""The page of a node inside the editor."""

from __future__ import annotations

from gui_driver import Ui
from halation import presets
from halation.authoring.edits.element_id import ElementId
from halation.editor.dialogs.node_page import describe_item, find_picture_before
from halation.editor.dialogs.panel_page import PARAGRAPHS
from halation.editor.shared.window_commands import PanelTitle
from halation.graph import Graph, Port, signature
from halation.nodes import catalogue
from halation.reference.node_page import find_main_value, list_steps

BLOOM = next(path for path in presets.paths() if path.stem == "soft_bloom")


def test_the_page_of_the_selected_node_with_pictures_before_and_after(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        ui.session.select([])
        ui.move("Graph", (0.5, 0.9))
        ui.keys("F1")
        ui.until(lambda: "dialog Panel" in ui.editor.places)
        assert ui.editor.dialogs.page == "Graph"
        ui.keys("Escape")
        ui.wait(3)
        assert not ui.editor.dialogs.any
        ui.session.select([ElementId("bloom")])
        ui.settled()
        ui.until(lambda: {"bloom", "inputs.beauty"} <= ui.editor.preview.thumbnails)
        ui.keys("F1")
        ui.until(lambda: "dialog Node" in ui.editor.places)
        ui.wait(3)
        before, after = ui.editor.places["picture Before"], ui.editor.places["picture After"]
        assert before[2] < after[0] and before[3] - before[1] > 100.0
        strip = ui.editor.strip
        assert strip.numbers == tuple(list_steps(find_main_value(catalogue()["bloom"])))
        ui.until(lambda: all(strip.find(index) for index in range(len(strip.numbers))))
        ui.wait(2)
        assert ui.editor.places["strip 0"][2] < ui.editor.places["strip 1"][0]
        ui.shot("node_page.png")
        ui.move("dialog Node", (0.5, 0.5))
        ui.wheel(-50.0)
        ui.wait(3)
        timer = ui.editor.node_timer
        ui.click("measure node")
        ui.until(lambda: timer.is_measuring)
        ui.keys("Escape")
        ui.wait(3)
        assert not ui.editor.dialogs.any and not timer.is_measuring and not timer.seconds
        ui.keys("F1")
        ui.until(lambda: "dialog Node" in ui.editor.places)
        ui.wait(3)
        ui.move("dialog Node", (0.5, 0.5))
        ui.wheel(-50.0)
        ui.wait(3)
        ui.click("measure node")
        ui.until(lambda: bool(timer.seconds))
        ui.wait(3)
        assert timer.seconds[catalogue()["bloom"]] > 0.0 and not timer.fault
        ui.shot("node_page_end.png")
        ui.keys("Escape")
        ui.wait(3)
        assert not ui.editor.dialogs.any

    gui(body, BLOOM)


def test_every_node_has_a_page() -> None:
    for type in catalogue().values():
        node = type()
        assert describe_item(node), type.id
        graph = Graph().add("source", catalogue()["checker"]()).add("node", node)
        face = signature(node)
        assert find_picture_before(graph, "node", face) == ""
        if "image" in face.unfolded_inputs:
            linked = graph.connect(Port("source", "out"), Port("node", "image"))
            assert find_picture_before(linked, "node", face) == "source"


def test_the_page_of_the_panel_under_the_pointer(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        ui.session.select([ElementId("bloom")])
        for title, name in ((PanelTitle.RENDERS, "Panel"), (PanelTitle.SCOPES, "Panel"), (PanelTitle.VIEWER, "Node")):
            ui.editor.commands.show_panel(title)
            ui.until(lambda title=title: title in ui.editor.places)
            ui.move(title, (0.5, 0.6))
            ui.keys("F1")
            ui.until(lambda name=name: f"dialog {name}" in ui.editor.places)
            assert name == "Node" or ui.editor.dialogs.page == title
            ui.keys("Escape")
            ui.wait(3)
            assert not ui.editor.dialogs.any

    gui(body, BLOOM)


def test_every_panel_has_a_page() -> None:
    missing = [title.value for title in PanelTitle if title not in PARAGRAPHS]
    assert not missing, f"F1 has no page for {missing}: add it to PARAGRAPHS in app/editor/dialogs/panel_page.py"
