"""Merging by depth: the share of pixels where planes cut through each other against 32 x 32 samples."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.merge.depth_merge import DepthMerge

WIDTH, HEIGHT = 60, 40
RED, BLUE = np.float32((1.0, 0.0, 0.0, 1.0)), np.float32((0.0, 0.0, 1.0, 1.0))


def make_plane(color: np.ndarray, slope: tuple[float, float], samples: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """A plane in perspective: 1 / depth is linear across the picture."""
    y, x = (np.mgrid[: HEIGHT * samples, : WIDTH * samples] + 0.5) / samples
    near = 0.2 + slope[0] * (x / WIDTH - 0.5) + slope[1] * (y / HEIGHT - 0.5)
    return np.broadcast_to(color, (*x.shape, 4)).astype(np.float32), 1.0 / near


@pytest.mark.parametrize("slope", [(0.1, 0.0), (0.0, -0.1), (0.08, 0.05), (-0.02, 0.09), (0.1, 0.1)])
def test_edges_between_planes_are_antialiased_exactly(run, slope):
    a, a_depth = make_plane(RED, slope)
    b, b_depth = make_plane(BLUE, (0.01, -0.02))
    inputs = {"a": a, "a_depth": a_depth, "b": b, "b_depth": b_depth}
    _, fine_a = make_plane(RED, slope, 32)
    _, fine_b = make_plane(BLUE, (0.01, -0.02), 32)
    share = (fine_a < fine_b).reshape(HEIGHT, 32, WIDTH, 32).mean((1, 3))
    out = run(DepthMerge(), inputs)[1:-1, 1:-1]
    np.testing.assert_allclose(out[..., 0], share[1:-1, 1:-1], atol=1.0 / 32.0)
    np.testing.assert_allclose(out[..., 0] + out[..., 2], 1.0, atol=1e-6)
    hard = run(DepthMerge(antialias=False), inputs)
    np.testing.assert_array_equal(hard[..., 0], (np.float32(a_depth) < np.float32(b_depth)).astype(np.float32))
    depth = run(DepthMerge(), inputs, output="depth")[..., 0]
    np.testing.assert_allclose(depth, np.minimum(a_depth, b_depth), rtol=1e-6)


def test_the_nearer_picture_is_merged_over_the_other(run):
    random = np.random.default_rng(7)
    a, b = (random.random((HEIGHT, WIDTH, 4)).astype(np.float32) for _ in range(2))
    near, far = np.full((HEIGHT, WIDTH), 2.0, np.float32), np.full((HEIGHT, WIDTH), 5.0, np.float32)
    over = a + b * (1.0 - a[..., 3:])
    for first, second, depths in ((a, b, (near, far)), (b, a, (far, near))):
        inputs = {"a": first, "a_depth": depths[0], "b": second, "b_depth": depths[1]}
        np.testing.assert_allclose(run(DepthMerge(), inputs), over, atol=1e-6)


@pytest.mark.parametrize("empty", [0.0, np.inf, 1e10, -1.0])
def test_the_background_is_behind_everything(run, empty):
    a, b = (np.broadcast_to(color, (HEIGHT, WIDTH, 4)).copy() for color in (RED, BLUE))
    depth = np.full((HEIGHT, WIDTH), 1000.0, np.float32)
    nothing = np.full((HEIGHT, WIDTH), empty, np.float32)
    inputs = {"a": a, "a_depth": nothing, "b": b, "b_depth": depth}
    np.testing.assert_allclose(run(DepthMerge(), inputs), b, atol=1e-6)
    both = run(DepthMerge(), inputs | {"b_depth": nothing}, output="depth")
    assert (both == 1e10).all()


@pytest.mark.parametrize("side", ["right", "left", "below", "above"])
def test_silhouettes_stay_where_they_are(run, side):
    """Beside an object that is far in front, the surfaces behind it are not mixed, however close they are."""
    a, b = (np.broadcast_to(color, (HEIGHT, WIDTH, 4)).copy() for color in (RED, BLUE))
    a_depth, b_depth = np.full((HEIGHT, WIDTH), 5.001), np.full((HEIGHT, WIDTH), 5.0)
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    is_object = {"right": x >= 30, "left": x < 30, "below": y >= 20, "above": y < 20}[side]
    a_depth[is_object] = 1.0
    inputs = {"a": a, "a_depth": a_depth, "b": b, "b_depth": b_depth}
    np.testing.assert_array_equal(run(DepthMerge(), inputs), np.where(is_object[..., None], a, b))
