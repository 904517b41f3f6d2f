"""Paint: coverage against polygons and very many discs in 64 bits, tools against scipy and hand-computed numbers."""

from __future__ import annotations

import re

import numpy as np
import pytest
from brushes import cover_pixels, drag_places
from devices import form_to_test
from halation.document.reading import loads
from halation.document.writing import dumps
from halation.errors import HalationError
from halation.graph import Graph, Input, Key, Keys, Output, Port, Settings, problems
from halation.nodes import (
    STROKE_ROWS,
    Kind,
    PaintStroke,
    PaintTool,
    name_paint_strokes,
    paint_strokes_of,
    simplify_stroke,
)
from halation.nodes.filter.paint import Paint
from halation.nodes.input.constant import Constant
from halation.nodes.merge.merge import Merge
from halation.renderer import Renderer, RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace
from polygons import measure_coverage
from scipy.ndimage import gaussian_filter, map_coordinates

SIZE = WIDTH, HEIGHT = 101, 75
TURNS = np.linspace(0.0, 2.0 * np.pi, 40)
WAYS = {
    "a dot": [(50.3, 30.7, 1.0)],
    "a line": [(20.3, 12.7, 1.0), (75.2, 53.1, 1.0)],
    "a level line": [(20.0, 40.5, 1.0), (80.0, 40.5, 1.0)],
    "a line that becomes thin": [(20.3, 12.7, 1.0), (75.2, 53.1, 0.2)],
    "a line that is thin at its ends": [(20.3, 12.7, 0.2), (50.0, 40.0, 1.0), (90.0, 42.0, 0.2)],
    "a ring": [(50.0 + 30.0 * np.cos(t), 37.0 + 25.0 * np.sin(t), 1.0) for t in TURNS],
    "out of the picture": [(-30.0, 20.0, 1.0), (130.0, 60.0, 1.0)],
    "twice at one place": [(40.0, 40.0, 1.0), (40.0, 40.0, 1.0), (60.0, 40.0, 1.0)],
}


def draw_way(way: list[tuple[float, float, float]], width: float, **fields: object) -> PaintStroke:
    """A stroke through places in pixels, with a brush of a width in pixels."""
    points = STROKE_ROWS.join((x / WIDTH, y / HEIGHT, pressure) for x, y, pressure in way)
    return PaintStroke(**{"points": points, "size": width / HEIGHT, **fields})


def make_picture(seed: int = 1) -> np.ndarray:
    """A smooth opaque picture."""
    noise = np.random.default_rng(seed).random((HEIGHT, WIDTH, 4))
    picture = gaussian_filter(noise, (2.0, 2.0, 0.0)) * 3.0 - 1.0
    picture[..., 3] = 1.0
    return picture.astype(np.float32)


def name_all(*strokes: PaintStroke):
    return name_paint_strokes(**{f"stroke_{number}": stroke for number, stroke in enumerate(strokes, 1)})


def paint(run, picture: np.ndarray, *strokes: PaintStroke, **options) -> np.ndarray:
    return run(Paint(strokes=name_all(*strokes)), {"image": picture, **options.pop("inputs", {})}, **options)


def cover(run, stroke: PaintStroke, **options) -> np.ndarray:
    """How much of each pixel a stroke covers."""
    size = options.get("size", SIZE)
    return paint(run, np.zeros((size[1], size[0], 4), np.float32), stroke, output="painted", **options)[..., 0]


def outline_disc(x: float, y: float, radius: float) -> np.ndarray:
    turns = np.linspace(0.0, 2.0 * np.pi, 2000, endpoint=False)
    return np.column_stack([x + radius * np.cos(turns), y + radius * np.sin(turns)])


def hull_of(way: list[tuple[float, float, float]], radius: float) -> np.ndarray:
    """The convex hull of the discs at the ends of a line, which is what a hard brush covers on it."""
    from scipy.spatial import ConvexHull

    corners = np.vstack([outline_disc(x, y, max(radius * pressure, 1e-6)) for x, y, pressure in way])
    return corners[ConvexHull(corners).vertices]


