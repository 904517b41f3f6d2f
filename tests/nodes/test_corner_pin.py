"""Corner pins against OpenCV's warpPerspective."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.distort import corner_pin
from halation.nodes.distort.corner_pin import CornerPin
from warps import waves

WIDTH, HEIGHT = 96, 64
FRAME = np.float32([(0, 0), (WIDTH, 0), (WIDTH, HEIGHT), (0, HEIGHT)])
QUADS = {
    "perspective": ((0.15, 0.2), (0.85, 0.05), (0.95, 0.9), (0.1, 0.8)),
    "turned": ((0.8, 0.1), (0.9, 0.9), (0.2, 0.8), (0.1, 0.15)),
    "larger": ((-0.2, -0.1), (1.1, -0.3), (1.3, 1.2), (-0.1, 1.1)),
    "mirrored": ((0.9, 0.1), (0.1, 0.2), (0.15, 0.9), (0.8, 0.8)),
}


def make_node(quad: str, **values: object) -> CornerPin:
    names = ("top_left", "top_right", "bottom_right", "bottom_left")
    return CornerPin(**dict(zip(names, QUADS[quad], strict=True)), **values)


@pytest.mark.parametrize("quad", QUADS)
@pytest.mark.parametrize("direction", ["pin", "unpin"])
def test_places_are_those_of_opencv(run, quad, direction):
    """On a picture that is its own positions: OpenCV interpolates places in steps of 1/32, and says them exactly."""
    y, x = np.mgrid[:HEIGHT, :WIDTH].astype(np.float32) + 0.5
    picture = np.stack([x / WIDTH, y / HEIGHT, np.ones_like(x), np.ones_like(x)], -1)
    ends = (FRAME, np.float32(np.array(QUADS[quad]) * (WIDTH, HEIGHT)))
    matrix = cv2.getPerspectiveTransform(*(ends if direction == "pin" else ends[::-1]))
    places = np.linalg.inv(matrix) @ np.stack([x.ravel(), y.ravel(), np.ones(x.size)])
    u, v = (places[:2] / places[2]).reshape(2, HEIGHT, WIDTH)
    inside = (u > 2.0) & (u < WIDTH - 2.0) & (v > 2.0) & (v < HEIGHT - 2.0) & (places[2].reshape(u.shape) > 0.0)
    assert inside.sum() > 0.1 * inside.size
    out = run(make_node(quad, direction=direction, kernel="triangle"), {"image": picture})
    np.testing.assert_allclose(out[inside][:, :2], np.stack([u / WIDTH, v / HEIGHT], -1)[inside], atol=2e-4)
    far = (u < -2.0) | (u > WIDTH + 2.0) | (v < -2.0) | (v > HEIGHT + 2.0)
    np.testing.assert_array_equal(out[far], 0.0)


@pytest.mark.parametrize("quad", ["perspective", "larger"])
def test_pictures_are_those_of_opencv(run, quad):
    picture = waves(WIDTH, HEIGHT)
    half = np.array([[1.0, 0.0, 0.5], [0.0, 1.0, 0.5], [0.0, 0.0, 1.0]])
    matrix = cv2.getPerspectiveTransform(FRAME, np.float32(np.array(QUADS[quad]) * (WIDTH, HEIGHT)))
    matrix = np.linalg.inv(half) @ matrix @ half
    theirs = cv2.warpPerspective(picture, matrix, (WIDTH, HEIGHT), flags=cv2.INTER_CUBIC)
    ours = run(make_node(quad), {"image": picture})
    whole = cv2.erode((theirs[..., 3] > 0.999).astype(np.uint8), np.ones((5, 5))).astype(bool)
    assert whole.sum() > 1000
    assert np.abs(ours - theirs)[whole].max() < 4e-3


def test_the_opposite_undoes_it(run):
    picture = waves(WIDTH, HEIGHT)
    pinned = run(make_node("larger", edge="clamp"), {"image": picture})
    back = run(
        make_node("perspective", direction="unpin"), {"image": run(make_node("perspective"), {"image": picture})}
    )
    assert np.isfinite(pinned).all()
    np.testing.assert_allclose(back[8:-8, 8:-8], picture[8:-8, 8:-8], atol=2e-2)


def test_corners_on_one_line_show_nothing_wrong(run):
    node = CornerPin(top_left=(0.1, 0.1), top_right=(0.5, 0.5), bottom_right=(0.9, 0.9), bottom_left=(0.3, 0.3))
    assert np.isfinite(run(node, {"image": waves(WIDTH, HEIGHT)})).all()


@pytest.mark.parametrize("seed", range(5))
def test_the_matrix_of_a_quadrangle_is_that_of_opencv(seed: int) -> None:
    rng = np.random.default_rng(seed)
    square = np.float32([(0, 0), (1, 0), (1, 1), (0, 1)])
    corners = square + rng.uniform(-0.3, 0.3, (4, 2)).astype(np.float32)
    found = corner_pin._map_square(tuple(tuple(map(float, corner)) for corner in corners))  # pyright: ignore
    np.testing.assert_allclose(np.reshape(found, (3, 3)), cv2.getPerspectiveTransform(square, corners), atol=1e-5)


@pytest.mark.parametrize("corners", [((0.0, 0.0),) * 4, ((0.0, 0.0), (0.2, 0.1), (0.4, 0.2), (0.6, 0.3))])
def test_corners_on_a_line_have_no_matrix(corners) -> None:
    assert corner_pin._map_square(corners) == (0.0,) * 9  # pyright: ignore[reportPrivateUsage]
