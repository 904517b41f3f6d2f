"""Gizmos on the picture, dragged by the mouse: the frame of a transform, a rectangle, lengths and angles."""

from __future__ import annotations

from pathlib import Path

import pytest
from gui_driver import Ui
from halation import document
from halation.authoring.edits.element_id import ElementId
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind, Node, catalogue
from halation.resources.sandbox import UNRESTRICTED

SIZE = (320, 180)


def save_graph(folder: Path, type: str, **values: object) -> Path:
    """A checkerboard through one node."""
    node: Node = catalogue()[type](**values)
    graph = Graph(settings=Settings(SIZE), outputs={"image": Output(Kind.IMAGE)})
    graph = graph.add("board", catalogue()["checker"]()).add("node", node)
    graph = graph.connect(Port("board", "out"), Port("node", "image"))
    graph = graph.connect(Port("node", "out"), Port("outputs", "image"))
    document.save(graph, folder / "graph.json", sandbox=UNRESTRICTED)
    return folder / "graph.json"


def start(ui: Ui) -> None:
    ui.session.select([ElementId("node")])
    ui.settled()


def at(ui: Ui, x: float, y: float) -> tuple[float, float]:
    """A point of the picture, by fractions."""
    left, top, right, bottom = ui.editor.places["viewer image"]
    return left + x * (right - left), top + y * (bottom - top)


def beside(ui: Ui, place: str, x: float, y: float) -> tuple[float, float]:
    """A point at a distance from a grip, in fractions of the picture: grips at the border of the panel are moved in."""
    left, top, right, bottom = ui.editor.places["viewer image"]
    grip = ui.at(place)
    return grip[0] + x * (right - left), grip[1] + y * (bottom - top)


def value(ui: Ui, name: str):
    return ui.session.graph.value(Port("node", name))


def test_the_frame_of_a_transform_is_moved_scaled_turned_and_skewed(gui, tmp_path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        ui.drag("handle node.scale se", beside(ui, "handle node.scale se", -0.1, -0.15))
        assert value(ui, "scale") == pytest.approx((0.8, 0.7), abs=0.02)
        ui.drag("handle node.position move", beside(ui, "handle node.position move", -0.1, 0.1))
        assert value(ui, "position") == pytest.approx((-32.0, 18.0), abs=1.5)
        ui.drag("handle node.position move", beside(ui, "handle node.position move", 0.105, -0.105))
        assert value(ui, "position") == (0.0, 0.0)
        ui.shot("gizmo_transform.png")
        before = value(ui, "skew")
        x, y = ui.at("handle node.skew x")
        ui.drag("handle node.skew x", (x + 30.0, y))
        assert value(ui, "skew")[0] < before[0] and value(ui, "skew")[1] == before[1]
        x, y = ui.at("handle node.rotation turn")
        ui.drag("handle node.rotation turn", (x + 60.0, y + 10.0))
        assert value(ui, "rotation") > 5.0
        ui.shot("gizmo_turned.png")
        assert len(ui.session.history.steps) == 5
        ui.drag("handle node.scale ne", at(ui, 0.2, 0.2), release=False)
        ui.keys("Escape")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert value(ui, "scale") == pytest.approx((0.8, 0.7), abs=0.02)

    gui(body, save_graph(tmp_path, "transform"))


def test_a_crop_is_a_rectangle_also_over_its_own_result(gui, tmp_path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        ui.drag("handle node.bottom_right se", beside(ui, "handle node.bottom_right se", -0.5, -0.25), release=False)
        assert value(ui, "bottom_right") == (1.0, 1.0)  # the picture would run away under the mouse
        ui.shot("gizmo_crop.png")
        ui.ctx.mouse_up(0)
        ui.settled()
        assert value(ui, "bottom_right") == pytest.approx((0.5, 0.75), abs=0.01)
        assert ui.editor.viewer.picture == (160, 135)
        ui.drag("handle node.top_left nw", beside(ui, "handle node.top_left nw", 0.5, 0.2))
        ui.settled()
        assert value(ui, "top_left") == pytest.approx((0.25, 0.15), abs=0.01)
        ui.session.undo()
        ui.settled()
        assert value(ui, "top_left") == (0.0, 0.0) and value(ui, "bottom_right") == pytest.approx((0.5, 0.75), abs=0.01)

    gui(body, save_graph(tmp_path, "crop"))


def test_lengths_and_angles_have_grips_around_their_place(gui, tmp_path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        radius, angle = value(ui, "radius"), value(ui, "angle")
        x, y = ui.at("handle node.radius")
        ui.drag("handle node.radius", (x + 26.0, y + 15.0))
        assert value(ui, "radius") > radius
        ui.shot("gizmo_swirl.png")
        ui.drag("handle node.angle", at(ui, 0.5, 0.95))
        assert value(ui, "angle") == pytest.approx(90.0, abs=0.1) and angle == 180.0
        ui.keys("Ctrl+Z")
        assert value(ui, "angle") == 180.0
        ui.drag("handle node.center", at(ui, 0.335, 0.66))
        assert value(ui, "center") == pytest.approx((1 / 3, 2 / 3), abs=1e-4)

    gui(body, save_graph(tmp_path, "swirl"))


def test_ctrl_switches_snapping_off(gui, tmp_path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        target = at(ui, 0.336, 0.664)
        ui.move("handle node.center")
        ui.ctx.mouse_down(0)
        ui.ctx.mouse_lift_drag_threshold(0)
        with ui.held("Ctrl"):
            ui.move(target)
            ui.wait(2)
            ui.ctx.mouse_up(0)
            ui.wait(3)
        assert value(ui, "center") == pytest.approx((0.336, 0.664), abs=2e-3)
        assert value(ui, "center") != pytest.approx((1 / 3, 2 / 3), abs=1e-4)

    gui(body, save_graph(tmp_path, "swirl"))