@pytest.mark.parametrize("width", [1.3, 7.0, 24.0])
@pytest.mark.parametrize("name", ["a dot", "a line", "a level line", "a line that becomes thin"])
def test_a_hard_line_covers_the_hull_of_its_ends(run, name, width):
    exact = measure_coverage(hull_of(WAYS[name], 0.5 * width), SIZE)
    np.testing.assert_allclose(cover(run, draw_way(WAYS[name], width, hardness=1.0)), exact, atol=2e-3)


@pytest.mark.parametrize(("hardness", "width"), [(0.7, 9.0), (0.0, 14.0), (0.0, 36.0)])
@pytest.mark.parametrize("name", WAYS)
def test_a_stroke_covers_as_very_many_discs_do(run, name, hardness, width):
    way = [(x, y, pressure * 0.5 * width) for x, y, pressure in WAYS[name]]
    mask = cover(run, draw_way(WAYS[name], width, hardness=hardness))
    np.testing.assert_allclose(mask, cover_pixels(way, hardness, SIZE, 16 if width < 10.0 else 8), atol=2.5e-3)


def test_a_hard_stroke_that_meets_itself_covers_once(run):
    way = [(20.0, 20.0, 1.0), (80.0, 50.0, 1.0), (25.0, 60.0, 1.0), (70.0, 12.0, 1.0)]
    exact = cover_pixels([(x, y, 5.0) for x, y, _ in way], 1.0, SIZE, 32)
    mask = cover(run, draw_way(way, 10.0, hardness=1.0))
    assert np.abs(mask - exact).mean() < 2e-4 and mask.max() == 1.0
    np.testing.assert_allclose(mask, exact, atol=0.015)


def test_many_segments_are_those_of_a_fine_way(run):
    turns = np.linspace(3.0, 20.0, 900)
    way = [(50.0 + 1.7 * t * np.cos(t), 37.0 + 1.7 * t * np.sin(t), 1.0) for t in turns]
    exact = cover_pixels([(x, y, 2.0) for x, y, _ in way], 0.2, SIZE, 16)
    np.testing.assert_allclose(cover(run, draw_way(way, 4.0, hardness=0.2)), exact, atol=2.5e-3)


# --- tools ---------------------------------------------------------------------------------------------------------

LINE = WAYS["a line"]


def test_a_brush_paints_its_color_over_the_picture(run):
    picture, stroke = make_picture(), draw_way(LINE, 12.0, color=(0.2, 2.0, 0.4), opacity=0.7)
    w = 0.7 * cover(run, replace(stroke, opacity=1.0))[..., None]
    painted = paint(run, picture, stroke)
    np.testing.assert_allclose(painted, picture * (1 - w) + w * (0.2, 2.0, 0.4, 1.0), atol=1e-5)
    transparent = paint(run, np.zeros_like(picture), stroke)
    np.testing.assert_allclose(transparent, w * (0.2, 2.0, 0.4, 1.0), atol=1e-5)


@pytest.mark.parametrize("blend", ["plus", "multiply", "screen", "overlay", "soft light", "color dodge", "color burn"])
def test_blends_are_those_of_merge(run, blend):
    picture, color = np.clip(make_picture(), 0.0, 1.0), np.array((0.3, 0.6, 0.1, 1.0), np.float32)
    w = cover(run, draw_way(LINE, 12.0))[..., None].astype(np.float32)
    merged = run(Merge(mode=blend), {"a": w * color, "b": picture})
    painted = paint(run, picture, draw_way(LINE, 12.0, color=(0.3, 0.6, 0.1), blend=blend))
    np.testing.assert_allclose(painted, merged, atol=2e-5)


