"""Splines on the picture: drawn with the pen, and their points and tangents moved, added and removed by the mouse."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gui_driver import Ui
from halation import document
from halation.authoring.commands import AddItem, AddNode, AnimateValues, SetValue
from halation.authoring.edits.element_id import ElementId
from halation.graph import Graph, Key, Keys, Output, Port, Settings
from halation.nodes import Kind, RotoShape, catalogue, join_points, name_roto_shapes, roto_shapes_of, split_points
from halation.resources.sandbox import UNRESTRICTED

PORT = Port("roto", "shapes")
POINTS = Port("roto", "shapes.box.points")
BOX = ((0.3, 0.3), (0.7, 0.3), (0.7, 0.7), (0.3, 0.7))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A square, moved by a tenth of the picture."""
    shapes = name_roto_shapes(box=RotoShape(points=join_points(BOX), position=(0.1, 0.0)))
    graph = Graph(settings=Settings((320, 180)), outputs={"image": Output(Kind.IMAGE)})
    graph = graph.add("roto", catalogue()["roto"](shapes=shapes))
    graph = graph.connect(Port("roto", "out"), Port("outputs", "image"))
    document.save(graph, tmp_path / "graph.json", sandbox=UNRESTRICTED)
    return tmp_path / "graph.json"


def start(ui: Ui) -> int:
    """Select the node; how many steps the history has."""
    ui.session.select([ElementId("roto")])
    ui.settled()
    ui.move(at(ui, 0.05, 0.05))
    ui.settled()
    return len(ui.session.history.steps)


def at(ui: Ui, x: float, y: float) -> tuple[float, float]:
    """A point of the picture, by fractions."""
    return ui.at("viewer image", (x, y))


def points(ui: Ui) -> tuple[tuple[float, ...], ...]:
    return split_points(ui.session.time.evaluated_graph.value(POINTS))


