"""Velocity of the camera against numpy's projection in 64 bits, and against Blender's Vector pass."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import CAMERA, places, rays, sample_camera, sample_layer
from halation.nodes import CameraModel, look_at
from halation.nodes.geometry.camera_velocity import CameraVelocity
from lens import blender

BEFORE = look_at((2.9, -7.1, 2.5), (0.2, 0.3, 1.0), (1.3, 2.2))
AFTER = look_at((3.2, -6.8, 2.6), (0.7, 0.2, 1.1), (1.35, 2.3))


def seen_by(camera: CameraModel, places: np.ndarray, weight: float, width: int, height: int) -> np.ndarray:
    """Pixel positions of places (weight 1) or directions (weight 0)."""
    found = np.concatenate([places, np.full((*places.shape[:2], 1), weight)], -1) @ np.reshape(camera.rows, (3, 4)).T
    return found[..., :2] / found[..., 2:] * (width, height)


@pytest.mark.parametrize(("width", "height"), [(160, 90), (61, 37), (1, 1)])
def test_the_same_place_seen_by_another_camera(run, width, height):
    depth = np.random.default_rng(3).uniform(2.0, 200.0, (height, width)).astype(np.float32)
    inputs = {"depth": depth, "camera": CAMERA, "before": BEFORE}
    place = np.array(CAMERA.eye) + depth[..., None].astype(float) * rays(CAMERA, width, height)
    here = places(width, height) * (width, height)
    past = here - seen_by(BEFORE, place, 1.0, width, height)
    found = run(CameraVelocity(), inputs)
    assert np.abs(found[..., :2] - past).max() < 1e-4 and (found[..., 2:] == found[..., :2]).all()
    found = run(CameraVelocity(), inputs | {"after": AFTER})
    coming = seen_by(AFTER, place, 1.0, width, height) - here
    assert np.abs(found - np.concatenate([past, coming], -1)).max() < 1e-4


def test_the_sky_only_turns(run):
    depth = np.array([[1e10, np.inf, 0.0, np.nan, 3e9]] * 4, np.float32)
    found = run(CameraVelocity(), {"depth": depth, "camera": CAMERA, "before": BEFORE, "after": AFTER})
    here, ray = places(5, 4) * (5, 4), rays(CAMERA, 5, 4)
    expected = np.concatenate([here - seen_by(BEFORE, ray, 0.0, 5, 4), seen_by(AFTER, ray, 0.0, 5, 4) - here], -1)
    assert np.abs(found - expected).max() < 1e-5
    shift = np.array([[1.0, 0.0, 0.0, 4.0], [0.0, 1.0, 0.0, -2.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]])
    moved = CameraModel(tuple((np.reshape(CAMERA.rows, (3, 4)) @ shift).ravel()))
    assert np.abs(run(CameraVelocity(), {"depth": depth, "camera": CAMERA, "before": moved})).max() < 1e-5


def test_a_still_camera_makes_no_motion(run):
    depth = sample_layer("Depth")[::5, ::5, 0]
    camera = sample_camera()
    found = run(CameraVelocity(), {"depth": depth, "camera": camera, "before": camera, "after": camera})
    assert np.abs(found).max() < 1e-9


def test_blender_s_vector_pass(run):
    """Blender writes before - now and now - after, y up, and leaves the sky still."""
    data = blender()
    cameras = []
    for stand in data["camera_stands"].astype(float):
        rotation, eye = stand[:3, :3].T * [[1.0], [-1.0], [-1.0]], stand[:3, 3]  # right, down, forward
        lens = np.array([[1.0, 0.0, 0.5], [0.0, 64.0 / 36.0, 0.5], [0.0, 0.0, 1.0]])
        cameras.append(CameraModel(tuple((lens @ np.column_stack([rotation, -rotation @ eye])).ravel())))
    depth = data["camera_depth"]
    inputs = {"depth": depth, "camera": cameras[1], "before": cameras[0], "after": cameras[2]}
    found = run(CameraVelocity(), inputs)
    error = np.abs(found - data["camera_vector"] * (-1.0, 1.0, -1.0, 1.0))[depth < 1e9]
    print(error.max(), np.median(error))
    assert error.max() < 0.01 and np.median(error) < 5e-4


def test_a_proxy_moves_as_far(run):
    depth = np.full((20, 30), 5.0, np.float32)
    inputs = {"depth": depth, "camera": CAMERA, "before": BEFORE, "after": AFTER}
    full, half = (run(CameraVelocity(), inputs, scale=scale) for scale in (1.0, 0.5))
    np.testing.assert_allclose(half, full.reshape(10, 2, 15, 2, 4).mean((1, 3)), atol=0.01)


def test_what_lies_behind_the_other_camera_stays(run):
    ahead = look_at(tuple(np.add(CAMERA.eye, np.multiply(CAMERA.forward, 50.0))), (-50.0, 90.0, -9.0), (1.3, 2.2))
    inputs = {"depth": np.full((3, 3), 5.0, np.float32), "camera": CAMERA, "before": ahead}
    assert (run(CameraVelocity(), inputs) == 0.0).all()