def test_an_eraser_takes_strokes_away_that_come_before_it(run):
    picture = make_picture()
    brush, eraser = draw_way(LINE, 20.0), draw_way(LINE, 8.0, tool=PaintTool.ERASE)
    last = draw_way(WAYS["a ring"], 4.0, color=(0.0, 0.0, 1.0))
    w = cover(run, replace(eraser, tool=PaintTool.BRUSH))[..., None]
    before = paint(run, picture, brush)
    erased = before * (1 - w) + picture * w
    np.testing.assert_allclose(paint(run, picture, brush, eraser), erased, atol=1e-5)
    ring = cover(run, last)[..., None]
    three = paint(run, picture, brush, eraser, last)
    np.testing.assert_allclose(three, erased * (1 - ring) + ring * (0.0, 0.0, 1.0, 1.0), atol=1e-5)
    mask = run(Paint(strokes=name_all(brush, eraser)), {"image": picture}, output="painted")[..., 0]
    np.testing.assert_allclose(mask, cover(run, brush) * (1 - w[..., 0]), atol=1e-5)


def test_a_clone_copies_what_was_there_before_it(run):
    picture = make_picture()
    offset = (13.0, -7.0)
    stroke = draw_way(LINE, 12.0, tool=PaintTool.CLONE, offset=(offset[0] / WIDTH, offset[1] / HEIGHT))
    w = cover(run, replace(stroke, tool=PaintTool.BRUSH))[..., None]
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    copied = picture[np.clip(y - 7, 0, HEIGHT - 1), np.clip(x + 13, 0, WIDTH - 1)]
    painted = paint(run, picture, stroke)
    np.testing.assert_allclose(painted, picture * (1 - w) + copied * w, atol=1e-5)
    again = paint(run, picture, stroke, replace(stroke, opacity=1.0))
    copied = painted[np.clip(y - 7, 0, HEIGHT - 1), np.clip(x + 13, 0, WIDTH - 1)]
    np.testing.assert_allclose(again, painted * (1 - w) + copied * w, atol=1e-5)


def test_clones_in_one_pass_are_those_of_single_nodes(run):
    picture, rng = make_picture(), np.random.default_rng(3)
    strokes = [
        draw_way(
            [(x, y, 1.0), (x + 6.0, y + 4.0, 1.0)], 5.0,
            tool=(PaintTool.CLONE, PaintTool.BRUSH, PaintTool.BLUR)[number % 3],
            offset=tuple(rng.uniform(-0.4, 0.4, 2)), sigma=0.01 + 0.01 * (number % 2), color=tuple(rng.random(3)),
        )
        for number, (x, y) in enumerate(rng.uniform((0, 0), (WIDTH, HEIGHT), (24, 2)))
    ]  # fmt: skip
    single = picture
    for stroke in strokes:
        erases_nothing = paint(run, single, stroke)
        single = erases_nothing
    np.testing.assert_allclose(paint(run, picture, *strokes), single, atol=1e-5)


def test_reveal_and_clone_show_the_source(run):
    picture, plate = make_picture(), make_picture(2)
    reveal = draw_way(LINE, 12.0, tool=PaintTool.REVEAL, source="source")
    w = cover(run, replace(reveal, tool=PaintTool.BRUSH))[..., None]
    revealed = paint(run, picture, reveal, inputs={"source": plate})
    np.testing.assert_allclose(revealed, picture * (1 - w) + plate * w, atol=1e-5)
    clone = replace(reveal, tool=PaintTool.CLONE, offset=(10.0 / WIDTH, 0.0))
    cloned = paint(run, picture, clone, inputs={"source": plate})
    np.testing.assert_allclose(cloned, picture * (1 - w) + w * np.roll(plate, -10, axis=1), atol=1e-5)


def test_other_frames_are_asked_for_only_while_a_stroke_needs_them():
    fields = {"tool": PaintTool.REVEAL, "source": "image", "lifetime": "range", "first": 5, "last": 8}
    before = Paint(strokes=name_all(PaintStroke(**fields, frame=-3)))
    assert before.times(4) == {} and before.times(6) == {"image": (3, 6)}
    fixed = Paint(strokes=name_all(PaintStroke(**fields, timing="fixed", frame=1)))
    assert fixed.times(8) == {"image": (1, 8)} and fixed.times(9) == {}


