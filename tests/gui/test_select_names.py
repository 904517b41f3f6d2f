"""Pictures that are chosen by name in the inspector."""

from __future__ import annotations

from pathlib import Path

from gui_canvas import show
from gui_driver import Ui
from halation import document
from halation.authoring.commands import SetValue
from halation.authoring.edits.element_id import ElementId
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind
from halation.nodes.input.constant import Constant
from halation.nodes.merge.select import Select
from halation.resources.sandbox import UNRESTRICTED

CHOICE = Port("pick", "choice")


def make_graph() -> Graph:
    graph = Graph(settings=Settings((32, 18))).add("pick", Select(names="day, night"))
    for socket in "ab":
        graph = graph.add(socket, Constant()).connect(Port(socket, "out"), Port("pick", socket))
    return graph.add_output("image", Output(Kind.IMAGE)).connect(Port("pick", "out"), Port("outputs", "image"))


def test_a_name_is_chosen_from_the_list(gui, tmp_path: Path) -> None:
    document.save(make_graph(), tmp_path / "graph.json", sandbox=UNRESTRICTED)

    def body(ui: Ui) -> None:
        ui.session.select([ElementId("pick")])
        ui.settled()
        ui.click("field pick.choice")
        ui.settled()
        ui.shot("names.png")
        ui.keys("N")
        ui.keys("Enter")
        ui.settled()
        assert ui.session.graph.value(CHOICE) == "night"
        ui.session.apply(SetValue(Port("pick", "names"), "day, dusk"))
        ui.settled()
        ui.shot("names_gone.png")
        for _ in range(2):
            ui.keys("Ctrl+Z")
        assert ui.session.graph.value(CHOICE) == ""

    gui(body, tmp_path / "graph.json")


def test_a_name_is_chosen_on_the_node(gui) -> None:
    def body(ui: Ui) -> None:
        show(ui, make_graph(), 0.5)
        ui.shot("on_node.png")
        ui.move("widget pick.choice")
        ui.wait(2)
        ui.click("widget pick.choice")
        ui.until(lambda: "choice night" in ui.editor.places)
        ui.wait(2)
        ui.click("choice night")
        ui.until(lambda: ui.session.graph.value(CHOICE) == "night")

    gui(body)
