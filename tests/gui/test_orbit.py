"""The camera of a scene, moved by the mouse in the viewer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation import document
from halation.authoring.commands import AddNode
from halation.editor.viewer.ground import SCENE, depth_at
from halation.editor.viewer.orbit import Orbit
from halation.editor.viewer.perspective import project, unproject
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED

WIDTH, HEIGHT = 192, 108
ASPECT = WIDTH / HEIGHT


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A scene that is seen through an exposure."""
    node = catalogue()
    graph = Graph(settings=Settings((WIDTH, HEIGHT))).add_output("image", Output())
    graph = graph.add("scene", node["scene"]()).add("light", node["exposure"]())
    graph = graph.connect(Port("scene", "color"), Port("light", "image"))
    document.save(
        graph.connect(Port("light", "out"), Port("outputs", "image")), tmp_path / "graph.json", sandbox=UNRESTRICTED
    )
    return tmp_path / "graph.json"


def orbit(ui) -> Orbit:
    return Orbit.of(ui.session.graph.nodes["scene"])


def inside(ui, x: float, y: float) -> tuple[float, float]:
    return ui.at("viewer image", (x, y))


def start(ui) -> None:
    """Let the mouse move the camera."""
    ui.settled()
    ui.move(inside(ui, 0.5, 0.5))
    ui.wait(3)
    ui.keys("O")
    ui.settled()
    assert ui.editor.viewer.orbits and "viewer axes" in ui.editor.places


def test_a_drag_goes_around_the_scene_as_one_step(gui, path: Path) -> None:
    def body(ui) -> None:
        start(ui)
        before, size = orbit(ui), ui.editor.viewer.panel[0]
        picture = ui.pixels()
        ui.drag(inside(ui, 0.3, 0.4), inside(ui, 0.6, 0.7), release=False)
        (left, top), (right, bottom) = inside(ui, 0.3, 0.4), inside(ui, 0.6, 0.7)
        assert orbit(ui).azimuth == pytest.approx(before.azimuth - 180.0 * (right - left) / size, abs=0.5)
        assert orbit(ui).elevation == pytest.approx(before.elevation + 180.0 * (bottom - top) / size, abs=0.5)
        assert orbit(ui).target == before.target and orbit(ui).distance == before.distance
        ui.settled()
        assert (ui.pixels("orbit_dragged.png") != picture).any()
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert ui.session.history.steps == ("Orbit scene",)
        ui.drag(inside(ui, 0.5, 0.2), inside(ui, 0.5, 2.5))
        assert orbit(ui).elevation == 89.0
        ui.drag(inside(ui, 0.5, 0.5), inside(ui, -1.5, 0.5))
        assert -180.0 <= orbit(ui).azimuth < 180.0
        assert len(ui.session.history.steps) == 3
        for _ in range(3):
            ui.keys("Ctrl+Z")
        assert orbit(ui) == before and not ui.session.dirty

    gui(body, path)


@pytest.mark.parametrize("button", [0, 2])
def test_what_is_moved_stays_under_the_mouse(gui, path: Path, button: int) -> None:
    def body(ui) -> None:
        start(ui)
        begin, end = (0.53, 0.45), (0.25, 0.62)
        before, viewer = orbit(ui), ui.editor.viewer
        depth = ui.ask(lambda: depth_at(ui.editor, begin, SCENE))
        assert depth is not None and depth < 10.0
        place = unproject(before.camera(ASPECT), *begin, depth)
        ui.drag(inside(ui, *begin), inside(ui, *end), button, "" if button else "Shift")
        seen = project(orbit(ui).camera(ASPECT), place)
        assert seen == pytest.approx((*end, depth), abs=4e-3)
        assert len(ui.session.history.steps) == 1 and viewer.zoom == 0.0
        ui.settled()
        assert ui.ask(lambda: depth_at(ui.editor, seen[:2], SCENE)) == pytest.approx(depth, rel=0.02)
        ui.keys("Ctrl+Z")
        ui.drag(inside(ui, 0.02, 0.02), inside(ui, 0.32, 0.02), button, "" if button else "Shift")
        assert project(orbit(ui).camera(ASPECT), before.target)[:2] != pytest.approx((0.5, 0.5), abs=0.05)

    gui(body, path)