def test_points_move_from_key_to_key(run, renderer):
    """Half way between two keys, all numbers of all points are half way; in files, keys have a row for each point."""
    start = [(20.0, 12.0, 1.0), (75.0, 53.0, 1.0), (60.0, 20.0, 0.5)]
    end = [(30.0, 22.0, 0.6), (65.0, 63.0, 1.0), (80.0, 10.0, 0.9)]
    ways = [STROKE_ROWS.join((x / WIDTH, y / HEIGHT, pressure) for x, y, pressure in way) for way in (start, end)]
    graph = Graph(settings=Settings(size=SIZE)).add("paint", Paint(strokes=name_all(draw_way(start, 9.0))))
    graph = graph.add("back", Constant()).connect(Port("back", "out"), Port("paint", "image"))
    keys = Keys((Key(1, ways[0], "linear"), Key(11, ways[1], "linear")))
    graph = graph.animate(Port("paint", "strokes.stroke_1.points"), keys)
    middle = [tuple(0.5 * (a + b) for a, b in zip(*pair, strict=True)) for pair in zip(start, end, strict=True)]
    expected = cover(run, draw_way(middle, 9.0))
    request = RenderRequest(targets={"cover": Port("paint", "painted")}, frame=6, precision="float")
    np.testing.assert_allclose(renderer.render(graph, request)["cover"][..., 0], expected, atol=1e-5)
    text = dumps(graph)
    assert len(re.findall(r"^ +\[[\d., ]+\],?$", text, re.MULTILINE)) == 9  # three points, and at both keys
    assert loads(text, "graph.json", sandbox=UNRESTRICTED).animation == graph.animation


def test_a_blur_is_gaussian(run):
    picture = make_picture()
    stroke = draw_way(LINE, 20.0, tool=PaintTool.BLUR, sigma=2.0 / HEIGHT)
    w = cover(run, replace(stroke, tool=PaintTool.BRUSH))[..., None]
    blurred = gaussian_filter(picture.astype(float), (2.0, 2.0, 0.0), mode="nearest", truncate=6.0)
    np.testing.assert_allclose(paint(run, picture, stroke), picture * (1 - w) + blurred * w, atol=2e-3)


@pytest.mark.parametrize(("hardness", "opacity"), [(0.5, 1.0), (0.0, 0.6), (0.75, 1.0)])
@pytest.mark.parametrize("name", ["a line", "a line that becomes thin", "a line that is thin at its ends"])
def test_a_smear_drags_the_picture_as_the_published_warp_does(run, name, hardness, opacity):
    picture, width = make_picture(), 16.0
    smeared = paint(run, picture, draw_way(WAYS[name], width, tool=PaintTool.SMEAR, hardness=hardness, opacity=opacity))
    way = [(px, py, pressure * width / 2) for px, py, pressure in WAYS[name]]

    def take_back(down: float, across: float) -> tuple[np.ndarray, np.ndarray]:
        """How far what is at a place of each pixel was dragged, and its color."""
        y, x = np.mgrid[:HEIGHT, :WIDTH] + np.array((down, across))[:, None, None]
        from_x, from_y = drag_places(way, hardness, opacity, width / 16, x, y)
        away = np.stack([from_x - x, from_y - y], axis=-1)
        moved = np.abs(away).max(axis=-1) > 0.0
        at = np.where(moved, from_y, np.floor(y) + 0.5) - 0.5, np.where(moved, from_x, np.floor(x) + 0.5) - 0.5
        return away, np.stack([map_coordinates(picture[..., c], at, order=1, mode="nearest") for c in range(4)], -1)

    parts = [take_back(*place) for place in ((0.25, 0.25), (0.25, 0.75), (0.75, 0.25), (0.75, 0.75))]
    spread = np.max([np.hypot(*(away - parts[0][0]).transpose(2, 0, 1)) for away, _ in parts], axis=0)
    mean = np.mean([color for _, color in parts], axis=0)
    exact = np.where((spread < 0.25)[..., None], take_back(0.5, 0.5)[1], mean)
    differing = np.abs(smeared - exact).max(axis=-1)
    assert np.quantile(differing, 0.998) < 2e-3 and differing.mean() < 2e-4


