"""Distance field against scipy's exact Euclidean distance transform and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.edge.distance_field import DistanceField
from scipy.ndimage import distance_transform_edt, gaussian_filter


def exact(mask: np.ndarray) -> np.ndarray:
    """The edge of a hard mask lies half a pixel before the first pixel of the other kind."""
    return np.where(mask, 0.5 - distance_transform_edt(mask), distance_transform_edt(~mask) - 0.5)


def masks() -> dict[str, np.ndarray]:
    random = np.random.default_rng(6)
    y, x = np.mgrid[:97, :141]
    return {
        "blobs": gaussian_filter(random.random((97, 141)), 4.0) > 0.52,
        "dust": random.random((97, 141)) > 0.99,
        "circle": (x - 70) ** 2 + (y - 40) ** 2 < 900,
        "one pixel": (x == 3) & (y == 90),
        "narrow": random.random((1, 60)) > 0.8,
    }


@pytest.mark.parametrize("name", masks())
def test_it_equals_scipy(run, name):
    mask = masks()[name]
    found = run(DistanceField(), {"mask": mask.astype(np.float32)})[..., 0]
    np.testing.assert_allclose(found, exact(mask), rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("angle", [0.0, 20.0, 45.0, 70.0, 90.0])
@pytest.mark.parametrize("offset", [0.0, 0.3, 0.77])
def test_a_soft_edge_lies_between_pixels(run, angle, offset):
    """A half plane whose border pixels are covered in part, at its distance by geometry."""
    y, x = np.mgrid[:40, :40]
    normal = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    away = (x - 19.5) * normal[0] + (y - 19.5) * normal[1] - offset
    finer = (np.arange(16) + 0.5) / 16 - 0.5
    mask = np.mean([away + dx * normal[0] + dy * normal[1] < 0.0 for dx in finer for dy in finer], axis=0)
    found = run(DistanceField(), {"mask": mask.astype(np.float32)})[..., 0]
    # Sixteen samples know an axis-aligned edge to 1/32 pixel; a slanted one is known to half a pixel's diagonal.
    error = np.abs(found - away)[10:30, 10:30]
    assert error.max() <= (1 / 32 if angle % 90.0 == 0.0 else 2.0**-0.5)


@pytest.mark.parametrize("level", [0.0, 1.0])
@pytest.mark.parametrize("size", [(30, 40), (1, 1)])
def test_a_mask_without_an_edge(run, level, size):
    found = run(DistanceField(), {"mask": np.full(size, level, np.float32)})
    np.testing.assert_allclose(found, np.hypot(*size) * (-1.0 if level else 1.0), rtol=1e-6)


def test_the_inverse_mask_is_the_negative_distance(run):
    mask = masks()["blobs"].astype(np.float32)
    found, inverse = (run(DistanceField(), {"mask": one}) for one in (mask, 1.0 - mask))
    np.testing.assert_array_equal(inverse, -found)


def test_holes_are_outside(run):
    mask = np.ones((9, 9), np.float32)
    mask[4, 4] = np.nan
    assert run(DistanceField(), {"mask": mask})[4, 4, 0] == pytest.approx(0.5)
