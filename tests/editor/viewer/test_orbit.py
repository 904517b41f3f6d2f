"""A camera that goes around its target."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.authoring.commands import AddNode, Connect, ReplaceGraph, SetValue
from halation.authoring.edits.element_id import ElementId
from halation.authoring.session import Session
from halation.editor.viewer.axes import axes
from halation.editor.viewer.geometry import Sight
from halation.editor.viewer.holding import HandleTarget, MouseHold, aim
from halation.editor.viewer.orbit import Orbit, find_orbit_node, frame_scene, without_surroundings
from halation.editor.viewer.perspective import project, unproject
from halation.editor.viewer.state import ViewerState
from halation.graph import INPUTS, Input, Port
from halation.media.meshes.load import load_mesh
from halation.nodes import BuiltInScene, Kind, catalogue, look_at
from halation.resources.sandbox import UNRESTRICTED
from msgspec import structs

SIGHT = Sight((0.0, 0.0), (800, 400), (400, 200), zoom=2.0)
ASPECT = 2.0
START = Orbit((0.1, 0.2, 0.75), 6.5, 8.0, 14.0)


@pytest.fixture
def editor() -> Any:
    """With a scene that is seen."""
    made = SimpleNamespace(
        session=Session(catalogue(), sandbox=UNRESTRICTED),
        viewer=ViewerState(picture=(400, 200)),
        interface=SimpleNamespace(dragging=False),
        items={},
        preview=SimpleNamespace(camera=lambda port: None, find_whole_image=lambda name: None),
        log=SimpleNamespace(attempt=lambda act: act()),
    )
    made.session.apply(AddNode("scene"))
    made.viewer.scene = find_orbit_node(made.session)
    return made


def now(editor: Any) -> Orbit:
    return Orbit.of(editor.session.graph.nodes["scene"])


def drag(editor: Any, start: tuple[float, float], end: tuple[float, float], what: Any) -> None:
    hold = MouseHold.begin(editor, SIGHT, start, HandleTarget(what))
    for part in (0.5, 1.0):
        at = start[0] + part * (end[0] - start[0]), start[1] + part * (end[1] - start[1])
        hold.drag(SIGHT, at, (1.0, 1.0))
    hold.release(SIGHT, end)


def test_it_is_the_camera_that_the_node_draws_with() -> None:
    turn, tilt = math.radians(8.0), math.radians(14.0)
    eye = (
        0.1 + 6.5 * math.sin(turn) * math.cos(tilt),
        0.2 - 6.5 * math.cos(turn) * math.cos(tilt),
        0.75 + 6.5 * math.sin(tilt),
    )
    expected = look_at(eye, START.target, (50.0 / 36.0, 50.0 / 36.0 * ASPECT))
    assert START.camera(ASPECT).rows == pytest.approx(expected.rows)


def test_a_drag_across_the_panel_is_half_a_turn(editor: Any) -> None:
    before = now(editor)
    drag(editor, (100.0, 100.0), (300.0, 140.0), "orbit")
    assert now(editor).azimuth == pytest.approx(before.azimuth - 45.0)
    assert now(editor).elevation == pytest.approx(before.elevation + 9.0)
    assert editor.interface.dragging and editor.session.history.steps == ("Add scene", "Orbit scene")
    drag(editor, (100.0, 100.0), (100.0, 900.0), "orbit")
    assert now(editor).elevation == 89.0
    drag(editor, (100.0, 900.0), (100.0, -900.0), "orbit")
    assert now(editor).elevation == -89.0
    drag(editor, (0.0, 0.0), (780.0, 0.0), "orbit")
    assert now(editor).azimuth == pytest.approx(before.azimuth - 45.0 - 175.5 + 360.0)
    assert len(editor.session.history.steps) == 5


def test_what_is_in_front_goes_where_the_mouse_goes() -> None:
    camera = START.camera(ASPECT)
    front = unproject(camera, 0.5, 0.5, 4.0)
    u, v, _ = project(START.turn_by(0.02, 0.0).camera(ASPECT), front) or (0, 0, 0)
    assert u > 0.501 and v == pytest.approx(0.5, abs=0.01)
    u, v, _ = project(START.turn_by(0.0, 0.02).camera(ASPECT), front) or (0, 0, 0)
    assert v > 0.501 and u == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize("depth", [None, 3.0, 11.0])
def test_what_is_moved_stays_under_the_mouse(editor: Any, depth: float | None) -> None:
    before = now(editor)
    editor.viewer.orbiting = True
    editor.probe = SimpleNamespace(read_pixel=lambda texture, x, y: (depth or 1e10,))
    editor.preview.find_whole_image = lambda name: SimpleNamespace(
        port=Port("scene", "depth"),
        full_size=(400, 200),
        texture=SimpleNamespace(size=(400, 200)),
        channels=1,
        key="",
        revision=1,
        size=(400, 200),
        start=(0, 0),
    )
    place = unproject(before.camera(ASPECT), 0.25, 0.5, depth or before.distance)
    drag(editor, (200.0, 200.0), (360.0, 120.0), "track")
    seen = project(now(editor).camera(ASPECT), place)
    assert seen == pytest.approx((0.45, 0.3, depth or before.distance), abs=1e-5)
    assert (now(editor).azimuth, now(editor).distance) == (before.azimuth, before.distance)


def test_nearer_and_farther_within_limits() -> None:
    assert START.approach_by(2.0).distance == 3.25
    assert structs.replace(START, distance=1e-3).approach_by(2.0).distance == 1e-3
    assert structs.replace(START, distance=9e5).approach_by(0.5).distance == 1e6


@pytest.mark.parametrize("name", ["stage", "corner", "blocks"])
@pytest.mark.parametrize(("azimuth", "elevation"), [(8.0, 14.0), (-120.0, 60.0), (90.0, -30.0)])
def test_a_framed_scene_fills_the_picture(editor: Any, name: Any, azimuth: float, elevation: float) -> None:
    session = editor.session
    for value, plain in (("scene", name), ("azimuth", azimuth), ("elevation", elevation)):
        session.apply(SetValue(Port("scene", value), plain))
    steps = len(session.history.steps)
    frame_scene(editor)
    assert len(session.history.steps) == steps + 1
    vertices: Any = load_mesh(BuiltInScene(name), sandbox=UNRESTRICTED).vertices
    places = without_surroundings(vertices[:, :3], vertices[:, 16])
    assert 0 < len(places) < len(vertices)
    seen = np.column_stack([places, np.ones(len(places))]) @ np.reshape(now(editor).camera(ASPECT).rows, (3, 4)).T
    assert (seen[:, 2] > 0.0).all()
    assert np.abs(seen[:, :2] / seen[:, 2:] - 0.5).max() == pytest.approx(0.45, abs=1e-4)
    assert now(editor).target == pytest.approx((places.min(axis=0) + places.max(axis=0)) / 2.0, abs=1e-4)


def test_a_floor_alone_is_framed_too() -> None:
    places = np.array([[0.0, 0.0, 0.0], [4.0, 4.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 3.0]])
    assert len(without_surroundings(places, np.array([1.0, 1.0, 2.0, 2.0]))) == 2
    assert len(without_surroundings(places, np.array([1.0, 1.0, 1.0, 1.0]))) == 4


def test_the_scene_that_is_seen_or_selected(editor: Any) -> None:
    session = editor.session
    assert find_orbit_node(session) == "scene"
    other = session.apply(AddNode("scene"))
    mixed = session.apply(AddNode("mix_images"))
    for source, socket in zip(("scene", other), session.graph.nodes[mixed].inputs, strict=False):
        session.apply(Connect(Port(source, "color"), Port(mixed, socket)))
    session.views.show(Port(mixed, "out"))
    session.select(())
    assert find_orbit_node(session) == ""
    session.select([other])
    assert find_orbit_node(session) == other
    session.views.show(Port("scene", "albedo"))
    assert find_orbit_node(session) == "scene"
    noise = session.apply(AddNode("noise"))
    session.views.show(Port(noise, "value"))
    session.select([ElementId("scene")])
    assert find_orbit_node(session) == ""


def test_a_camera_that_something_else_moves_is_left_alone(editor: Any) -> None:
    session = editor.session
    session.apply(ReplaceGraph("Add", session.graph.add_input("angle", Input(Kind.NUMBER, 1, default=3.0))))
    assert find_orbit_node(session) == "scene"
    graph = session.graph
    linked = replace(graph, links={**graph.links, Port("scene", "azimuth"): Port(INPUTS, "angle")})
    assert find_orbit_node(SimpleNamespace(graph=linked, views=session.views, active="scene")) == ""  # type: ignore[arg-type]


def test_only_where_it_is_wanted_the_mouse_moves_the_camera(editor: Any) -> None:
    viewer = editor.viewer
    assert aim(editor, SIGHT, (200.0, 200.0)).kind == "pan"
    assert aim(editor, SIGHT, (200.0, 200.0), alt=True).kind == "orbit"
    viewer.orbiting = True
    assert aim(editor, SIGHT, (200.0, 200.0)).kind == "orbit"
    assert aim(editor, SIGHT, (200.0, 200.0), shift=True).kind == "track"
    assert aim(editor, SIGHT, (200.0, 200.0), ctrl=True).kind == "measure"
    viewer.scene = ""
    assert aim(editor, SIGHT, (200.0, 200.0), alt=True).kind == "pan"


def test_the_axes_as_they_are_seen() -> None:
    level = Orbit((0.0, 0.0, 0.0), 5.0, 0.0, 0.0).camera(ASPECT)
    found = {name: (at, ahead) for name, at, ahead in axes(level)}
    assert found["x"][0] == pytest.approx((1.0, 0.0)) and found["z"][0] == pytest.approx((0.0, -1.0))
    assert found["y"][1] == pytest.approx(1.0) and axes(level)[0][0] == "y"
    side = Orbit((0.0, 0.0, 0.0), 5.0, 90.0, 0.0).camera(ASPECT)
    assert axes(side)[-1][0] == "x" and {name: at for name, at, _ in axes(side)}["y"] == pytest.approx((1.0, 0.0))
