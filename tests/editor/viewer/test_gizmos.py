"""Gizmos: a grip that is dragged ends under the mouse, and the values mean the same to the node."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.editor.viewer.box_gizmos import RectangleGizmo, TransformGizmo
from halation.editor.viewer.geometry import Point
from halation.editor.viewer.gizmos import Gizmo, PlaceGizmo, SizeGizmo, TurnGizmo
from halation.editor.viewer.snapping import SnapGuide, Snapping
from halation.graph import Port
from halation.nodes.distort.transform import Transform
from hypothesis import given
from hypothesis import strategies as st

SIZE = (320.0, 180.0)
FREE, SNAPS = Snapping(SIZE), Snapping(SIZE, 4.0)
PORT = Port("node", "value")
NAMES = frozenset({"position", "rotation", "scale", "skew"})


def make_transform(**values) -> TransformGizmo:
    start = {"position": (0.0, 0.0), "rotation": 0.0, "scale": (1.0, 1.0), "skew": (0.0, 0.0), "pivot": (160.0, 90.0)}
    return TransformGizmo("node", SIZE, arm=30.0, names=NAMES, **(start | values))


def find_grip(gizmo: Gizmo, part: str) -> Point:
    return next(grip.at for grip in gizmo.grips if grip.part == part)


def set_values(gizmo: TransformGizmo, part: str, to: Point, **options) -> TransformGizmo:
    """The gizmo after a drag."""
    drag = gizmo.drag(part, to, options.pop("snapping", FREE), **options)
    values = {port.socket: value for port, value in drag.values.items()}
    facts = {name: values.get(name, getattr(gizmo, name)) for name in NAMES}
    return make_transform(pivot=gizmo.pivot, **facts)


numbers = st.floats(-1.0, 1.0)
moved = st.builds(
    lambda x, y, turn, wide, high, lean, fall, left, top: make_transform(
        position=(60.0 * x, 40.0 * y),
        rotation=180.0 * turn,
        scale=(math.copysign(0.3 + abs(wide), wide), math.copysign(0.3 + abs(high), high)),
        skew=(30.0 * lean, 30.0 * fall),
        pivot=(160.0 + 90.0 * left, 90.0 + 50.0 * top),
    ),
    *[numbers] * 9,
)


@given(moved, st.floats(0.0, SIZE[0]), st.floats(0.0, SIZE[1]))
def test_the_frame_is_where_the_node_draws_it(gizmo: TransformGizmo, x: float, y: float) -> None:
    node = Transform(
        position=gizmo.position,
        rotation=math.radians(gizmo.rotation),
        scale=gizmo.scale,
        skew=(math.radians(gizmo.skew[0]), math.radians(gizmo.skew[1])),
    )
    back = np.array([*node.backward(gizmo.pivot), 0.0, 0.0, 1.0]).reshape(3, 3)
    assert back @ [*gizmo.map((x, y)), 1.0] == pytest.approx([x, y, 1.0], abs=1e-6)


@given(moved, st.sampled_from(["nw", "ne", "se", "sw", "move", "x", "y"]), numbers, numbers)
def test_what_is_dragged_follows_the_mouse(gizmo: TransformGizmo, part: str, x: float, y: float) -> None:
    start = find_grip(gizmo, part)
    to = start[0] + 25.0 * x, start[1] + 25.0 * y
    after = set_values(gizmo, part, to)
    place = find_grip(after, part)
    if part in "xy":  # a skew moves its grip along one line only, and stops before nothing is left
        before = abs(after.skew[0 if part == "x" else 1])
        assert before >= 79.9 or math.dist(place, to) <= math.dist(start, to) + 0.1
    else:
        smallest = min(map(abs, after.scale))
        assert math.dist(place, to) < 0.05 or smallest <= 0.01


@given(moved, st.sampled_from(["nw", "ne", "se", "sw"]), numbers)
def test_constrained_corners_keep_proportions(gizmo: TransformGizmo, part: str, x: float) -> None:
    start = find_grip(gizmo, part)
    after = set_values(gizmo, part, (start[0] + 20.0 * x, start[1] - 10.0 * x), is_constrained=True)
    share = gizmo.scale[0] / gizmo.scale[1]
    assert after.scale[0] == pytest.approx(share * after.scale[1], abs=2e-3 * (1.0 + abs(share)))


def test_a_quarter_turn_by_its_arm() -> None:
    gizmo = make_transform()
    assert find_grip(gizmo, "turn") == pytest.approx((160.0, -30.0))
    after = set_values(gizmo, "turn", (400.0, 90.0))
    assert after.rotation == 90.0 and find_grip(after, "turn")[0] > 160.0
    assert set_values(gizmo, "turn", (400.0, 85.0), snapping=SNAPS).rotation == 90.0
    assert set_values(gizmo, "turn", (300.0, -20.0), is_constrained=True).rotation % 15.0 == 0.0


def test_moving_snaps_the_middle_and_the_edges() -> None:
    gizmo = make_transform(scale=(0.5, 0.5), position=(30.0, 30.0))
    drag = gizmo.drag("move", (192.0, 93.0), SNAPS)
    assert drag.values[Port("node", "position")] == (0.0, 0.0)
    assert set(drag.guides) == {SnapGuide("x", 160.0), SnapGuide("y", 90.0)}
    assert gizmo.drag("move", (192.0, 93.0), FREE).guides == ()
    left = gizmo.drag("move", (112.0, 70.0), SNAPS)  # the left edge lies on that of the picture
    assert SnapGuide("x", 0.0) in left.guides


@pytest.mark.parametrize("fraction", [0.0, 1 / 3, 0.5, 2 / 3, 1.0])
def test_places_snap_to_edges_thirds_and_the_middle(fraction: float) -> None:
    gizmo = PlaceGizmo(PORT, (0.21, 0.43), SIZE)
    to = fraction * SIZE[0] + 3.0, 77.0
    assert gizmo.drag("", to, SNAPS).values[PORT] == (round(fraction, 5), round(77.0 / SIZE[1], 5))
    assert gizmo.drag("", to, FREE).values[PORT] == pytest.approx((to[0] / SIZE[0], 77.0 / SIZE[1]), abs=1e-5)


def test_constrained_places_keep_an_axis() -> None:
    gizmo = PlaceGizmo(PORT, (0.2, 0.4), SIZE)
    assert gizmo.drag("", (200.0, 80.0), FREE, is_constrained=True).values[PORT] == (0.625, 0.4)


@given(st.floats(0.0, 1.0), st.floats(-60.0, 60.0))
def test_a_length_grows_by_as_much_as_the_mouse_moves_out(value: float, out: float) -> None:
    gizmo = SizeGizmo(PORT, value, 180.0, (160.0, 90.0), 30.0, 28.0, 0.0, 10.0)
    x, y = gizmo.grips[0].at
    turn = math.radians(30.0)
    drag = gizmo.drag("", (x + out * math.cos(turn), y + out * math.sin(turn)), FREE)
    assert drag.values[PORT] == pytest.approx(max(value + out / 180.0, 0.0), abs=1e-4)


@given(st.floats(-700.0, 700.0), st.floats(-170.0, 170.0), st.booleans())
def test_a_dial_turns_with_the_mouse(value: float, by: float, is_clockwise: bool) -> None:
    gizmo = TurnGizmo(PORT, value, (160.0, 90.0), 60.0, is_clockwise, -720.0, 720.0)
    turn = math.radians((value + by) * (1.0 if is_clockwise else -1.0))
    drag = gizmo.drag("", (160.0 + 90.0 * math.cos(turn), 90.0 + 90.0 * math.sin(turn)), FREE)
    angle = drag.values[PORT]
    assert math.remainder(angle - value - by, 360.0) == pytest.approx(0.0, abs=0.01)
    if abs(value + by) < 720.0:
        assert angle == pytest.approx(value + by, abs=0.01)


def test_a_rectangle_is_dragged_by_corners_sides_and_its_middle() -> None:
    top_left, bottom_right = Port("node", "top_left"), Port("node", "bottom_right")
    gizmo = RectangleGizmo(top_left, bottom_right, (0.2, 0.2, 0.6, 0.7), (0.0, 0.0), SIZE)

    def drag(part: str, to: Point, snapping: Snapping = FREE, **options) -> tuple[float, ...]:
        values = gizmo.drag(part, to, snapping, **options).values
        return (*values[top_left], *values[bottom_right])

    assert drag("se", (240.0, 150.0)) == pytest.approx((0.2, 0.2, 0.75, 0.83333))
    assert drag("nw", (-50.0, 18.0)) == pytest.approx((0.0, 0.1, 0.6, 0.7))
    assert drag("e", (160.0, 3.0)) == pytest.approx((0.2, 0.2, 0.5, 0.7))
    assert drag("w", (104.0, 3.0), SNAPS) == pytest.approx((0.33333, 0.2, 0.6, 0.7))
    assert drag("move", (1000.0, 81.0)) == pytest.approx((0.6, 0.2, 1.0, 0.7))
    left, top, right, bottom = drag("se", (300.0, 100.0), is_constrained=True)
    assert (right - left) / (bottom - top) == pytest.approx(0.4 / 0.5, rel=1e-4)


def test_a_rectangle_over_what_it_left() -> None:
    """The picture shows only the rectangle: its corners are those of the picture, and count when released."""
    ports = Port("node", "top_left"), Port("node", "bottom_right")
    gizmo = RectangleGizmo(*ports, (0.25, 0.25, 0.75, 0.75), (-160.0, -90.0), (640.0, 360.0), is_deferred=True)
    assert find_grip(gizmo, "nw") == (0.0, 0.0) and find_grip(gizmo, "se") == SIZE
    assert gizmo.drag("se", (160.0, 90.0), FREE).values[ports[1]] == (0.5, 0.5)
    assert gizmo.drag("nw", (-80.0, -45.0), FREE).values[ports[0]] == (0.125, 0.125)


@pytest.mark.parametrize(
    ("rotation", "move", "turn"),
    [
        (0.0, (190.0, 90.0), (160.0, -30.0)),
        (90.0, (160.0, 120.0), (280.0, 90.0)),
        (180.0, (130.0, 90.0), (160.0, 210.0)),
    ],
)
def test_grips_lie_an_arm_beside_the_middle_and_above_the_edge(rotation: float, move: Point, turn: Point) -> None:
    gizmo = make_transform(rotation=rotation)
    assert find_grip(gizmo, "move") == pytest.approx(move) and find_grip(gizmo, "turn") == pytest.approx(turn)
    small = make_transform(rotation=rotation, scale=(0.25, 0.5))
    assert math.dist(find_grip(small, "move"), (160.0, 90.0)) == pytest.approx(30.0), "its arm is as long on the screen"


def test_grips_of_a_frame_that_was_not_moved_are_on_its_border():
    gizmo = make_transform()
    places = {"nw": (0.0, 0.0), "n": (160.0, 0.0), "ne": (320.0, 0.0), "e": (320.0, 90.0), "se": (320.0, 180.0)}
    places |= {"s": (160.0, 180.0), "sw": (0.0, 180.0), "w": (0.0, 90.0), "x": (240.0, 0.0), "y": (0.0, 135.0)}
    places |= {"turn": (160.0, -30.0)}
    assert {grip.part: grip.at for grip in gizmo.grips if grip.part != "move"} == places


@pytest.mark.parametrize(
    ("value", "low", "pulled", "wanted"),
    [
        (2.0, 0.0, 0.25, 0.25), (2.0, 0.0, -3.0, 0.0), (2.0, -5.0, -3.0, 0.0), (2.0, 0.5, 0.1, 0.5),
        (2.0, 0.0, 12.0, 10.0), (0.5, -5.0, -3.0, 0.0), (0.0, -5.0, -3.0, 0.0),
        (-2.0, -5.0, 0.25, -0.25), (-2.0, -5.0, 3.0, -3.0), (-2.0, -5.0, 7.0, -5.0),
    ],
)  # fmt: skip
def test_a_dragged_length_keeps_its_sign_and_its_limits(value: float, low: float, pulled: float, wanted: float) -> None:
    """`pulled` is how far from the center the mouse is, in units, beyond the least distance of the grip."""
    gizmo = SizeGizmo(PORT, value, 20.0, (160.0, 90.0), 0.0, 28.0, low, 10.0)
    assert gizmo.drag("size", (160.0 + 28.0 + 20.0 * pulled, 90.0), FREE).values == {PORT: wanted}
