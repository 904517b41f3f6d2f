"""What the mouse takes hold of on the picture."""

from types import SimpleNamespace
from typing import Any

import pytest
from halation.authoring.commands import AddNode, Disconnect, ReplaceGraph, SetValue
from halation.authoring.edits.element_id import ElementId
from halation.authoring.session import Session
from halation.editor.viewer.geometry import Sight
from halation.editor.viewer.handles import list_gizmos
from halation.editor.viewer.holding import ARM, MouseHold, aim
from halation.editor.viewer.lights import MOST, lamps
from halation.editor.viewer.perspective import project, unproject
from halation.editor.viewer.state import ViewerState
from halation.graph import Port
from halation.nodes import (
    CameraSocket,
    Filter,
    Image,
    Light,
    LightKind,
    LightSet,
    catalogue,
    lights_of,
    look_at,
    number_lights,
)
from halation.resources.sandbox import UNRESTRICTED

SIGHT = Sight((0.0, 0.0), (800, 400), (400, 200), zoom=2.0)
CAMERA = look_at((0.0, -5.0, 0.0), (0.0, 0.0, 0.0), (1.0, 2.0))
MIDDLE, BEHIND, SIDE = Light(place=(0.0, 0.0, 0.0)), Light(place=(0.0, -9.0, 0.0)), Light(place=(1.0, 0.0, 0.0))


class Lit(Filter):
    """Lights that a camera sees."""

    image = Image()
    camera = CameraSocket(0.0)
    lights: LightSet = number_lights((MIDDLE, BEHIND, Light(LightKind.SUN), SIDE))


@pytest.fixture
def editor() -> Any:
    return SimpleNamespace(
        session=Session({**catalogue(), "lamps": Lit}, sandbox=UNRESTRICTED),
        viewer=ViewerState(),
        interface=SimpleNamespace(dragging=False),
        items={},
        preview=SimpleNamespace(camera={Port("lamps", "camera"): CAMERA}.get, find_whole_image=lambda name: None),
        log=SimpleNamespace(attempt=lambda act: act(), add=lambda text: None),
    )


def drag(editor: Any, start: tuple[float, float], end: tuple[float, float], **keys: bool) -> str:
    """Press, move, let go; returns what was held."""
    hold = MouseHold.begin(editor, SIGHT, start, aim(editor, SIGHT, start, **keys))
    hold.drag(SIGHT, end, (end[0] - start[0], end[1] - start[1]))
    hold.release(SIGHT, end)
    return hold.aim.kind


def test_the_picture_itself_is_panned(editor: Any) -> None:
    assert drag(editor, (400.0, 200.0), (430.0, 190.0)) == "pan"
    assert (editor.viewer.zoom, editor.viewer.pan) == (2.0, (30.0, -10.0))


def test_a_click_pans_nothing(editor: Any) -> None:
    assert drag(editor, (400.0, 200.0), (401.0, 200.0)) == "pan"
    assert editor.viewer.zoom == 0.0


def list_grips(editor: Any) -> list[str]:
    return [grip.id for gizmo in list_gizmos(editor, SIGHT, 1.0) for grip in gizmo.grips]


def test_positions_of_the_active_node_can_be_dragged(editor: Any) -> None:
    session = editor.session
    ramp = session.apply(AddNode("ramp"))
    assert list_grips(editor) == ["ramp.start", "ramp.end"]
    assert drag(editor, (2.0, 201.0), (202.0, 101.0)) == "handle"
    assert session.graph.value(Port(ramp, "start")) == pytest.approx((0.25, 0.25))
    assert editor.interface.dragging
    assert session.history.position == 2  # the node, and one step for the whole drag
    editor.viewer.has_gizmos = False
    assert list_grips(editor) == []
    editor.viewer.has_gizmos = True
    session.select(())
    assert list_grips(editor) == []