def test_the_wheel_goes_nearer_and_space_pans_the_picture(gui, path: Path) -> None:
    def body(ui) -> None:
        start(ui)
        before = orbit(ui)
        ui.move(inside(ui, 0.4, 0.4))
        ui.wheel(4)
        ui.wheel(4)
        assert orbit(ui).distance == pytest.approx(before.distance / 4.0, rel=1e-5)
        assert len(ui.session.history.steps) == 1
        ui.keys("Ctrl+Z")
        assert orbit(ui) == before
        ui.ctx.key_down(ui_key("Space"))
        ui.wheel(4)
        ui.drag(inside(ui, 0.5, 0.5), inside(ui, 0.6, 0.5))
        ui.ctx.key_up(ui_key("Space"))
        ui.wait(2)
        assert orbit(ui) == before and ui.editor.viewer.zoom > 0.0 and not ui.session.dirty
        ui.keys("O")
        assert not ui.editor.viewer.orbiting and "viewer axes" not in ui.editor.places
        pan = ui.editor.viewer.pan
        ui.drag(inside(ui, 0.5, 0.5), inside(ui, 0.6, 0.5))
        assert orbit(ui) == before and ui.editor.viewer.pan != pan
        ui.drag(inside(ui, 0.5, 0.5), inside(ui, 0.6, 0.5), keys="Alt")
        assert orbit(ui).azimuth != before.azimuth

    gui(body, path)


def ui_key(name: str):
    from halation.editor.toolkit.keys import chord
    from imgui_bundle import imgui

    return imgui.Key(chord(name))


def test_all_of_the_scene_is_framed(gui, path: Path) -> None:
    def body(ui) -> None:
        start(ui)
        before = orbit(ui)
        for _ in range(2):
            ui.drag(inside(ui, 0.5, 0.5), inside(ui, 0.2, 0.1), keys="Shift")
        ui.keys("Home")
        ui.settled()
        ui.shot("orbit_framed.png")
        made = orbit(ui)
        assert (made.azimuth, made.elevation, made.focal) == (before.azimuth, before.elevation, before.focal)
        assert ui.session.history.steps[-1] == "Orbit scene" and len(ui.session.history.steps) == 3
        low, high = np.array((-2.01, -1.37, 0.0)), np.array((2.85, 1.95, 2.15))
        assert made.target == pytest.approx((low + high) / 2.0, abs=0.01)
        corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        seen = np.array([project(made.camera(ASPECT), corner) for corner in corners])
        assert seen[:, :2].min() > -0.05 and seen[:, :2].max() < 1.05 and np.ptp(seen[:, 0]) > 0.7

    gui(body, path)


def test_escape_takes_a_drag_back(gui, path: Path) -> None:
    def body(ui) -> None:
        start(ui)
        before = orbit(ui)
        ui.drag(inside(ui, 0.5, 0.5), inside(ui, 0.7, 0.6), release=False)
        assert orbit(ui) != before
        ui.keys("Escape")
        assert orbit(ui) == before and not ui.session.history.steps
        ui.ctx.mouse_up(0)
        ui.wait(2)

    gui(body, path)


def test_without_a_scene_there_is_nothing_to_orbit(gui, path: Path) -> None:
    def body(ui) -> None:
        start(ui)
        ui.click("button viewer.orbit")
        assert not ui.editor.viewer.orbiting
        ui.click("button viewer.orbit")
        noise = ui.session.apply(AddNode("noise"))
        ui.session.views.show(Port(noise, "value"))
        ui.settled()
        assert "button viewer.orbit" not in ui.editor.places and not ui.editor.viewer.orbits
        pan = ui.editor.viewer.pan
        ui.editor.viewer.zoom = 2.0
        ui.wait(2)
        before = orbit(ui)
        ui.drag(inside(ui, 0.3, 0.3), inside(ui, 0.4, 0.3))
        assert orbit(ui) == before and ui.editor.viewer.pan != pan

    gui(body, path)
