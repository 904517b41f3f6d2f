"""Lights that are moved, turned, dropped, added and removed on the picture."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.authoring.commands import AddNode, Connect, Disconnect, ReplaceGraph, SetValue
from halation.authoring.edits.element_id import ElementId
from halation.authoring.session import Session
from halation.editor.viewer.dome import direction_at, direction_of, flat, knob_of, middle_of
from halation.editor.viewer.geometry import Sight
from halation.editor.viewer.holding import MouseHold, aim
from halation.editor.viewer.lamp_outlines import cone, outline, sides
from halation.editor.viewer.lights import (
    Lamp,
    add_light,
    can_add,
    can_remove,
    lamps,
    place_light,
    remove_chosen_light,
    suns,
)
from halation.editor.viewer.perspective import project
from halation.editor.viewer.state import ViewerState
from halation.errors import GraphError
from halation.graph import Port
from halation.nodes import (
    MAX_LIGHTS,
    CameraSocket,
    Field,
    Filter,
    Image,
    Light,
    LightKind,
    LightSet,
    Vector,
    catalogue,
    lights_of,
    look_at,
    number_lights,
)
from halation.resources.sandbox import UNRESTRICTED

SIGHT = Sight((0.0, 0.0), (800, 400), (400, 200), zoom=2.0)
CAMERA = look_at((0.0, -5.0, 0.0), (0.0, 0.0, 0.0), (1.0, 2.0))
TILTED = look_at((3.0, -7.0, 2.5), (0.4, 0.3, 1.1), (1.3, 2.2))
POINT = Light(place=(0.0, 0.0, 0.0))
SPOT = Light(LightKind.SPOT, (1.0, 0.0, 0.0), (0.0, 0.0, -1.0), outer=30.0)
SUN = Light(LightKind.SUN, direction=(0.0, 1.0, 0.0))
BALL = Light(LightKind.SPHERE, (-1.0, 0.0, 0.0), size=0.5)
PORT = Port("lamps", "lights")


class Lit(Filter):
    """Lights that a camera sees."""

    image = Image()
    depth = Field(0.0)
    position = Vector(0.0, width=3)
    camera = CameraSocket(0.0)
    lights: LightSet = number_lights((POINT, SPOT, SUN, BALL))


@pytest.fixture
def editor() -> Any:
    """With a node that has lights and a camera, selected. What is seen has no depth yet."""
    said: list[str] = []
    made = SimpleNamespace(
        session=Session({**catalogue(), "lamps": Lit}, sandbox=UNRESTRICTED),
        viewer=ViewerState(),
        interface=SimpleNamespace(dragging=False),
        items={},
        said=said,
        preview=SimpleNamespace(camera={Port("lamps", "camera"): CAMERA}.get, find_whole_image=lambda name: None),
        log=SimpleNamespace(attempt=lambda act: act(), add=said.append),
    )
    graph = made.session.graph.add("lamps", Lit()).add("camera", catalogue()["camera"]())
    made.session.apply(ReplaceGraph("Add", graph.connect(Port("camera", "camera"), Port("lamps", "camera"))))
    made.session.select([ElementId("lamps")])
    return made


def of(editor: Any) -> tuple[Light, ...]:
    return lights_of(editor.session.graph.value(PORT))


def drag(editor: Any, start: tuple[float, float], end: tuple[float, float], **keys: bool) -> str:
    hold = MouseHold.begin(editor, SIGHT, start, aim(editor, SIGHT, start, **keys))
    hold.drag(SIGHT, end, (1.0, 1.0))
    hold.release(SIGHT, end)
    return hold.aim.kind


def see(editor: Any, socket: str, *values: float) -> None:
    """Let the node know depths or places, the same everywhere."""
    session = editor.session
    source = session.apply(AddNode("scene")) if "scene" not in session.graph.nodes else "scene"
    session.apply(Connect(Port(source, socket), Port("lamps", socket)))
    session.select([ElementId("lamps")])
    known = {"depth": "depth", "place": "position"}
    editor.probe = SimpleNamespace(read_pixel=lambda texture, x, y: values)
    editor.preview.find_whole_image = lambda name: (
        SimpleNamespace(
            port=Port(source, socket),
            full_size=(400, 200),
            texture=SimpleNamespace(size=(400, 200)),
            channels=len(values),
            key=f"{values}",
            revision=1,
            size=(400, 200),
            start=(0, 0),
        )
        if known[name] == socket
        else None
    )


def test_alt_moves_along_the_line_of_sight(editor: Any) -> None:
    assert drag(editor, (400.0, 200.0), (430.0, 200.0 - 400.0 / 3.0), alt=True) == "light depth"
    assert of(editor)[0].place == pytest.approx((0.0, 5.0, 0.0)) and editor.interface.dragging
    assert len(editor.session.history.steps) == 2
    chosen = lamps(editor)[-1]
    place_light(editor, chosen, chosen.at, 2.5)
    assert of(editor)[0].place == pytest.approx((0.0, -2.5, 0.0))


def test_shift_drops_before_a_surface(editor: Any) -> None:
    see(editor, "depth", 10.0)
    assert drag(editor, (400.0, 200.0), (500.0, 200.0), shift=True) == "light drop"
    assert project(CAMERA, of(editor)[0].place) == pytest.approx((0.625, 0.5, 9.5), abs=1e-4)
    at = SIGHT.place(next(lamp.at for lamp in lamps(editor) if lamp.name == "lamp_4"))
    drag(editor, at, (400.0, 200.0), shift=True)
    assert of(editor)[3].place == pytest.approx((0.0, 4.0, 0.0), abs=1e-4)
    see(editor, "depth", 1e10)
    drag(editor, SIGHT.place((0.5, 0.5)), SIGHT.place((0.75, 0.5)), shift=True)
    assert project(CAMERA, of(editor)[3].place) == pytest.approx((0.75, 0.5, 9.0))


def test_places_in_the_world_are_surfaces_where_they_are_seen(editor: Any) -> None:
    see(editor, "position", 0.0, 15.0, 0.0)
    assert drag(editor, (400.0, 200.0), (404.0, 200.0), shift=True) == "light drop"
    assert of(editor)[0].place == pytest.approx((0.0, 14.0, 0.0))
    drag(editor, (400.0, 200.0), (500.0, 200.0), shift=True)  # nothing is there: the place is that of the background
    assert project(CAMERA, of(editor)[0].place) == pytest.approx((0.625, 0.5, 19.0))


def test_a_spot_shines_to_where_its_end_is_dragged(editor: Any) -> None:
    spot = next(lamp for lamp in lamps(editor) if lamp.name == "lamp_2")
    assert spot.aims is not None
    (u, v), depth = spot.aims
    assert (u, v, depth) == pytest.approx(project(CAMERA, (1.0, 0.0, -1.0)))
    assert drag(editor, SIGHT.place((u, v)), SIGHT.place((0.4, 0.3))) == "goal"
    turned = of(editor)[1]
    goal = tuple(np.add(turned.place, turned.direction))
    assert turned.place == SPOT.place and project(CAMERA, goal) == pytest.approx((0.4, 0.3, 5.0), abs=1e-4)
    assert drag(editor, SIGHT.place((0.4, 0.3)), (320.0, 120.0 - 400.0 / 3.0), alt=True) == "goal depth"
    goal = tuple(np.add(of(editor)[1].place, of(editor)[1].direction))
    assert project(CAMERA, goal) == pytest.approx((0.4, 0.3, 10.0), abs=1e-4)
    assert len(editor.session.history.steps) == 3


@pytest.mark.parametrize(
    ("direction", "depth"), [((0.0, 0.0, -1e-6), 5.0), ((0.0, -30.0, 0.0), 1.0), ((0.0, 8.0, 0.0), 13.0)]
)
def test_what_a_spot_shines_to_can_be_seen(direction: Any, depth: float) -> None:
    light = Light(LightKind.SPOT, (1.0, 0.0, 0.0), direction)
    lamp = Lamp(PORT, "lamp_1", light, CAMERA, (0.7, 0.5), 5.0, True)
    assert lamp.aims is not None and lamp.goal is not None
    assert lamp.aims[1] == pytest.approx(depth) and math.dist(lamp.goal, light.place) >= 0.5
    assert Lamp(PORT, "lamp_1", POINT, CAMERA, (0.5, 0.5), 5.0, True).aims is None


@pytest.mark.parametrize("kind", [LightKind.RECTANGLE, LightKind.DISC, LightKind.TUBE])
def test_the_edges_of_areas_are_drawn_where_they_shine_from(kind: LightKind) -> None:
    light = Light(kind, (1.0, 2.0, 3.0), (0.3, -1.0, -0.4), size=0.4, width=2.0, height=0.6, length=1.5, roll=25.0)
    aim = np.array(light.direction) / np.linalg.norm(light.direction)
    away = np.concatenate([np.subtract(edge, light.place) for edge in outline(light)])
    along = away @ aim
    if kind is LightKind.TUBE:
        np.testing.assert_allclose(np.abs(along), 0.75, atol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(away - np.outer(along, aim), axis=1), 0.4, atol=1e-6)
        return
    np.testing.assert_allclose(along, 0.0, atol=1e-6)
    lengths = np.linalg.norm(away, axis=1)
    np.testing.assert_allclose(lengths, 0.4 if kind is LightKind.DISC else math.hypot(1.0, 0.3), atol=1e-6)
    if kind is LightKind.RECTANGLE:
        tilt = np.degrees(
            np.arcsin((away[1] - away[0])[2] / 2.0 / np.linalg.norm(np.cross(aim, np.cross(aim, (0, 0, 1)))))
        )
        assert tilt == pytest.approx(25.0, abs=1e-4)


def test_a_rectangle_is_turned_by_its_goal() -> None:
    light = Light(LightKind.RECTANGLE, (1.0, 0.0, 0.0), (0.0, 0.0, -1.0))
    lamp = Lamp(PORT, "lamp_1", light, CAMERA, (0.7, 0.5), 5.0, True)
    assert lamp.goal == pytest.approx((1.0, 0.0, -1.0))


def test_a_cone_is_as_wide_as_its_angle() -> None:
    lamp = Lamp(PORT, "lamp_1", SPOT, CAMERA, (0.7, 0.5), 5.0, True)
    rim = np.subtract(cone(lamp, 30.0), SPOT.place)
    cosines = rim @ np.array(SPOT.direction) / np.linalg.norm(rim, axis=1)
    np.testing.assert_allclose(np.degrees(np.arccos(cosines)), 30.0)
    corners = [(math.cos(turn), math.sin(turn)) for turn in np.linspace(0.0, 2.0 * math.pi, 64, endpoint=False)]
    touched = sides((2.0, 0.0), corners)  # tangents from a distance of twice the radius: 60 degrees around
    assert sorted(math.degrees(math.atan2(y, x)) for x, y in touched) == pytest.approx([-60.0, 60.0], abs=6.0)
    assert sides((0.1, 0.2), corners) == ()


@pytest.mark.parametrize("camera", [CAMERA, TILTED])
def test_the_dome_has_every_direction_once(camera: Any) -> None:
    assert flat(camera, camera.forward) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert flat(camera, tuple(-part for part in camera.right)) == pytest.approx((0.5, 0.0), abs=1e-6)
    assert flat(camera, tuple(-part for part in camera.down)) == pytest.approx((0.0, 0.5), abs=1e-6)
    assert math.hypot(*flat(camera, tuple(-part for part in camera.forward))) == pytest.approx(1.0, abs=1e-6)
    for eye in np.random.default_rng(9).uniform(-5.0, 5.0, (300, 3)):  # products of unit vectors may be above 1
        other = look_at(tuple(eye), (0.1, 0.2, 0.3), (1.0, 1.0))
        assert math.hypot(*flat(other, other.forward)) < 1e-6
        assert math.hypot(*flat(other, tuple(-part for part in other.forward))) == pytest.approx(1.0, abs=1e-6)
    for direction in np.random.default_rng(1).normal(size=(20, 3)):
        unit = direction / np.linalg.norm(direction)
        assert direction_of(camera, flat(camera, tuple(direction))) == pytest.approx(tuple(unit), abs=2e-5)


def test_a_sun_is_dragged_on_the_dome(editor: Any) -> None:
    (sun,) = suns(editor)
    x, y = knob_of(SIGHT, 1.0, CAMERA, sun.light.direction)
    assert (x, y) == pytest.approx(middle_of(SIGHT, 1.0))
    assert drag(editor, (x + 2.0, y), (x + 2.0 + 23.0, y)) == "sun"
    assert of(editor)[2].direction == pytest.approx((-1.0, 0.0, 0.0), abs=1e-5)
    assert direction_at(SIGHT, 1.0, CAMERA, (x + 500.0, y)) == pytest.approx((0.0, -1.0, 0.0), abs=1e-5)
    assert editor.items == {"lamps.lights": "lamp_3"} and of(editor)[2].intensity == SUN.intensity


def test_lights_are_added_and_removed(editor: Any) -> None:
    assert can_add(editor) and can_remove(editor)
    editor.items["lamps.lights"] = "lamp_2"
    add_light(editor, (0.7, 0.5))
    assert [light.kind.name for light in of(editor)] == ["POINT", "SPOT", "SUN", "SPHERE", "POINT"]
    assert of(editor)[4].place == pytest.approx((1.0, 0.0, 0.0)) and editor.items["lamps.lights"] == "point_1"
    see(editor, "depth", 10.0)
    add_light(editor, (0.5, 0.5))
    assert of(editor)[5].place == pytest.approx((0.0, 4.5, 0.0))
    for left in (5, 4, 3, 2, 1, 0):
        remove_chosen_light(editor)
        assert len(of(editor)) == left
    assert not can_remove(editor) and len(editor.session.history.steps) == 11
    editor.session.apply(SetValue(PORT, number_lights((POINT,) * MAX_LIGHTS)))
    with pytest.raises(GraphError, match="there is no room for another light"):
        add_light(editor, (0.5, 0.5))
    assert len(of(editor)) == MAX_LIGHTS
    editor.session.apply(Disconnect(Port("lamps", "camera")))
    assert not can_add(editor) and can_remove(editor) and suns(editor) == ()
