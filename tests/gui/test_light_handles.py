"""Lights on the picture: moved, turned, dropped, added and removed by the mouse in the viewer."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from halation import document
from halation.authoring.edits.element_id import ElementId
from halation.editor.viewer.dome import flat
from halation.editor.viewer.ground import depth_at
from halation.editor.viewer.perspective import project
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import CameraModel, Light, LightKind, catalogue, lights_of, number_lights
from halation.resources.sandbox import UNRESTRICTED

LIGHTS = (
    Light(LightKind.POINT, (-1.0, -1.0, 1.6), color=(1.0, 0.6, 0.2), intensity=8.0, reach=2.5),
    Light(LightKind.SPOT, (1.6, -1.2, 1.9), (-0.5, 0.5, -0.7), (0.4, 0.6, 1.0), 30.0, inner=15.0, outer=25.0),
    Light(LightKind.SPHERE, (0.2, 0.6, 1.9), color=(1.0, 0.3, 0.5), intensity=6.0, size=0.2),
    Light(LightKind.SUN, direction=(0.4, 0.8, -0.5), color=(1.0, 0.95, 0.8), intensity=0.6),
)
POINT, SPOT, SPHERE, SUN = range(4)
PORT = Port("lit", "lights")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A scene in the light of all kinds of lights."""
    node = catalogue()
    graph = Graph(settings=Settings((320, 180))).add_output("image", Output())
    graph = graph.add("scene", node["scene"]()).add("lit", node["deferred_lighting"](lights=number_lights(LIGHTS)))
    for source, target in (("camera", "camera"), ("albedo", "albedo"), ("normal", "normal"), ("depth", "depth")):
        graph = graph.connect(Port("scene", source), Port("lit", target))
    document.save(
        graph.connect(Port("lit", "out"), Port("outputs", "image")), tmp_path / "graph.json", sandbox=UNRESTRICTED
    )
    return tmp_path / "graph.json"


def of(ui) -> tuple[Light, ...]:
    return lights_of(ui.session.graph.value(PORT))


def seen(ui, light: Light) -> tuple[float, float, float]:
    found = project(camera(ui), light.place)
    assert found is not None
    return found


def camera(ui) -> CameraModel:
    found = ui.editor.preview.camera(Port("lit", "camera"))
    assert found is not None
    return found


def inside(ui, x: float, y: float) -> tuple[float, float]:
    return ui.at("viewer image", (x, y))


def start(ui) -> int:
    """Select the node; how many steps the history has."""
    ui.session.select([ElementId("lit")])
    ui.settled()
    ui.move(inside(ui, 0.02, 0.5))
    ui.settled()
    return len(ui.session.history.steps)


def test_alt_and_the_wheel_move_a_light_in_depth(gui, path: Path) -> None:
    def body(ui) -> None:
        steps, (u, v, depth) = start(ui), seen(ui, LIGHTS[POINT])
        x, y = ui.at("handle lit.lights lamp_1")
        height = ui.editor.viewer.panel[1]
        ui.drag((x, y), (x + 30.0, y - 60.0), keys="Alt", release=False)
        far = seen(ui, of(ui)[POINT])
        assert far == pytest.approx((u, v, depth * 2.0 ** (3.0 * 60.0 / height)), rel=0.02)
        ui.shot("light_depth.png")
        assert "label lit.lights lamp_1" in ui.editor.places
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert len(ui.session.history.steps) == steps + 1
        ui.keys("Ctrl+Z")
        assert of(ui) == LIGHTS
        ui.move("handle lit.lights lamp_1")
        ui.wait(2)
        for _ in range(2):
            ui.wheel(2)
        assert seen(ui, of(ui)[POINT]) == pytest.approx((u, v, depth / 2.0), rel=1e-3)
        assert len(ui.session.history.steps) == steps + 1 and ui.editor.viewer.zoom == 0.0

    gui(body, path)


def test_a_spot_is_turned_by_what_it_shines_to(gui, path: Path) -> None:
    def body(ui) -> None:
        steps = start(ui)
        spot = LIGHTS[SPOT]
        ui.drag("goal lit.lights lamp_2", inside(ui, 0.4, 0.8))
        ui.settled()
        turned = of(ui)[SPOT]
        assert turned.place == spot.place and turned.intensity == spot.intensity
        goal = tuple(a + b for a, b in zip(turned.place, turned.direction, strict=True))
        before = tuple(a + b for a, b in zip(spot.place, spot.direction, strict=True))
        at, was = project(camera(ui), goal), project(camera(ui), before)
        assert at is not None and was is not None
        assert at[:2] == pytest.approx((0.4, 0.8), abs=5e-3) and at[2] == pytest.approx(was[2], rel=1e-4)
        assert ui.editor.items["lit.lights"] == "lamp_2" and len(ui.session.history.steps) == steps + 1
        ui.shot("light_spot.png")
        x, y = ui.at("goal lit.lights lamp_2")
        ui.drag((x, y), (x, y - 40.0), keys="Alt")
        pushed = of(ui)[SPOT]
        far = project(camera(ui), tuple(a + b for a, b in zip(pushed.place, pushed.direction, strict=True)))
        assert far is not None and far[2] > at[2] and far[:2] == pytest.approx(at[:2], abs=1e-3)
        ui.editor.store.change(theme="light")
        ui.move(inside(ui, 0.02, 0.5))
        ui.settled()
        ui.shot("light_spot_light.png")

    gui(body, path)


