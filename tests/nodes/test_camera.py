"""Cameras against numpy's linear algebra."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import CameraModel, look_at


def matrix(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A camera of known parts: focal lengths and center; a rotation of rows right, down, forward; its eye."""
    rng = np.random.default_rng(seed)
    rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    rotation[2] *= np.sign(np.linalg.det(rotation))
    lens = np.array([[rng.uniform(0.8, 3), 0, rng.uniform(0.3, 0.7)], [0, rng.uniform(0.8, 3), 0.5], [0, 0, 1]])
    return lens, rotation, rng.uniform(-10, 10, 3)


@pytest.mark.parametrize("seed", range(5))
def test_its_parts_come_out_of_its_matrix(seed):
    lens, rotation, eye = matrix(seed)
    whole = lens @ np.column_stack([rotation, -rotation @ eye])
    camera = CameraModel(tuple(whole.ravel()))
    assert np.allclose(camera.eye, eye, atol=1e-9)
    assert np.allclose([camera.right, camera.down, camera.forward], rotation, atol=1e-12)
    assert np.allclose([camera.focal, camera.center], [lens.diagonal()[:2], lens[:2, 2]], atol=1e-12)
    inverse = np.linalg.inv(np.vstack([whole, [0, 0, 0, 1]]))[:3]
    assert np.allclose(np.reshape(camera.inverse, (3, 4)), inverse, atol=1e-9)
    place = eye + rotation.T @ [0.3, -0.2, 4.0]
    u, v, depth = camera.project(tuple(place))
    assert np.allclose(np.array([u, v, 1.0]) * depth, whole @ [*place, 1.0], atol=1e-9) and np.isclose(depth, 4.0)


@pytest.mark.parametrize("target", [(0.3, 0.2, 0.5), (1.0, -5.0, 9.0), (1.0, -5.0, -9.0)])
def test_what_it_looks_at_is_in_the_middle(target):
    camera = look_at((1.0, -5.0, 2.0), target, (1.2, 2.0))
    distance = np.linalg.norm(np.subtract(target, (1.0, -5.0, 2.0)))
    assert np.allclose(camera.project(target), (0.5, 0.5, distance))
    assert np.allclose(camera.eye, (1.0, -5.0, 2.0)) and np.allclose(camera.focal, (1.2, 2.0))
    frame = np.array([camera.right, camera.down, camera.forward])
    assert np.allclose(frame @ frame.T, np.eye(3)) and np.isclose(np.linalg.det(frame), 1.0)
    assert camera.right[2] == 0.0, "the horizon is level"
