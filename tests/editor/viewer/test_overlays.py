"""What is drawn over the picture: where it is, that it moves with its panel and grows with the interface."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from drawn_shapes import DrawnShapes
from halation.editor.theme.palette import PALETTES
from halation.editor.theme.style import EM, u32
from halation.editor.viewer import brush_lines, gizmo_lines, lamp_lines, overlays, strokes
from halation.editor.viewer.geometry import Sight
from halation.editor.viewer.gizmos import GizmoOutline
from halation.nodes import PaintTool

ORIGIN, PANEL, PICTURE, ZOOM, PAN = (100.0, 60.0), (640, 480), (64, 32), 8.0, (24.0, -8.0)
"""The picture is 512x256 on a panel of 640x480: its left top is (100 + 320 - 256 + 24, 60 + 240 - 128 - 8)."""

LEFT, TOP = 188.0, 164.0
MOUSE = (300.0, 260.0)
COLOR = (0.2, 0.4, 0.6)


class Stage:
    """A panel with a picture, whose text has the size 16 times `scale`, and the pointer over it."""

    def __init__(
        self, monkeypatch: pytest.MonkeyPatch, scale: float = 1.0, shift: tuple[float, float] = (0, 0)
    ) -> None:
        def place(at: tuple[float, float]) -> tuple[float, float]:
            return at[0] * scale + shift[0], at[1] * scale + shift[1]

        self.lines = DrawnShapes(16.0 * scale)
        width, height = round(PANEL[0] * scale), round(PANEL[1] * scale)
        self.sight = Sight(place(ORIGIN), (width, height), PICTURE, ZOOM * scale, (PAN[0] * scale, PAN[1] * scale))
        mouse = place(MOUSE)
        imgui = SimpleNamespace(
            get_window_draw_list=lambda: self.lines,
            calc_text_size=self.lines.measure,
            get_mouse_pos=lambda: SimpleNamespace(x=mouse[0], y=mouse[1]),
            get_font=lambda: None,
            get_font_size=lambda: EM * scale,
        )
        for module in (overlays, strokes, brush_lines, lamp_lines, gizmo_lines):
            monkeypatch.setattr(module, "imgui", imgui)
            if hasattr(module, "ui_scale"):
                monkeypatch.setattr(module, "ui_scale", lambda: scale)
        brush = SimpleNamespace(stroke=None, hardness=0.5, tool=PaintTool.CLONE, needs_place=True, copied=(0.5, 0.25))
        monkeypatch.setattr(brush_lines, "paints", lambda context: True)
        monkeypatch.setattr(brush_lines, "measure_brush", lambda context, sight: 30.0 * scale)
        stroke = SimpleNamespace(rows=[(0.0, 0.0, 1.0), (0.5, 0.5, 1.0), (1.0, 0.0, 1.0)], position=(0.125, 0.25))
        monkeypatch.setattr(brush_lines, "find_chosen_stroke", lambda context: stroke)
        monkeypatch.setattr(brush_lines, "translate", lambda text: text)
        guides = [SimpleNamespace(axis="x", at=16.0), SimpleNamespace(axis="y", at=8.0)]
        viewer = SimpleNamespace(wipe=(0.25, 0.5), wipe_angle=90.0, brush=brush, hovered=True, guides=guides)
        self.context: Any = SimpleNamespace(places={}, viewer=viewer, palette=PALETTES["dark"])


def draw_grid(stage: Stage) -> None:
    overlays._grid(stage.lines, stage.sight)  # pyright: ignore


def draw_region(stage: Stage) -> None:
    overlays._region(stage.context, stage.lines, stage.sight.rectangle((0.25, 0.25, 0.75, 1.0)))  # pyright: ignore


def draw_wipe(stage: Stage) -> None:
    overlays._wipe(stage.context, stage.lines, stage.sight)  # pyright: ignore


def draw_marker(stage: Stage) -> None:
    overlays._marker(stage.lines, stage.sight.place((0.5, 0.5)), "12")  # pyright: ignore


def draw_progress(stage: Stage) -> None:
    overlays.draw_progress(stage.context, stage.sight, 0.25)


def draw_message(stage: Stage) -> None:
    overlays.draw_message(stage.context, stage.sight, "Nothing to see", COLOR, dim=True)


def draw_badge(stage: Stage) -> None:
    overlays.draw_badge(stage.context, stage.sight, "half", COLOR)


def draw_circle(stage: Stage) -> None:
    strokes.draw_dashed_circle(stage.lines, stage.sight.place((0.5, 0.5)), 40.0 * stage.lines.em / 16.0, COLOR, 2.0)  # pyright: ignore


def draw_closed_path(stage: Stage) -> None:
    points = [stage.sight.place(at) for at in ((0.0, 0.0), (1.0, 0.0), (0.5, 1.0))]
    strokes.draw_path(stage.lines, points, COLOR, closed=True)  # pyright: ignore


def draw_brush(stage: Stage) -> None:
    brush_lines.draw_brush(stage.context, stage.lines, stage.sight)  # pyright: ignore


def draw_guides(stage: Stage) -> None:
    gizmo_lines._draw_guides(stage.context, stage.lines, stage.sight)  # pyright: ignore


def draw_outline(stage: Stage) -> None:
    outline = GizmoOutline(points=((16.0, 8.0),), radius=4.0)
    gizmo_lines._draw_outline(stage.lines, stage.sight, outline)  # pyright: ignore


def draw_knob(stage: Stage) -> None:
    light: Any = SimpleNamespace(color=(1.0, 0.5, 0.25), on=True, intensity=-1.0)
    lamp_lines._knob(stage.lines, stage.sight.place((0.5, 0.5)), light, (1.0, 1.0, 1.0))  # pyright: ignore


DRAWINGS = (draw_grid, draw_region, draw_wipe, draw_marker, draw_progress, draw_message, draw_badge, draw_circle,
            draw_closed_path, draw_brush, draw_guides, draw_outline, draw_knob)  # fmt: skip
HAIRLINES = (draw_grid, draw_marker, draw_message, draw_badge, draw_brush)
"""What has lines that stay as thin as they are on a larger interface."""


@pytest.mark.parametrize("draw", DRAWINGS)
def test_what_is_drawn_moves_with_its_panel(monkeypatch, draw: Callable[[Stage], None]) -> None:
    here, there = Stage(monkeypatch), Stage(monkeypatch, shift=(37.0, -22.0))
    draw(there)
    here = Stage(monkeypatch)
    draw(here)
    assert here.lines.shapes and [shape.change(1.0, (37.0, -22.0)) for shape in here.lines.shapes] == there.lines.shapes


@pytest.mark.parametrize("draw", [draw for draw in DRAWINGS if draw is not draw_region])  # its frame is as thin, too
def test_what_is_drawn_grows_with_the_interface(monkeypatch, draw: Callable[[Stage], None]) -> None:
    large = Stage(monkeypatch, scale=2.0)
    draw(large)
    small = Stage(monkeypatch)
    draw(small)
    grown = [shape.change(2.0, (0.0, 0.0)) for shape in small.lines.shapes]
    assert [shape.points for shape in grown] == [shape.points for shape in large.lines.shapes]
    assert draw in HAIRLINES or grown == large.lines.shapes


def test_a_region_has_larger_grips_on_a_larger_interface(monkeypatch) -> None:
    for scale in (1.0, 2.0):
        stage = Stage(monkeypatch, scale)
        draw_region(stage)
        grip = stage.lines.list_kinds("filled rect")[0].points
        arm = stage.lines.list_kinds("line")[0].points
        assert (grip[1][0] - grip[0][0], arm[1][0] - arm[0][0]) == (7.0 * scale, 10.0 * scale)


def test_the_edge_of_the_frame_is_that_of_the_picture(monkeypatch) -> None:
    stage = Stage(monkeypatch)
    overlays.draw_outline(stage.context, stage.sight)
    assert {shape.points for shape in stage.lines.shapes} == {((LEFT, TOP), (LEFT + 512.0, TOP + 256.0))}
    assert stage.context.places == {"viewer frame": (LEFT, TOP, LEFT + 512.0, TOP + 256.0)}


def run(monkeypatch: pytest.MonkeyPatch, draw: Callable[[Stage], None]) -> Stage:
    stage = Stage(monkeypatch)
    draw(stage)
    return stage


def test_a_grid_has_a_line_at_each_edge_of_the_visible_pixels(monkeypatch) -> None:
    stage = run(monkeypatch, draw_grid)
    across = [shape.points for shape in stage.lines.shapes if shape.points[0][0] == shape.points[1][0]]
    down = [shape.points for shape in stage.lines.shapes if shape.points[0][1] == shape.points[1][1]]
    assert across == [((LEFT + 8.0 * x, TOP), (LEFT + 8.0 * x, TOP + 256.0)) for x in range(65)]
    assert down == [((LEFT, TOP + 8.0 * y), (LEFT + 512.0, TOP + 8.0 * y)) for y in range(33)]


def test_of_a_larger_picture_only_what_is_seen_has_a_grid(monkeypatch) -> None:
    stage = Stage(monkeypatch)
    stage.sight = Sight(ORIGIN, PANEL, (1000, 800), 16.0, (0.0, 0.0))
    assert overlays._visible(stage.sight) == (480, 385, 520, 415)  # pyright: ignore
    draw_grid(stage)
    assert len(stage.lines.shapes) == 41 + 31
    for shape in stage.lines.shapes:
        assert all(100 <= x <= 740 and 60 <= y <= 540 for x, y in shape.points)


def test_a_region_has_eight_grips_and_a_cross_in_its_middle(monkeypatch) -> None:
    stage = run(monkeypatch, draw_region)
    box = (LEFT + 128.0, TOP + 64.0, LEFT + 384.0, TOP + 256.0)
    assert stage.context.places == {"viewer region": box}
    xs, ys = (box[0], (box[0] + box[2]) / 2, box[2]), (box[1], (box[1] + box[3]) / 2, box[3])
    places = [(x, y) for x in xs for y in ys if (x, y) != (xs[1], ys[1])]
    for shapes in (stage.lines.list_kinds("filled rect")[::2], stage.lines.list_kinds("filled rect")[1::2]):
        assert [((a[0] + b[0]) / 2, (a[1] + b[1]) / 2) for a, b in (shape.points for shape in shapes)] == places
    black, white = stage.lines.list_kinds("filled rect")[:2]
    assert black.points[0][0] + 1 == white.points[0][0] and black.points[1][1] - 1 == white.points[1][1]
    arms = {shape.points for shape in stage.lines.list_kinds("line")}
    assert arms == {((xs[1] - 5, ys[1]), (xs[1] + 5, ys[1])), ((xs[1], ys[1] - 5), (xs[1], ys[1] + 5))}


def test_a_wipe_names_its_sides_across_its_line(monkeypatch) -> None:
    """The line turns clockwise from down: at 90 degrees it runs to the left, and what was left of it, A, is above."""
    stage = run(monkeypatch, draw_wipe)
    x, y = LEFT + 128.0, TOP + 128.0
    for shape in stage.lines.list_kinds("line"):
        assert shape.points[0] == (x, y) and shape.points[1] == pytest.approx((x - overlays.ARM, y))
    texts = {shape.text: shape.points[0] for shape in stage.lines.list_kinds("text")}
    size = stage.lines.measure("A")
    assert texts["A"][0] == texts["B"][0] == x - size.x / 2
    assert {name: at[1] + size.y / 2 - y for name, at in texts.items()} == {"A": -18.0, "B": 18.0}
    assert stage.context.places["viewer wipe"] == (x - 6, y - 6, x + 6, y + 6)


def test_a_marker_has_its_number_at_the_upper_right(monkeypatch) -> None:
    stage = run(monkeypatch, draw_marker)
    middle = (LEFT + 256.0, TOP + 128.0)
    (text,) = stage.lines.list_kinds("text")
    assert text.points == ((middle[0] + 10 - 8, middle[1] - 10 - 8),) and text.text == "12"
    assert {end for shape in stage.lines.list_kinds("line") for end in shape.points} == {
        (middle[0] - 6, middle[1]), (middle[0] + 6, middle[1]), (middle[0], middle[1] - 6), (middle[0], middle[1] + 6),
    }  # fmt: skip


def test_progress_is_a_part_of_the_upper_edge(monkeypatch) -> None:
    whole, part = run(monkeypatch, draw_progress).lines.shapes
    assert whole.points == ((100.0, 60.0), (740.0, 62.0)) and part.points == ((100.0, 60.0), (260.0, 62.0))


def test_a_message_is_in_the_middle_and_its_box_around_it(monkeypatch) -> None:
    stage = run(monkeypatch, draw_message)
    dim, filled, edge, text = stage.lines.shapes
    assert dim.points == ((100.0, 60.0), (740.0, 540.0))
    assert text.points == ((420.0 - 14 * 4, 300.0 - 8),) and text.lengths == (EM, 520.0) and text.color == u32(COLOR)
    assert filled.points == edge.points == ((352.0, 280.0), (488.0, 320.0))
    assert stage.context.places["viewer message"] == (352.0, 280.0, 488.0, 320.0)


def test_a_narrow_panel_wraps_a_message_and_a_narrower_one_has_none(monkeypatch) -> None:
    for width, wrapped in ((200, 152.0), (88, 40.0), (87, None)):
        stage = Stage(monkeypatch)
        stage.sight = Sight(ORIGIN, (width, 480), PICTURE, 1.0)
        overlays.draw_message(stage.context, stage.sight, "A sentence that is too long for this", COLOR)
        assert [shape.lengths[1] for shape in stage.lines.list_kinds("text")] == ([] if wrapped is None else [wrapped])


def test_a_badge_is_in_the_upper_right_corner_with_its_text_inside(monkeypatch) -> None:
    stage = Stage(monkeypatch)
    left, top, right, bottom = overlays.draw_badge(stage.context, stage.sight, "half", COLOR)
    (text,) = stage.lines.list_kinds("text")
    (x, y), size = text.points[0], stage.lines.measure("half")
    assert (right, top) == (735.0, 70.0)  # 5 and 10 from the corner
    assert x - left == right - (x + size.x) == 5.0
    assert y - top == bottom - (y + size.y) == 2.5
    assert all(
        shape.points == ((left, top), (right, bottom)) for shape in stage.lines.list_kinds("rect", "filled rect")
    )


def test_dashes_fill_half_of_a_circle(monkeypatch) -> None:
    stage = run(monkeypatch, draw_circle)
    arcs = stage.lines.list_kinds("arc")
    spans = [tuple(map(float, shape.text.split()[1:])) for shape in arcs[: len(arcs) // 2]]
    assert sum(end - start for start, end in spans) == pytest.approx(math.pi, abs=1e-4)
    assert all(end - start == pytest.approx(spans[0][1], abs=2e-6) for start, end in spans)
    assert [start for start, _ in spans] == pytest.approx(
        [2.0 * math.pi * i / len(spans) for i in range(len(spans))], abs=1e-5
    )
    assert 40.0 * spans[0][1] == pytest.approx(5.0, abs=0.2)  # a dash is five units long
    assert all(shape.lengths == (80.0, 40.0) and shape.points == ((444.0, 292.0),) for shape in arcs)


@pytest.mark.parametrize(("radius", "count"), [(0.1, 8), (1e4, 360)])
def test_circles_have_eight_to_360_dashes(monkeypatch, radius: float, count: int) -> None:
    stage = Stage(monkeypatch)
    strokes.draw_dashed_circle(stage.lines, (0.0, 0.0), radius, COLOR)  # pyright: ignore
    assert len(stage.lines.list_kinds("arc")) == 2 * count


@pytest.mark.parametrize(("closed", "count"), [(True, 3), (False, 2)])
def test_a_path_joins_neighbors_and_its_ends_where_it_is_closed(monkeypatch, closed: bool, count: int) -> None:
    stage, points = Stage(monkeypatch), [(0.0, 0.0), (9.0, 0.0), (5.0, 7.0)]
    strokes.draw_path(stage.lines, points, COLOR, 2.0, closed=closed)  # pyright: ignore
    edges = [(points[0], points[1]), (points[1], points[2]), (points[2], points[0])][:count]
    assert [shape.points for shape in stage.lines.shapes] == edges * 2
    assert [shape.lengths for shape in stage.lines.shapes] == [(3.5,)] * count + [(2.0,)] * count  # black below it


def test_the_brush_is_a_circle_at_the_pointer_with_its_hard_part_inside(monkeypatch) -> None:
    stage = run(monkeypatch, draw_brush)
    ellipses = stage.lines.list_kinds("ellipse")
    assert all(shape.points == (MOUSE,) and shape.text == "0.0 0" for shape in ellipses)
    assert [shape.lengths[:2] for shape in ellipses] == [(30.0, 30.0), (30.0, 30.0), (15.0, 15.0)]
    crossing = [shape.points for shape in stage.lines.list_kinds("line") if shape.points[0][1] == shape.points[1][1]]
    assert ((444.0 - 7.0, 228.0), (444.0 + 7.0, 228.0)) in crossing  # what is copied: the middle, a quarter down
    start, middle = (LEFT + 64.0, TOP + 64.0), (LEFT + 320.0, TOP + 192.0)
    assert (start, middle) in [shape.points for shape in stage.lines.list_kinds("line")]
    (label,) = stage.lines.list_kinds("text")
    assert label.points[0][1] + 8.0 == MOUSE[1] + 30.0 + 14.0


def test_a_clone_copies_from_beside_the_pointer(monkeypatch) -> None:
    stage = Stage(monkeypatch)
    stage.context.viewer.brush = SimpleNamespace(copied=None, offset=(0.25, -0.125))
    brush_lines._draw_copied(stage.context, stage.lines, stage.sight)  # pyright: ignore
    assert stage.lines.shapes[0].points == ((300.0 + 128.0 - 7.0, 260.0 - 32.0), (300.0 + 128.0 + 7.0, 260.0 - 32.0))


def test_guides_cross_the_whole_picture(monkeypatch) -> None:
    across, down = run(monkeypatch, draw_guides).lines.shapes[::2]
    assert across.points == ((LEFT + 128.0, TOP), (LEFT + 128.0, TOP + 256.0))
    assert down.points == ((LEFT, TOP + 64.0), (LEFT + 512.0, TOP + 64.0))


def test_a_round_outline_is_as_large_as_in_the_picture(monkeypatch) -> None:
    arc = run(monkeypatch, draw_outline).lines.list_kinds("arc")[0]
    assert arc.points == ((LEFT + 128.0, TOP + 64.0),) and arc.lengths == (32.0, 32.0)


def test_disks_of_a_light_lie_inside_each_other_and_a_bar_crosses_a_negative_one(monkeypatch) -> None:
    stage = run(monkeypatch, draw_knob)
    radii = [shape.lengths[0] for shape in stage.lines.list_kinds("disk")]
    assert radii == sorted(radii, reverse=True) and len({*radii}) == 3
    (bar,) = stage.lines.list_kinds("line")
    (x0, y0), (x1, y1) = bar.points
    assert (x0 + x1, y0, y1) == (2 * 444.0, 292.0, 292.0) and 0.0 < x1 - x0 < 2.0 * radii[-1]


def draw_ball(monkeypatch, aim: tuple[float, float, float], on: bool = True) -> list[tuple[float, float, float, int]]:
    """The disks of a ball of radius 30 around (100, 50), lit by a sun, before a camera that looks along -z."""
    stage = Stage(monkeypatch)
    camera = SimpleNamespace(right=(1.0, 0.0, 0.0), down=(0.0, -1.0, 0.0), forward=(0.0, 0.0, -1.0))
    sun: Any = SimpleNamespace(camera=camera, light=SimpleNamespace(direction=aim, color=(1.0, 1.0, 1.0), on=on))
    lamp_lines._ball(stage.lines, (100.0, 50.0), 30.0, sun)  # pyright: ignore
    return [(*shape.points[0], *shape.lengths, shape.color & 255) for shape in stage.lines.list_kinds("disk")]


@pytest.mark.parametrize(
    ("aim", "side"), [((-2.0, 0, 0), (1, 0)), ((0, 1.0, 0), (0, 1)), ((0.6, -0.8, 0), (-0.6, -0.8))]
)
def test_a_ball_that_is_lit_from_a_side_has_disks_that_touch_there(monkeypatch, aim, side) -> None:
    """Each lies in the one before it, and is brighter: the last has a tenth of the radius, and the light's color."""
    disks = draw_ball(monkeypatch, aim)
    radii = [radius for _, _, radius, _ in disks]
    assert radii == sorted(radii, reverse=True) and radii[0] == 30.0 and radii[-1] == pytest.approx(3.0)
    for x, y, radius, _ in disks:
        assert (x + side[0] * radius, y + side[1] * radius) == pytest.approx((100 + 30 * side[0], 50 + 30 * side[1]))
    steps = [disk[3] for disk in disks]
    assert steps == sorted(steps) and steps[0] == 26 and steps[-1] == 255  # a tenth, and all of it
    middle = (steps[0] + steps[-1]) / 2.0
    assert steps[6] < middle < steps[7] and steps[7] - middle == pytest.approx(middle - steps[6], abs=2.0)


def test_a_ball_is_bright_from_before_and_dark_from_behind(monkeypatch) -> None:
    """Disks have one middle then. From before, the edge of the ball is half as bright as its middle."""
    before, behind = (draw_ball(monkeypatch, (0.0, 0.0, z)) for z in (-1.0, 1.0))
    assert {disk[:2] for disk in before + behind} == {(100.0, 50.0)}
    assert before[0][3] == pytest.approx((26 + 255) / 2, abs=1) and before[-1][3] == 255
    assert {disk[3] for disk in behind} == {26}
    assert draw_ball(monkeypatch, (-1.0, 0, 0), on=False)[-1][3] == 0