def test_points_of_a_grid_are_dragged_and_joined_by_lines(editor: Any) -> None:
    session = editor.session
    warp = session.apply(AddNode("grid_warp"))
    lines = [outline.points for gizmo in list_gizmos(editor, SIGHT, 1.0) for outline in gizmo.outlines]
    assert len(list_grips(editor)) == 16 and len(lines) == 8
    assert sum(lines[1], ()) == pytest.approx((0.0, 200 / 3, 400 / 3, 200 / 3, 800 / 3, 200 / 3, 400.0, 200 / 3))
    assert sum(lines[4], ()) == pytest.approx((0.0, 0.0, 0.0, 200 / 3, 0.0, 400 / 3, 0.0, 200.0))
    assert drag(editor, (800 / 3, 400 / 3), (340.0, 160.0)) == "handle"
    assert session.graph.value(Port(warp, "point_22")) == pytest.approx((0.425, 0.4))
    session.undo()
    assert session.graph.value(Port(warp, "point_22")) == pytest.approx((1 / 3, 1 / 3))


def test_curves_of_a_morph_are_dragged_by_their_points(editor: Any) -> None:
    session = editor.session
    warp = session.apply(AddNode("spline_warp"))
    fields = [f"{side}_{end}" for side in ("from", "to") for end in ("start", "middle", "end")]
    assert list_grips(editor) == [f"{warp}.reach", *(f"{warp}.curves.curve_1.{field}" for field in fields)]
    lines = [outline.points for outline in list_gizmos(editor, SIGHT, 1.0)[0].outlines]
    assert len(lines) == 2 and sum((lines[0][0], lines[0][6], lines[0][12]), ()) == pytest.approx(
        (180.0, 70.0, 180.0, 100.0, 180.0, 130.0)
    )
    assert drag(editor, (360.0, 200.0), (300.0, 220.0)) == "handle"
    port = Port(warp, "curves.curve_1.from_middle")
    assert session.graph.value(port) == pytest.approx((0.375, 0.55))
    session.undo()
    assert session.graph.value(port) == pytest.approx((0.45, 0.5))


def test_drags_in_a_row_are_steps_of_their_own(editor: Any) -> None:
    ramp = editor.session.apply(AddNode("ramp"))
    drag(editor, (0.0, 200.0), (200.0, 100.0))
    drag(editor, (200.0, 100.0), (400.0, 100.0))
    editor.session.undo()
    assert editor.session.graph.value(Port(ramp, "start")) == pytest.approx((0.25, 0.25))


def lit(editor: Any, *lights: Light) -> Port:
    """A node with lights that a camera is linked to, selected."""
    session = editor.session
    graph = session.graph.add("lamps", Lit(lights=number_lights(lights)) if lights else Lit())
    graph = graph.add("camera", catalogue()["camera"]()).connect(Port("camera", "camera"), Port("lamps", "camera"))
    session.apply(ReplaceGraph("Add", graph))
    session.select([ElementId("lamps")])
    return Port("lamps", "lights")


def test_lights_in_front_of_the_camera_can_be_dragged(editor: Any) -> None:
    port = lit(editor)
    assert [(lamp.name, lamp.at) for lamp in lamps(editor)] == [
        ("lamp_4", pytest.approx((0.7, 0.5))),
        ("lamp_1", pytest.approx((0.5, 0.5))),
    ]
    steps = editor.session.history.position
    assert drag(editor, (561.0, 201.0), (401.0, 101.0)) == "light"
    light = lights_of(editor.session.graph.value(port))[3]
    assert light.place == pytest.approx((0.0, 0.0, 0.625), abs=1e-4) and editor.interface.dragging
    assert editor.items == {"lamps.lights": "lamp_4"} and lamps(editor)[-1].chosen
    assert editor.session.history.position == steps + 1
    editor.session.undo()
    assert lights_of(editor.session.graph.value(port))[3] == SIDE


