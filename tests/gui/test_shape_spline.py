"""The spline of a `shape` on the picture: its points lie in a box that is moved, sized and turned."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from gui_driver import Ui
from halation import document
from halation.authoring.commands import SetValue
from halation.authoring.edits.element_id import ElementId
from halation.graph import Graph, Key, Keys, Output, Port, Settings
from halation.nodes import Kind, catalogue, join_points, split_points
from halation.resources.sandbox import UNRESTRICTED

POINTS = Port("shape", "spline")
BOX = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
"""The corners of the box of the shape, a square of half the height about (0.6, 0.5), turned by a quarter."""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    shape = catalogue()["shape"](
        shape="spline", spline=join_points(BOX), center=(0.6, 0.5), size=(0.5, 0.5), rotation=90.0
    )
    graph = Graph(settings=Settings((360, 180)), outputs={"image": Output(Kind.IMAGE)}).add("shape", shape)
    graph = graph.connect(Port("shape", "out"), Port("outputs", "image"))
    graph = graph.animate(POINTS, Keys((Key(1, join_points(BOX)), Key(9, join_points(BOX)))))
    document.save(graph, tmp_path / "graph.json", sandbox=UNRESTRICTED)
    return tmp_path / "graph.json"


def place_on_picture(x: float, y: float) -> tuple[float, float]:
    """Where a point of the box is, in fractions of the picture of 2 to 1."""
    across, down = 0.5 * (x - 0.5), 0.5 * (y - 0.5)
    return 0.6 + 0.5 * -down, 0.5 + across


def start(ui: Ui) -> int:
    """Select the node; how many steps the history has."""
    ui.session.select([ElementId("shape")])
    ui.settled()
    ui.move(at(ui, 0.05, 0.05))
    ui.settled()
    return len(ui.session.history.steps)


def at(ui: Ui, x: float, y: float) -> tuple[float, float]:
    return ui.at("viewer image", (x, y))


def points(ui: Ui) -> tuple[tuple[float, ...], ...]:
    return split_points(ui.session.time.evaluated_graph.value(POINTS))


def test_points_lie_in_the_box_and_set_keys(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        steps = start(ui)
        for number, corner in enumerate(BOX):
            grip = ui.editor.places[f"point {number} {POINTS}"]
            middle = (grip[0] + grip[2]) / 2, (grip[1] + grip[3]) / 2
            assert math.dist(middle, at(ui, *place_on_picture(*corner))) < 1.0
        ui.session.time.seek(5)
        ui.settled()
        ui.drag(f"point 0 {POINTS}", at(ui, *place_on_picture(0.2, -0.2)))
        assert points(ui)[0][:2] == pytest.approx((0.2, -0.2), abs=0.02)
        assert len(ui.session.history.steps) == steps + 1
        animation = ui.session.graph.animation[POINTS]
        assert isinstance(animation, Keys) and [key.frame for key in animation.keys] == [1, 5, 9]
        ui.shot("shape_spline.png")
        ui.double_click(at(ui, *place_on_picture(1.0, 0.3)))
        ui.settled()
        assert len(points(ui)) == 5 and points(ui)[2][:2] == pytest.approx((1.0, 0.3), abs=0.02)
        ui.keys("Delete")
        assert [point[:2] for point in points(ui)[1:]] == list(BOX[1:])

    gui(body, path)


def test_the_pen_draws_it_anew(gui, path: Path) -> None:
    """In place of all points, at all keys, one step of undo for each point."""

    def body(ui: Ui) -> None:
        steps = start(ui)
        ui.keys("N")
        corners = ((0.1, 0.2), (0.9, 0.3), (0.5, 1.1))
        for corner in corners:
            ui.click(at(ui, *place_on_picture(*corner)))
            ui.settled()
        ui.click(at(ui, *place_on_picture(*corners[0])))
        ui.settled()
        assert not ui.editor.viewer.pen.is_drawing and len(ui.session.history.steps) == steps + 3
        for point, corner in zip(points(ui), corners, strict=True):
            assert point[:2] == pytest.approx(corner, abs=0.02)
        animation = ui.session.graph.animation[POINTS]
        assert isinstance(animation, Keys) and [len(split_points(key.value)) for key in animation.keys] == [3, 3]
        for _ in range(3):
            ui.keys("Ctrl+Z")
        assert [point[:2] for point in points(ui)] == list(BOX)

    gui(body, path)


def test_other_shapes_have_no_points(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        assert f"point 0 {POINTS}" in ui.editor.places
        ui.session.apply(SetValue(Port("shape", "shape"), "ellipse"))
        ui.editor.places.clear()
        ui.settled()
        assert f"point 0 {POINTS}" not in ui.editor.places
        ui.keys("N")
        assert not ui.editor.viewer.pen.is_drawing

    gui(body, path)
