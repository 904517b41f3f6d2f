"""Shapes of a rotoscope that follow a transform, a track or another shape: against products of matrices in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.authoring.edits.named_items import drop_item, rename_item
from halation.document.reading import loads
from halation.document.writing import dumps
from halation.errors import GraphError
from halation.graph import Expression, Graph, Key, Keys, Output, Port
from halation.nodes import Kind, RotoShape, RotoTrack, RotoTransform, join_points, name_roto_shapes
from halation.nodes.input.roto import Roto
from halation.renderer import RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from polygons import measure_coverage

WIDTH, HEIGHT = 96, 60
SIZE = np.array((WIDTH, HEIGHT), float)
CORNERS = np.array([(0.3, 0.3), (0.55, 0.35), (0.5, 0.7), (0.28, 0.6)])
POINTS = join_points(map(tuple, CORNERS.tolist()))
SHAPES = Port("roto", "shapes")


def matrix_of(item: RotoShape | RotoTransform) -> np.ndarray:
    """The movement of an item as a matrix of pixels: to the pivot, scaled, turned, back, then moved."""

    def shift(x: float, y: float) -> np.ndarray:
        return np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])

    pivot, angle = np.array(item.pivot) * SIZE, np.radians(item.rotation)
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    return shift(*np.array(item.position) * SIZE) @ shift(*pivot) @ turn @ np.diag([*item.scale, 1.0]) @ shift(*-pivot)


def cover(matrix: np.ndarray) -> np.ndarray:
    """The coverage of the corners moved by a matrix."""
    corners = np.column_stack([CORNERS * SIZE, np.ones(len(CORNERS))]) @ matrix.T
    return measure_coverage(corners[:, :2], (WIDTH, HEIGHT))


def make_graph(**items: RotoShape | RotoTransform | RotoTrack) -> Graph:
    graph = Graph().add("roto", Roto(shapes=name_roto_shapes(**items))).add_output("mask", Output(Kind.FIELD))
    return graph.connect(Port("roto", "mask"), Port("outputs", "mask"))


def mask_of(run, graph: Graph) -> np.ndarray:
    return run(graph, size=(WIDTH, HEIGHT))[..., 0]


CHILD = RotoShape(
    points=POINTS, position=(0.05, -0.1), rotation=20.0, scale=(1.1, 0.8), pivot=(0.4, 0.5), parent="move"
)
MOVE = RotoTransform(position=(0.1, 0.15), rotation=-35.0, scale=(0.9, 1.3), pivot=(0.6, 0.2))
GRAND = RotoTransform(position=(-0.05, 0.02), rotation=12.0)


def test_a_shape_is_moved_by_itself_then_by_its_parents(run):
    alone = mask_of(run, make_graph(box=CHILD, move=MOVE))
    np.testing.assert_allclose(alone, cover(matrix_of(MOVE) @ matrix_of(CHILD)), atol=2e-3)
    move = RotoTransform(MOVE.position, MOVE.rotation, MOVE.scale, MOVE.pivot, "grand")
    both = mask_of(run, make_graph(box=CHILD, move=move, grand=GRAND))
    np.testing.assert_allclose(both, cover(matrix_of(GRAND) @ matrix_of(MOVE) @ matrix_of(CHILD)), atol=2e-3)


def test_another_shape_can_be_the_parent_also_while_it_is_off(run):
    parent = RotoShape(on=False, position=MOVE.position, rotation=MOVE.rotation, scale=MOVE.scale, pivot=MOVE.pivot)
    mask = mask_of(run, make_graph(box=CHILD, move=parent))
    np.testing.assert_allclose(mask, cover(matrix_of(MOVE) @ matrix_of(CHILD)), atol=2e-3)


def test_a_track_of_one_point_moves_what_follows_it(run):
    track = RotoTrack(first=(0.62, 0.41), first_origin=(0.5, 0.5), second=(0.1, 0.1))
    shift = np.array([[1.0, 0.0, 0.12 * WIDTH], [0.0, 1.0, -0.09 * HEIGHT], [0.0, 0.0, 1.0]])
    mask = mask_of(run, make_graph(box=RotoShape(points=POINTS, parent="t"), t=track))
    np.testing.assert_allclose(mask, cover(shift), atol=2e-3)


def test_a_track_of_two_points_takes_both_along(run):
    """The map is the similarity that four equations give: a x - b y + c, b x + a y + d."""
    origins, places = np.array([(0.3, 0.4), (0.7, 0.5)]) * SIZE, np.array([(0.35, 0.3), (0.6, 0.6)]) * SIZE
    rows, sides = [], []
    for (x, y), (u, v) in zip(origins, places, strict=True):
        rows += [(x, -y, 1.0, 0.0), (y, x, 0.0, 1.0)]
        sides += [u, v]
    a, b, c, d = np.linalg.solve(np.array(rows), np.array(sides))
    track = RotoTrack("two", (0.35, 0.3), (0.3, 0.4), (0.6, 0.6), (0.7, 0.5))
    mask = mask_of(run, make_graph(box=RotoShape(points=POINTS, parent="t"), t=track))
    np.testing.assert_allclose(mask, cover(np.array([[a, -b, c], [b, a, d], [0.0, 0.0, 1.0]])), atol=2e-3)


@pytest.mark.parametrize("is_blurred", [True, False])
def test_motion_blur_is_that_of_the_parent_too(renderer, is_blurred):
    """A box that its track carries by six pixels in each frame, against the exact mean of a moving edge."""
    box = join_points([(0.25, 0.0), (0.5, 0.0), (0.5, 1.0), (0.25, 1.0)])
    graph = make_graph(box=RotoShape(points=box, parent="t", motion_blur=is_blurred), t=RotoTrack())
    graph = graph.set(Port("roto", "shutter"), 180.0)
    graph = graph.animate(Port("roto", "shapes.t.first"), Keys((Key(1, (0.5, 0.5), "linear"), Key(5, (0.75, 0.5)))))
    request = RenderRequest({}, size=(WIDTH, HEIGHT), frame=2, precision="float")
    row = renderer.render(graph, request)["mask"][HEIGHT // 2].reshape(-1)
    if is_blurred:  # the shutter is open for half a frame, three pixels, around the frame
        edges, means = np.arange(WIDTH + 1.0), []
        for low in (28.5, 52.5):
            within = np.clip(edges, low, low + 3.0) - low
            means.append(np.diff(within**2 / 6.0 + np.maximum(edges - low - 3.0, 0.0)))
        np.testing.assert_allclose(row, means[0] - means[1], atol=5e-3)
    else:
        np.testing.assert_allclose(row, (np.arange(WIDTH) >= 30) & (np.arange(WIDTH) < 54), atol=1e-5)


def test_a_parent_can_follow_another_node(run):
    graph = make_graph(box=RotoShape(points=POINTS, parent="move"), move=RotoTransform())
    graph = graph.animate(Port("roto", "shapes.move.position"), Expression("[0.125, roto.shutter / 3600]"))
    graph = graph.set(Port("roto", "shutter"), 180.0)
    shift = np.array([[1.0, 0.0, 0.125 * WIDTH], [0.0, 1.0, 0.05 * HEIGHT], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(mask_of(run, graph), cover(shift), atol=2e-3)


def test_a_file_keeps_parents():
    graph = make_graph(box=CHILD, move=MOVE, t=RotoTrack("two", first=(0.2, 0.3)))
    text = dumps(graph)
    assert '"parent": "move"' in text and loads(text, sandbox=UNRESTRICTED) == graph


@pytest.mark.parametrize(
    ("move", "sentence"),
    [
        (RotoTransform(parent="mvoe"), "there is no shape 'mvoe'"),
        (RotoTransform(parent="box"), "it leads back to itself: box -> move -> box"),
        (RotoTransform(parent="move"), "it leads back to itself: move -> move"),
    ],
)
def test_a_parent_that_is_missing_or_follows_its_child_is_refused(run, move, sentence):
    with pytest.raises(GraphError, match=sentence):
        mask_of(run, make_graph(box=CHILD, move=move))


def test_children_follow_a_new_name_and_lose_a_parent_that_is_removed():
    graph = make_graph(box=CHILD, move=MOVE)
    renamed = rename_item(graph, SHAPES, "move", "rig")
    assert renamed.value(Port("roto", "shapes.box.parent")) == "rig"
    dropped = drop_item(graph, SHAPES, "move")
    assert dropped.value(Port("roto", "shapes.box.parent")) == "" and list(dropped.value(SHAPES)) == ["box"]


def test_a_parent_is_chosen_among_the_other_items():
    graph = make_graph(box=CHILD, move=MOVE)
    declaration = graph.declaration(Port("roto", "shapes.box.parent"))
    assert declaration.choices == ("", "move") and declaration.type == "choice"
    with pytest.raises(GraphError):
        graph.set(Port("roto", "shapes.box.parent"), "nobody")
