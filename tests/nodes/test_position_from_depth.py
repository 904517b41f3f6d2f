"""Positions from depth and back against numpy in float64, and against what a renderer wrote."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import CAMERA, rays, sample_camera, sample_layer
from halation.nodes.geometry.depth_from_position import DepthFromPosition
from halation.nodes.geometry.position_from_depth import PositionFromDepth


@pytest.mark.parametrize(("width", "height"), [(61, 37), (1, 1), (2, 9)])
def test_the_place_is_eye_plus_depth_times_ray(run, width, height):
    depth = np.random.default_rng(3).uniform(0.1, 200.0, (height, width)).astype(np.float32)
    found = run(PositionFromDepth(), {"depth": depth, "camera": CAMERA})
    expected = np.array(CAMERA.eye) + depth[..., None].astype(float) * rays(CAMERA, width, height)
    assert (np.abs(found - expected) <= 4e-7 * (np.abs(expected) + depth[..., None] + 10.0)).all()
    back = run(DepthFromPosition(), {"position": found, "camera": CAMERA})[..., 0]
    np.testing.assert_allclose(back, depth, rtol=1e-6, atol=4e-6)


def test_what_a_renderer_wrote(run):
    """The sample: its camera by least squares, its positions from its depth and the other way round."""
    camera, depth, position = sample_camera(), sample_layer("Depth")[..., 0], sample_layer("Position")
    there = depth < 1e9
    found = run(PositionFromDepth(), {"depth": depth, "camera": camera})
    assert np.abs(found - position)[there].max() < 5e-5
    back = run(DepthFromPosition(), {"position": position, "camera": camera})[..., 0]
    assert np.abs(back - depth)[there].max() < 5e-5
    assert (found[~there] == 0.0).all() and (back[~there] == 1e10).all()


def test_nothing_stays_nothing(run):
    depth = np.array([[1e10, np.inf, -1.0, 0.0, np.nan, 1e9, 2.0]], np.float32)
    found = run(PositionFromDepth(), {"depth": depth, "camera": CAMERA})
    assert (found[0, :6] == 0.0).all() and (found[0, 6] != 0.0).all()
    behind = np.array(CAMERA.eye) - np.array(CAMERA.forward)
    position = np.array([[np.zeros(3), behind, np.full(3, np.nan), np.full(3, np.inf)]], np.float32)
    assert (run(DepthFromPosition(), {"position": position, "camera": CAMERA}) == 1e10).all()


def test_half_size_is_every_other_place(run):
    """A pixel of a proxy lies a quarter of it away from the pixel that its depth is of."""
    depth = np.full((20, 30), 5.0, np.float32)
    full, half = (run(PositionFromDepth(), {"depth": depth, "camera": CAMERA}, scale=scale) for scale in (1.0, 0.5))
    mean = full.reshape(10, 2, 15, 2, 3).mean((1, 3))
    np.testing.assert_allclose(half, mean, atol=2e-6)