def test_a_hard_smear_carries_what_was_at_its_start(run):
    picture = make_picture()
    stroke = draw_way([(30.5, 40.5, 1.0), (60.5, 40.5, 1.0)], 12.0, tool=PaintTool.SMEAR, hardness=1.0)
    smeared = paint(run, picture, stroke)
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    inside = np.hypot(x - 60.5, y - 40.5) < 5.5
    np.testing.assert_allclose(smeared[inside], np.roll(picture, 30, axis=1)[inside], atol=1e-3)
    far = np.hypot(np.maximum(np.abs(x - 45.5) - 15.0, 0.0), y - 40.5) > 6.1
    np.testing.assert_array_equal(smeared[far], picture[far])


def test_strokes_count_in_the_order_of_their_names_while_they_last(run):
    picture = make_picture()
    red = draw_way(LINE, 12.0, color=(1.0, 0.0, 0.0))
    blue = draw_way(LINE, 12.0, color=(0.0, 0.0, 1.0), hardness=0.6)
    node = Paint(strokes=name_paint_strokes(stroke_10=blue, stroke_2=red))
    both = run(node, {"image": picture})
    np.testing.assert_array_equal(both, paint(run, picture, red, blue))
    off = [replace(blue, on=False), replace(blue, opacity=0.0), replace(blue, size=0.0)]
    for hidden in (*off, replace(blue, lifetime="range", first=2, last=9)):
        np.testing.assert_array_equal(paint(run, picture, red, hidden), paint(run, picture, red))
    np.testing.assert_array_equal(paint(run, picture), picture)


@pytest.mark.parametrize("count", [40, 150])
def test_many_strokes_are_those_of_as_many_nodes(run, count: int):
    picture, rng = make_picture(), np.random.default_rng(8)
    strokes = [
        draw_way(
            [(*place, 1.0) for place in rng.uniform((0, 0), (WIDTH, HEIGHT), (4, 2))], 8.0, color=tuple(rng.random(3))
        )
        for _ in range(count)
    ]
    single = picture
    for stroke in strokes:
        single = paint(run, single, stroke)
    np.testing.assert_allclose(paint(run, picture, *strokes), single, atol=1e-5)


@pytest.mark.parametrize(
    "stroke",
    [
        draw_way(WAYS["a ring"], 12.0),
        draw_way(LINE, 9.0, tool=PaintTool.SMEAR),
        draw_way(LINE[::-1], 14.0, tool=PaintTool.CLONE, offset=(0.1, 0.05)),
        draw_way(LINE, 14.0, tool=PaintTool.BLUR, sigma=0.03),
    ],
    ids=lambda stroke: stroke.tool.value,
)
def test_a_proxy_is_the_picture_at_its_size(run, stroke):
    y, x = (np.mgrid[:96, :128] + 0.5) / 96.0
    whole = np.stack([np.sin(5.0 * x), np.cos(4.0 * y), x * y, np.ones_like(x)], axis=-1).astype(np.float32)
    small = whole.reshape(48, 2, 64, 2, 4).mean(axis=(1, 3))
    proxy = paint(run, small, stroke)
    shrunk = paint(run, whole, stroke).reshape(48, 2, 64, 2, 4).mean(axis=(1, 3))
    inside = np.s_[1:-1, 1:-1]  # at the border a proxy of the input has other weights
    np.testing.assert_allclose(paint(run, whole, stroke, scale=0.5)[inside], proxy[inside], atol=2e-3)
    differing = np.abs(shrunk - proxy).max(axis=-1)
    assert differing.mean() < 2e-3 and np.quantile(differing, 0.97) < 0.01


