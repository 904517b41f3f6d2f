"""Depth of field: what is sharp is said by the mouse in the viewer."""

from __future__ import annotations

from pathlib import Path

import halation as hal
import pytest
from halation import document
from halation.authoring.edits.element_id import ElementId
from halation.editor.viewer.ground import depth_at
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED

WIDTH, HEIGHT = 192, 108
POINT, DISTANCE = Port("lens", "focus_point"), Port("lens", "focus_distance")


def made(focus: str) -> Graph:
    """A scene through a lens."""
    node = catalogue()
    graph = Graph(settings=Settings((WIDTH, HEIGHT))).add_output("image", Output())
    graph = graph.add("scene", node["scene"]()).add("lens", node["depth_of_field"](focus=focus))
    for source, target in (("color", "image"), ("depth", "depth")):
        graph = graph.connect(Port("scene", source), Port("lens", target))
    return graph.connect(Port("lens", "out"), Port("outputs", "image"))


@pytest.fixture
def path(tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    document.save(made(request.param), tmp_path / "graph.json", sandbox=UNRESTRICTED)
    return tmp_path / "graph.json"


def check(found: dict[tuple[float, float], float]) -> None:
    """What was read is the depth that is rendered there."""
    depth = next(iter(hal.render(made("point"), node="scene.depth").values())).reshape(HEIGHT, WIDTH, -1)[..., 0]
    assert found
    for (u, v), read in found.items():
        assert read == pytest.approx(depth[int(v * HEIGHT), int(u * WIDTH)], rel=1e-6)


def inside(ui, x: float, y: float) -> tuple[float, float]:
    """The middle of the pixel at a fraction of the picture."""
    return ui.at("viewer image", ((int(x * WIDTH) + 0.5) / WIDTH, (int(y * HEIGHT) + 0.5) / HEIGHT))


def start(ui) -> None:
    ui.session.select([ElementId("lens")])
    ui.settled()
    ui.move(inside(ui, 0.5, 0.5))
    ui.settled()


@pytest.mark.parametrize("path", ["point"], indirect=True)
def test_the_point_is_dragged_and_its_depth_written(gui, path: Path) -> None:
    found = {}

    def body(ui) -> None:
        start(ui)
        before = ui.pixels()
        ui.drag("handle lens.focus_point", inside(ui, 0.7, 0.7), release=False)
        ui.settled()
        assert (ui.pixels("focus_dragged.png") != before).any()
        assert ui.session.graph.value(POINT) == pytest.approx((0.7, 0.7), abs=0.01)
        u, v = ui.session.graph.value(POINT)
        ui.ctx.mouse_up(0)
        ui.settled()
        found[u, v] = ui.ask(lambda: depth_at(ui.editor, (u, v)))
        assert "label lens.focus_point" in ui.editor.places
        assert ui.session.history.steps == ("Set lens.focus_point",)
        ui.keys("E")
        ui.click(inside(ui, 0.25, 0.5))
        assert ui.session.graph.value(POINT) == pytest.approx((0.25, 0.5), abs=0.01) and not ui.editor.viewer.picking

    gui(body, path)
    check(found)


@pytest.mark.parametrize("path", ["distance"], indirect=True)
def test_a_distance_is_picked_from_the_picture(gui, path: Path) -> None:
    found = {}

    def body(ui) -> None:
        start(ui)
        assert "handle lens.focus_point" not in ui.editor.places
        ui.click("button viewer.pick_focus")
        assert ui.editor.viewer.picking == "lens.focus_distance"
        ui.move(inside(ui, 0.45, 0.5))
        ui.wait(3)
        ui.shot("focus_picking.png")
        assert "label lens.focus_distance" in ui.editor.places
        ui.click(inside(ui, 0.45, 0.5))
        found[0.45, 0.5] = ui.session.graph.value(DISTANCE)
        assert ui.session.history.steps == ("Set lens.focus_distance",) and not ui.editor.viewer.picking
        ui.keys("E")
        ui.drag(inside(ui, 0.2, 0.6), inside(ui, 0.7, 0.75))
        found[0.7, 0.75] = ui.session.graph.value(DISTANCE)
        assert len(ui.session.history.steps) == 2
        ui.keys("E")
        ui.click(inside(ui, 0.5, 0.5), button=1)
        assert not ui.editor.viewer.picking
        ui.session.select([ElementId("scene")])
        ui.wait(3)
        assert "button viewer.pick_focus" not in ui.editor.places

    gui(body, path)
    check(found)