def test_without_a_camera_lights_have_no_handles(editor: Any) -> None:
    lit(editor)
    editor.session.apply(Disconnect(Port("lamps", "camera")))
    assert lamps(editor) == ()
    editor.session.undo()
    editor.preview.camera = lambda port: None
    assert lamps(editor) == ()
    editor.session.select(())
    assert lamps(editor) == ()


def test_of_many_lights_the_selected_one_has_a_handle(editor: Any) -> None:
    lit(editor, *(MIDDLE,) * MOST, SIDE)
    assert [lamp.name for lamp in lamps(editor)] == ["lamp_1"]
    editor.items["lamps.lights"] = f"lamp_{MOST + 1}"
    assert [lamp.name for lamp in lamps(editor)] == [f"lamp_{MOST + 1}"]
    lit_port = Port("lamps", "lights")
    editor.session.apply(SetValue(lit_port, {}))
    assert lamps(editor) == ()


def test_a_spot_shows_where_it_shines_to(editor: Any) -> None:
    lit(editor, Light(LightKind.SPOT, (0.0, 0.0, 0.0), (0.0, 0.0, -3.0)), MIDDLE)
    point, spot = lamps(editor)
    assert spot.aims is not None and point.aims is None
    assert spot.aims[0] == pytest.approx((0.5, 0.5 + 3.0 * 2.0 / 5.0)) and spot.aims[1] == pytest.approx(5.0)


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (1.0, 2.0, -3.0), (-4.0, 50.0, 7.0)])
def test_places_on_the_picture_and_back(place: tuple[float, float, float]) -> None:
    seen = project(CAMERA, place)
    assert seen is not None and unproject(CAMERA, *seen) == pytest.approx(place, abs=1e-4)
    assert project(CAMERA, (0.0, -5.0, 1.0)) is None


def test_the_wipe_is_moved_and_turned(editor: Any) -> None:
    viewer = editor.viewer
    assert drag(editor, (401.0, 50.0), (201.0, 90.0)) == "pan"
    viewer.compare, viewer.zoom, viewer.pan = "wipe", 0.0, (0.0, 0.0)
    assert drag(editor, (401.0, 50.0), (201.0, 90.0)) == "wipe"
    assert viewer.wipe == pytest.approx((0.25, 0.6))
    assert drag(editor, (200.0, 240.0 + ARM), (100.0, 240.0)) == "wipe"
    assert viewer.wipe_angle == pytest.approx(90.0)
    assert viewer.wipe == pytest.approx((0.25, 0.6))


def test_a_region_is_drawn_and_its_corner_dragged(editor: Any) -> None:
    viewer = editor.viewer
    viewer.drawing_region = True
    assert drag(editor, (80.0, 40.0), (400.0, 200.0)) == "new region"
    assert viewer.region == pytest.approx((0.1, 0.1, 0.5, 0.5)) and not viewer.drawing_region
    assert drag(editor, (400.0, 200.0), (480.0, 240.0)) == "region"
    assert viewer.region == pytest.approx((0.1, 0.1, 0.6, 0.6))
    viewer.drawing_region = True
    drag(editor, (80.0, 40.0), (81.0, 40.0))
    assert viewer.region is None


def test_ctrl_measures_rectangles_and_sets_markers(editor: Any) -> None:
    viewer = editor.viewer
    assert drag(editor, (80.0, 40.0), (400.0, 200.0), ctrl=True) == "measure"
    assert viewer.measured == pytest.approx((0.1, 0.1, 0.5, 0.5)) and viewer.table and not viewer.markers
    drag(editor, (100.0, 100.0), (100.0, 100.0), ctrl=True)
    assert viewer.markers == (((50 + 0.5) / 400, (50 + 0.5) / 200),)
    drag(editor, (101.0, 101.0), (101.0, 101.0), ctrl=True)
    assert viewer.markers == ()


def test_the_eyedropper_comes_first(editor: Any) -> None:
    editor.session.apply(AddNode("ramp"))
    editor.viewer.picking = "constant.color"
    assert aim(editor, SIGHT, (0.0, 200.0)).kind == "pick"