def test_a_shape_is_drawn_with_the_pen(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        steps = start(ui)
        ui.keys("N")
        assert ui.editor.viewer.pen.is_drawing
        for place in ((0.1, 0.6), (0.3, 0.6)):
            ui.click(at(ui, *place))
            ui.settled()
        ui.drag(at(ui, 0.3, 0.9), at(ui, 0.2, 0.9))
        ui.settled()
        assert len(ui.session.history.steps) == steps + 3
        ui.shot("pen.png")
        ui.click(at(ui, 0.1, 0.6))
        ui.settled()
        pen = ui.editor.viewer.pen
        assert pen.find_points("roto.shapes.shape_1.points") == {2} and not pen.find_points(str(POINTS))
        assert not pen.is_drawing and len(ui.session.history.steps) == steps + 3
        drawn = ui.session.graph.value(PORT)["shape_1"].fields["points"]
        rows = split_points(drawn)
        assert rows[0][:6] == pytest.approx((0.1, 0.6, 0.0, 0.0, 0.0, 0.0), abs=0.004)
        assert rows[2][:6] == pytest.approx((0.3, 0.9, 0.1, 0.0, -0.1, 0.0), abs=0.006)
        for left in (2, 1):
            ui.keys("Ctrl+Z")
            assert len(split_points(ui.session.graph.value(PORT)["shape_1"].fields["points"])) == left
        ui.keys("Ctrl+Z")
        assert list(ui.session.graph.value(PORT)) == ["box"]
        ui.session.apply(AddNode("roto"))  # the first shape of a new node takes the place of the one that it has
        ui.settled()
        ui.keys("N")
        ui.click(at(ui, 0.7, 0.2))
        ui.click(at(ui, 0.9, 0.2))
        fields = {
            name: shape.fields for name, shape in ui.session.graph.value(Port(ui.session.active, "shapes")).items()
        }
        assert {name: len(split_points(own["points"])) for name, own in fields.items()} == {"shape_1": 2}

    gui(body, path)


def test_points_and_tangents_are_dragged_where_the_shape_is(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        steps = start(ui)
        ui.drag(f"point 0 {POINTS}", at(ui, 0.3, 0.2))
        assert points(ui)[0][:2] == pytest.approx((0.2, 0.2), abs=0.005)
        assert len(ui.session.history.steps) == steps + 1
        ui.drag(f"point 0 {POINTS}", at(ui, 0.4, 0.2), keys="Alt")
        smooth = points(ui)[0]
        assert smooth[:6] == pytest.approx((0.2, 0.2, -0.1, 0.0, 0.1, 0.0), abs=0.01)
        ui.shot("tangents.png")
        ui.drag(f"tangent out {POINTS}", at(ui, 0.4, 0.1))
        assert points(ui)[0][2:6] == pytest.approx((-0.1, 0.1, 0.1, -0.1), abs=0.01)
        ui.drag(f"tangent in {POINTS}", at(ui, 0.2, 0.2), keys="Alt")
        assert points(ui)[0][2:6] == pytest.approx((-0.1, 0.0, 0.1, -0.1), abs=0.01)
        assert len(ui.session.history.steps) == steps + 4
        for _ in range(4):
            ui.keys("Ctrl+Z")
        assert [point[:2] for point in points(ui)] == list(BOX)

    gui(body, path)


def test_points_are_inserted_and_removed(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        steps = start(ui)
        ui.double_click(at(ui, 0.6, 0.3))
        ui.settled()
        assert len(points(ui)) == 5 and points(ui)[1][:2] == pytest.approx((0.5, 0.3), abs=0.005)
        ui.keys("Delete")
        assert [point[:2] for point in points(ui)] == list(BOX)
        assert len(ui.session.history.steps) == steps + 2
        assert len(roto_shapes_of(ui.session.graph.value(PORT))) == 1

    gui(body, path)


def test_a_drag_sets_a_key_where_there_are_keys(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        ui.session.apply(AnimateValues({POINTS: Keys((Key(1, ui.session.graph.value(POINTS)),))}, "Animate"))
        ui.session.time.seek(5)
        ui.settled()
        ui.drag(f"point 0 {POINTS}", at(ui, 0.3, 0.2))
        animation = ui.session.graph.animation[POINTS]
        assert isinstance(animation, Keys) and [key.frame for key in animation.keys] == [1, 5]
        ui.session.time.seek(3)
        assert points(ui)[0][:2] == pytest.approx((0.25, 0.25), abs=0.005)

    gui(body, path)


def add_keys(ui: Ui) -> None:
    """Keys of the points at frames 1 and 9: the box moves by a tenth of the picture."""
    moved = join_points([(x + 0.1, y) for x, y in BOX])
    keys = Keys((Key(1, join_points(BOX), "linear"), Key(9, moved)))
    ui.session.apply(AnimateValues({POINTS: keys}, "Animate"))
    ui.settled()


def points_at(ui: Ui, frame: int) -> np.ndarray:
    ui.session.time.seek(frame)
    return np.array([point[:2] for point in points(ui)])


def select_upper_points(ui: Ui) -> None:
    """By a lasso around the two upper corners, which are seen at .4 and .8."""
    ui.move(at(ui, 0.3, 0.45))
    with ui.held("Shift"):
        ui.ctx.mouse_down(0)
        for place in ((0.3, 0.2), (0.9, 0.2), (0.9, 0.45)):
            ui.move(at(ui, *place))
        ui.ctx.mouse_up(0)
    ui.settled()
    assert ui.editor.viewer.pen.find_points(str(POINTS)) == {0, 1}


def test_points_in_a_lasso_are_moved_nudged_and_removed_together(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        steps = start(ui)
        select_upper_points(ui)
        ui.shot("lasso.png")
        ui.drag(f"point 1 {POINTS}", at(ui, 0.8, 0.2))
        assert [point[1] for point in points(ui)] == pytest.approx([0.2, 0.2, 0.7, 0.7], abs=0.006)
        assert len(ui.session.history.steps) == steps + 1
        before = points(ui)[0][0]
        ui.keys("Alt+LeftArrow")
        ui.keys("Alt+Shift+LeftArrow")
        assert points(ui)[0][0] == pytest.approx(before - 11 / 320, abs=1e-5)
        ui.keys("Delete")
        assert [point[:2] for point in points(ui)] == [BOX[2], BOX[3]]

    gui(body, path)


def test_points_are_added_to_the_selection_one_by_one(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        for index in (0, 2, 3):
            ui.click(f"point {index} {POINTS}", keys="Shift")
            ui.settled()
        assert ui.editor.viewer.pen.find_points(str(POINTS)) == {0, 2, 3}
        ui.click(f"point 2 {POINTS}", keys="Shift")
        ui.settled()
        assert ui.editor.viewer.pen.find_points(str(POINTS)) == {0, 3}
        ui.editor.actions.run("viewer.all_points")
        assert ui.editor.viewer.pen.find_points(str(POINTS)) == {0, 1, 2, 3}
        ui.click(f"point 1 {POINTS}")
        ui.settled()
        assert ui.editor.viewer.pen.find_points(str(POINTS)) == {1}

    gui(body, path)


def test_points_are_copied_from_one_frame_to_another(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        add_keys(ui)
        select_upper_points(ui)
        ui.editor.actions.run("viewer.copy_points")
        ui.session.time.seek(9)
        ui.settled()
        ui.editor.actions.run("viewer.paste_points")
        np.testing.assert_allclose(points_at(ui, 9), [*BOX[:2], (0.8, 0.7), (0.4, 0.7)])
        np.testing.assert_allclose(points_at(ui, 1), BOX)

    gui(body, path)


def test_ripple_moves_points_at_all_keys(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        add_keys(ui)
        ui.editor.actions.run("viewer.ripple")
        ui.drag(f"point 0 {POINTS}", at(ui, 0.3, 0.2))
        assert points_at(ui, 1)[0] == pytest.approx((0.2, 0.2), abs=0.005)
        assert points_at(ui, 9)[0] == pytest.approx((0.3, 0.2), abs=0.005)
        np.testing.assert_allclose(points_at(ui, 9)[1:], [(x + 0.1, y) for x, y in BOX[1:]])
        ui.keys("Ctrl+Z")
        assert points_at(ui, 9)[0] == pytest.approx((0.4, 0.3))

    gui(body, path)


def test_a_point_is_keyed_without_the_others(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        add_keys(ui)
        steps = len(ui.session.history.steps)
        ui.editor.actions.run("viewer.key_singly")
        ui.session.time.seek(5)
        ui.settled()
        ui.drag(f"point 0 {POINTS}", at(ui, 0.3, 0.2))
        own = ui.session.graph.animation[Port("roto", "shapes.box.points.0")]
        together = ui.session.graph.animation[POINTS]
        assert isinstance(own, Keys) and [key.frame for key in own.keys] == [1, 5, 9]
        assert isinstance(together, Keys) and [key.frame for key in together.keys] == [1, 9]
        assert len(ui.session.history.steps) == steps + 1
        ui.settled()
        ui.shot("singly.png")
        np.testing.assert_allclose(points_at(ui, 5)[1:], [(x + 0.05, y) for x, y in BOX[1:]])
        assert points_at(ui, 5)[0] == pytest.approx((0.2, 0.2), abs=0.005)
        np.testing.assert_allclose(points_at(ui, 9), [(x + 0.1, y) for x, y in BOX])
        ui.click(f"point 0 {POINTS}")
        ui.settled()
        ui.editor.actions.run("viewer.join_keys")
        np.testing.assert_allclose(points_at(ui, 5), [(x + 0.05, y) for x, y in BOX])
        ui.keys("Ctrl+Z")
        ui.keys("Ctrl+Z")
        assert not ui.session.graph.keyed_points

    gui(body, path)


def test_selected_points_of_a_shape_without_keys_are_keyed(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        select_upper_points(ui)
        ui.editor.actions.run("viewer.key_points")
        assert set(ui.session.graph.keyed_points[POINTS]) == {0, 1} and POINTS not in ui.session.graph.animation
        ui.session.time.seek(9)
        ui.settled()
        ui.drag(f"point 0 {POINTS}", at(ui, 0.4, 0.2))
        assert points_at(ui, 5)[0] == pytest.approx((0.3, 0.25), abs=0.005)
        np.testing.assert_allclose(points_at(ui, 9)[2:], BOX[2:])

    gui(body, path)


def test_a_point_is_inserted_and_removed_at_all_keys(gui, path: Path) -> None:
    """Else shapes of two keys would have another number of points, and nothing could lie between them."""

    def body(ui: Ui) -> None:
        start(ui)
        add_keys(ui)
        ui.double_click(at(ui, 0.6, 0.3))
        ui.settled()
        animation = ui.session.graph.animation[POINTS]
        assert isinstance(animation, Keys)
        assert [len(split_points(key.value)) for key in animation.keys] == [5, 5]
        assert points_at(ui, 5)[1] == pytest.approx((0.55, 0.3), abs=0.005)
        ui.session.time.seek(1)
        ui.keys("Delete")
        np.testing.assert_allclose(points_at(ui, 5), [(x + 0.05, y) for x, y in BOX])

    gui(body, path)


def test_the_feather_of_a_point_is_dragged(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        ui.click(f"point 0 {POINTS}")
        ui.settled()
        ui.shot("feather.png")
        grip = ui.editor.places[f"feather {POINTS}"]
        x, y = (grip[0] + grip[2]) / 2, (grip[1] + grip[3]) / 2
        away = 0.1 * (at(ui, 0.0, 1.0)[1] - at(ui, 0.0, 0.0)[1]) / 2**0.5
        ui.drag((x, y), (x - away, y - away))  # a corner at the left top: outside is there
        assert points(ui)[0][6] == pytest.approx(0.2, abs=0.01)
        assert points(ui)[0][:6] == (*BOX[0], 0.0, 0.0, 0.0, 0.0)
        ui.drag(f"feather {POINTS}", (x, y))
        assert points(ui)[0][6] == pytest.approx(0.0, abs=0.01)

    gui(body, path)


def test_points_are_dragged_where_a_parent_puts_them(gui, path: Path) -> None:
    """The parent turns the square, which itself is moved by a tenth of the picture, by a half about the middle."""

    def body(ui: Ui) -> None:
        start(ui)
        name = ui.session.apply(AddItem(PORT, "transform", {"rotation": 180.0}))
        ui.session.apply(SetValue(Port("roto", "shapes.box.parent"), name))
        ui.editor.items[str(PORT)] = "box"
        ui.settled()
        grip = ui.editor.places[f"point 0 {POINTS}"]
        assert ((grip[0] + grip[2]) / 2, (grip[1] + grip[3]) / 2) == pytest.approx(at(ui, 0.6, 0.7), abs=1.0)
        ui.drag(f"point 0 {POINTS}", at(ui, 0.7, 0.8))
        assert points(ui)[0][:2] == pytest.approx((0.2, 0.2), abs=0.005)

    gui(body, path)