def test_a_large_picture_is_the_same_in_tiles():
    strokes = name_all(
        draw_way(WAYS["a ring"], 12.0), draw_way([(40.0, 40.0, 1.0), (44.0, 41.0, 1.0)], 6.0, tool=PaintTool.SMEAR),
        draw_way(LINE, 14.0, tool=PaintTool.CLONE, offset=(0.05, 0.02)), draw_way(LINE, 5.0, tool=PaintTool.BLUR),
    )  # fmt: skip
    graph = Graph().add("paint", Paint(strokes=strokes))
    picture = np.repeat(np.repeat(make_picture(), 3, axis=0), 3, axis=1)
    graph = graph.add_input("image", Input(Kind.IMAGE)).add_output("image", Output(Kind.IMAGE))
    graph = graph.connect(Port("inputs", "image"), Port("paint", "image"))
    graph = graph.connect(Port("paint", "out"), Port("outputs", "image"))
    pictures = []
    for side in (16384, 150):
        device = open_device(form_to_test(), sandbox=UNRESTRICTED)
        engine = Renderer(device.with_target(replace(device.target, max_size=side)), budget=0, sandbox=UNRESTRICTED)
        pictures.append(engine.render(graph, RenderRequest({"image": picture}, precision="float"))["image"])
        engine.close()
    np.testing.assert_array_equal(*pictures)


# --- files ---------------------------------------------------------------------------------------------------------


def test_a_file_has_a_line_for_each_point():
    stroke = PaintStroke(PaintTool.CLONE, points=(0.1, 0.2, 1.0, 0.2, 0.4, 0.5), size=0.04)
    graph = Graph().add("paint", Paint(strokes=name_all(stroke)))
    text = dumps(graph)
    assert loads(text, sandbox=UNRESTRICTED) == graph
    lines = [line.strip(" ,") for line in text.splitlines()]
    assert "[0.1, 0.2]" in lines and "[0.2, 0.4, 0.5]" in lines and '"kind": "clone",' in text
    assert paint_strokes_of(graph.value(Port("paint", "strokes"))) == (stroke,)


@pytest.mark.parametrize(
    ("field", "sentence"),
    [
        ('"points": []', "points: expected a list of points, each a list of x, y, and the pressure"),
        ('"points": [[0.5]]', "points: expected a list of points"),
        ('"points": [[0.5, 0.5, 1.0, 1.0]]', "points: expected a list of points"),
        ('"points": "round"', "points: expected a list of points"),
        ('"size": "wide"', "size: expected a number"),
        ('"blend": "glow"', "glow"),
        ('"kind": "spray"', "its kind is none of brush, erase, clone, reveal, blur, smear"),
    ],
)
def test_what_is_no_stroke_is_refused_with_a_sentence(field, sentence):
    text = dumps(Graph().add("paint", Paint(strokes=name_all(PaintStroke(size=0.1)))))
    assert '"kind": "brush"' in text
    text = text.replace('"kind": "brush"', field if "kind" in field else f'"kind": "brush", {field}')
    text = text.replace('"size": 0.1', '"opacity": 1.0') if "size" in field else text
    with pytest.raises(HalationError, match=sentence):
        graph = loads(text, sandbox=UNRESTRICTED)
        raise HalationError("; ".join(problem.sentence for problem in problems(graph)))


def test_too_many_points_are_refused():
    graph = Graph().add("paint", Paint(strokes=name_all(PaintStroke(points=(0.5, 0.5, 1.0) * 5000))))
    assert any("5000 points are too many" in problem.sentence for problem in problems(graph))


# --- drawing -------------------------------------------------------------------------------------------------------


def test_a_simplified_stroke_stays_within_the_tolerance():
    t = np.linspace(0.0, 6.0, 500)
    rows = tuple(zip((t / 6.0).tolist(), (0.5 + 0.3 * np.sin(t)).tolist(), np.ones(500).tolist(), strict=True))
    kept = simplify_stroke(rows, (1e-3, 1e-3, 0.05))
    assert len(kept) < 40 and kept[0] == rows[0] and kept[-1] == rows[-1]
    x, y, _ = np.array(kept).T
    away = np.abs(np.interp([row[0] for row in rows], x, y) - [row[1] for row in rows]) / np.hypot(1.0, 1.8)
    assert away.max() < 1e-3  # the steepest part rises by 1.8
    pressed = tuple((x, 0.5, 0.2 + 0.8 * (x > 0.5)) for x in np.linspace(0.0, 1.0, 50).tolist())
    assert len(simplify_stroke(pressed, (1e-3, 1e-3, 0.05))) == 4
    assert simplify_stroke(rows[:1], (1.0, 1.0, 1.0)) == rows[:1]