def test_shift_drops_a_light_before_what_is_under_the_mouse(gui, path: Path) -> None:
    def body(ui) -> None:
        steps, at = start(ui), (0.45, 0.55)
        depth = ui.ask(lambda: depth_at(ui.editor, at))
        ui.drag("handle lit.lights lamp_3", inside(ui, *at), keys="Shift")
        u, v, near = seen(ui, of(ui)[SPHERE])
        assert (u, v) == pytest.approx(at, abs=5e-3)
        assert near == pytest.approx(depth * 0.95 - 0.2, rel=0.01)
        assert len(ui.session.history.steps) == steps + 1
        ui.shot("light_dropped.png")

    gui(body, path)


def test_the_sun_is_dragged_on_its_dome(gui, path: Path) -> None:
    def body(ui) -> None:
        steps = start(ui)
        for x, y in ((0.0, -0.25), (0.4, 0.0), (-0.5, 0.6)):
            box = ui.editor.places["viewer dome"]
            middle, radius = ((box[0] + box[2]) / 2, (box[1] + box[3]) / 2), (box[2] - box[0]) / 2
            ui.drag("handle lit.lights lamp_4", (middle[0] + x * radius, middle[1] + y * radius))
            assert flat(camera(ui), of(ui)[SUN].direction) == pytest.approx((x, y), abs=0.03)
            assert math.hypot(*of(ui)[SUN].direction) == pytest.approx(1.0, abs=1e-4)
        assert len(ui.session.history.steps) == steps + 3 and ui.editor.items["lit.lights"] == "lamp_4"
        ui.settled()
        ui.shot("light_sun.png")
        ui.drag("handle lit.lights lamp_4", (middle[0] + 3.0 * radius, middle[1]), release=False)
        assert ui.at("handle lit.lights lamp_4")[0] <= middle[0] + radius + 1.0
        ui.keys("Escape")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert len(ui.session.history.steps) == steps + 3

    gui(body, path)


def test_a_double_click_adds_a_light_and_delete_removes_it(gui, path: Path) -> None:
    def body(ui) -> None:
        steps, at = start(ui), (0.3, 0.75)
        depth = ui.ask(lambda: depth_at(ui.editor, at))
        ui.double_click(inside(ui, *at))
        ui.settled()
        made = of(ui)
        assert len(made) == 5 and made[4].kind is LightKind.POINT and made[:4] == LIGHTS
        assert seen(ui, made[4]) == pytest.approx((*at, 0.95 * depth), rel=0.02)
        assert ui.editor.items["lit.lights"] == "point_1" and len(ui.session.history.steps) == steps + 1
        ui.keys("Delete")
        assert of(ui) == LIGHTS and "lit" in ui.session.graph.nodes
        ui.keys("Ctrl+Z")
        ui.keys("Ctrl+Z")
        assert of(ui) == LIGHTS and len(ui.session.history.steps) == steps + 2
        for left in (3, 2, 1, 0, 0):
            ui.keys("Delete")
            assert len(of(ui)) == left
        ui.double_click(inside(ui, 0.5, 0.5))
        assert len(of(ui)) == 1 and ui.editor.items["lit.lights"] == "point_1"

    gui(body, path)


def test_sizes_are_dragged_by_their_handles(gui, path: Path) -> None:
    """Twice as far from the middle is twice the length; of a cone, twice the tangent of its half angle."""

    def body(ui) -> None:
        steps = start(ui)
        for number, (name, index, middle, field) in enumerate(
            (
                ("lamp_1", POINT, "handle", "reach"),
                ("lamp_2", SPOT, "goal", "outer"),
                ("lamp_2", SPOT, "goal", "inner"),
                ("lamp_3", SPHERE, "handle", "size"),
            ),
            1,
        ):
            ui.click(f"handle lit.lights {name}")
            ui.settled()
            before = getattr(of(ui)[index], field)
            center, end = ui.at(f"{middle} lit.lights {name}"), ui.at(f"size {field} lit.lights {name}")
            to = (center[0] + 1.2 * (end[0] - center[0]), center[1] + 1.2 * (end[1] - center[1]))
            ui.drag(end, to)
            ui.settled()
            after = getattr(of(ui)[index], field)
            wanted = 1.2 * before
            if middle == "goal":
                wanted = math.degrees(math.atan(1.2 * math.tan(math.radians(before))))
            assert after == pytest.approx(wanted, rel=0.02)
            assert ui.at(f"size {field} lit.lights {name}") == pytest.approx(to, abs=3.0)
            assert len(ui.session.history.steps) == steps + number
            ui.shot(f"light_{field}.png")
        ui.keys("Ctrl+Z")
        assert of(ui)[SPHERE] == LIGHTS[SPHERE]

    gui(body, path)
