"""Rotoscopes in motion: blur against exact areas over time; modes against numpy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from halation.graph import Expression, Graph, Key, Keys, Output, Port
from halation.nodes import Kind, RotoShape, catalogue, join_points, make_ellipse, name_roto_shapes
from halation.nodes.input.roto import Roto
from halation.renderer import Renderer, RenderRequest

NODES = catalogue()
WIDTH, HEIGHT = 60, 20
POSITION = Port("roto", "shapes.box.position")
BOX = join_points([(0.25, 0.25), (0.5, 0.25), (0.5, 0.75), (0.25, 0.75)])
"""From column 15 to column 30."""

Expose = Callable[..., np.ndarray]


@pytest.fixture
def expose(renderer: Renderer) -> Expose:
    """`expose(frame, shutter=180.0)`: a row of the mask of a box that moves by 6 pixels in each frame."""

    def render(frame: int, keys: Keys | None = None, **values: object) -> np.ndarray:
        shape = RotoShape(points=BOX, motion_blur=bool(values.pop("motion_blur", True)))
        graph = Graph().add("roto", Roto(shapes=name_roto_shapes(box=shape), **values))
        graph = graph.add_output("mask", Output(Kind.FIELD)).connect(Port("roto", "mask"), Port("outputs", "mask"))
        graph = graph.animate(POSITION, keys or Keys((Key(1, (0.0, 0.0), "linear"), Key(5, (0.4, 0.0)))))
        request = RenderRequest({}, size=(WIDTH, HEIGHT), frame=frame, precision="float")
        return renderer.render(graph, request)["mask"][HEIGHT // 2].reshape(-1)

    return render


def sweep(start: float, end: float) -> np.ndarray:
    """The mean coverage of columns by a box whose left side moves evenly between two places, in closed form."""
    edges = np.arange(WIDTH + 1.0)

    def integrate(side: float) -> np.ndarray:
        """The integral over all columns left of an edge, of the part of the time in which a side has passed it."""
        low, high = start + side, end + side
        within = np.clip(edges, low, high) - low
        return within**2 / (2.0 * (high - low)) + np.maximum(edges - high, 0.0)

    return np.diff(integrate(0.0)) - np.diff(integrate(15.0))


@pytest.mark.parametrize(
    ("values", "start", "end"),
    [
        ({"shutter": 180.0}, 19.5, 22.5),
        ({"shutter": 360.0}, 18.0, 24.0),
        ({"shutter": 360.0, "phase": "start"}, 21.0, 27.0),
        ({"shutter": 360.0, "phase": "end", "samples": 48}, 15.0, 21.0),
    ],
)
def test_a_moving_shape_is_blurred_as_far_as_it_moves(expose: Expose, values, start, end) -> None:
    np.testing.assert_allclose(expose(2, **values), sweep(start, end), atol=5e-3)


def test_what_does_not_move_or_is_not_to_be_blurred_is_sharp(expose: Expose) -> None:
    sharp = expose(2)
    np.testing.assert_array_equal(expose(2, shutter=360.0, motion_blur=False), sharp)
    np.testing.assert_allclose(sharp, (np.arange(WIDTH) >= 21) & (np.arange(WIDTH) < 36), atol=1e-5)
    np.testing.assert_array_equal(expose(9, shutter=360.0), expose(9))


def test_a_key_of_another_frame_changes_the_blur_of_this_one(expose: Expose) -> None:
    """The value at frame 2 stays, so nothing but the times between frames tells the two graphs apart."""
    for after in (27.0, 45.0):
        keys = Keys((Key(2, (0.1, 0.0), "linear"), Key(3, ((after - 15.0) / WIDTH, 0.0))))
        blurred = expose(2, keys, shutter=360.0, phase="start", samples=64)
        np.testing.assert_allclose(blurred, sweep(21.0, after), atol=5e-3)


MODES: dict[str, Callable[[np.ndarray, np.ndarray, float], np.ndarray]] = {
    "union": lambda below, cover, opacity: below + cover * opacity * (1.0 - below),
    "subtract": lambda below, cover, opacity: below * (1.0 - opacity * cover),
    "intersect": lambda below, cover, opacity: below * (1.0 - opacity * (1.0 - cover)),
    "max": lambda below, cover, opacity: np.maximum(below, cover * opacity),
    "min": lambda below, cover, opacity: np.minimum(below, 1.0 - opacity * (1.0 - cover)),
    "difference": lambda below, cover, opacity: np.abs(below - cover * opacity),
    "plus": lambda below, cover, opacity: np.minimum(below + cover * opacity, 1.0),
}


@pytest.mark.parametrize("feather", [0.0, 0.2])
@pytest.mark.parametrize("opacity", [0.0, 0.6, 1.0])
@pytest.mark.parametrize("mode", MODES)
def test_modes_combine_masks_as_their_formulas_say(run, mode, opacity, feather):
    size = (96, 64)
    below = np.tile(np.linspace(0.0, 1.0, size[0], dtype=np.float32), (size[1], 1))
    points = make_ellipse(0.5, 0.5, 0.5, 0.7)

    def draw(inputs: dict[str, np.ndarray], **fields: object) -> np.ndarray:
        shapes = name_roto_shapes(shape=RotoShape(points=points, feather=feather, **fields))
        return run(Roto(shapes=shapes), inputs, size=size, output="mask")[..., 0]

    cover = draw({})
    for invert in (False, True):
        mask = draw({"matte": below}, mode=mode, opacity=opacity, invert=invert)
        np.testing.assert_allclose(mask, MODES[mode](below, 1.0 - cover if invert else cover, opacity), atol=1e-5)


def test_two_shapes_that_share_an_edge_leave_no_seam_with_plus(run):
    halves = [
        join_points([(left, 0.1), (right, 0.1), (right, 0.9), (left, 0.9)])
        for left, right in ((0.1, 0.505), (0.505, 0.9))
    ]
    first, second = (
        RotoShape(points=points, mode=mode) for points, mode in zip(halves, ("union", "plus"), strict=True)
    )
    mask = run(Roto(shapes=name_roto_shapes(a=first, b=second)), size=(100, 50), output="mask")[..., 0]
    np.testing.assert_allclose(mask[25, 12:88], 1.0, atol=1e-5)


def test_a_shape_follows_a_transform_by_expressions(run):
    """As if the transform moved the mask; keys of the transform blur it as its own would."""
    size = (96, 64)
    points = make_ellipse(0.4, 0.5, 0.3, 0.4)
    moved = {"position": (9.0, -6.0), "rotation": 25.0, "scale": (1.2, 0.8)}
    graph = Graph().add("move", NODES["transform"](**moved)).add_output("mask", Output(Kind.FIELD))

    def draw(shape: RotoShape, **animation: str) -> np.ndarray:
        drawn = graph.add("roto", Roto(shapes=name_roto_shapes(box=shape)))
        drawn = drawn.connect(Port("roto", "mask"), Port("outputs", "mask"))
        for name, text in animation.items():
            drawn = drawn.animate(Port("roto", f"shapes.box.{name}"), Expression(text))
        return run(drawn, size=size)[..., 0]

    follows = draw(
        RotoShape(points=points),
        position="[move.position.x / 96, move.position.y / 64]",
        rotation="move.rotation",
        scale="[move.scale.x, move.scale.y]",
    )
    placed = draw(RotoShape(points=points, **{**moved, "position": (9.0 / 96, -6.0 / 64)}))
    np.testing.assert_allclose(follows, placed, atol=1e-6)
    still = draw(RotoShape(points=points))
    transformed = run(NODES["transform"](**moved, kernel="catmull-rom"), {"image": np.dstack([still] * 4)})[..., 0]
    assert np.abs(follows - transformed).mean() < 2e-3 and np.abs(follows - transformed).max() < 0.25
