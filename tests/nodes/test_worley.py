"""Worley noise against its definition with numpy's own integers."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.input.worley import Worley
from hashes import pcg3d


def random(cell: np.ndarray, seed: int, stream: int) -> np.ndarray:
    start = pcg3d(np.array([seed, 0, stream], np.int64).astype(np.uint32))
    return (pcg3d(cell.astype(np.int64).astype(np.uint32) + start) >> np.uint32(8)) * 2.0**-24


def cells(size, feature_size: float, z: float, seed: int, jitter: float, metric: str):
    """The sorted distances to the 27 points around, and the cell of the nearest."""
    y, x = np.mgrid[: size[1], : size[0]] + 0.5
    p = np.stack([x / feature_size, y / feature_size, np.full_like(x, z)], -1)
    around = np.array(list(np.ndindex(3, 3, 3)))[:, ::-1] - 1
    cell = np.floor(p)[..., None, :] + around
    away = np.abs(cell + 0.5 + jitter * (random(cell, seed, 1) - 0.5) - p[..., None, :])
    far = {"euclidean": np.linalg.norm(away, axis=-1), "manhattan": away.sum(-1), "chebyshev": away.max(-1)}[metric]
    nearest = np.take_along_axis(cell, far.argmin(-1)[..., None, None], axis=-2)[..., 0, :]
    return np.sort(far, axis=-1), nearest


@pytest.mark.parametrize("metric", ["euclidean", "manhattan", "chebyshev"])
@pytest.mark.parametrize(("seed", "jitter"), [(0, 1.0), (77, 0.6)])
def test_it_equals_the_definition(run, metric, seed, jitter):
    size, values = (61, 37), {"size": 11.0, "evolution": 2.3, "seed": seed, "jitter": jitter, "metric": metric}
    far, nearest = cells(size, 11.0, 2.3, seed, jitter, metric)
    expected = {"f1": far[..., 0], "f2": far[..., 1], "f2-f1": far[..., 1] - far[..., 0]}
    for feature, distance in expected.items():
        found = run(Worley(feature=feature, **values), size=size, output="value")[..., 0]
        np.testing.assert_allclose(found, distance, atol=3e-6)
    sure = far[..., 1] - far[..., 0] > 1e-4
    found = run(Worley(**values), size=size, output="cell")
    np.testing.assert_allclose(found[sure], random(nearest, seed, 2)[sure], atol=1e-7)


def test_without_jitter_it_is_a_grid(run):
    found = run(Worley(jitter=0.0, size=8.0, evolution=0.5), size=(16, 16), output="value")[..., 0]
    x = (np.arange(16) + 0.5) / 8 % 1.0 - 0.5
    np.testing.assert_allclose(found, np.hypot(x[None, :], x[:, None]), atol=1e-6)


def test_the_picture_is_the_value(run):
    picture, value = (run(Worley(), size=(20, 10), output=name) for name in ("out", "value"))
    np.testing.assert_array_equal(picture[..., :3], np.repeat(value, 3, axis=-1))
    np.testing.assert_array_equal(picture[..., 3], 1.0)


def test_it_shrinks_with_the_proxy(run):
    full, half = (run(Worley(size=40.0), size=(96, 64), scale=s, output="value")[..., 0] for s in (1.0, 0.5))
    assert np.abs(half - full.reshape(32, 2, 48, 2).mean((1, 3))).max() < 0.02


@pytest.mark.parametrize("metric", ["euclidean", "manhattan", "chebyshev"])
def test_distances_are_distances(run, metric):
    """One step of a pixel changes a distance by no more than that step, and the second point is no nearer than the
    first: a wrong order, a point that is missed or a wrong metric makes jumps."""
    values = {"size": 16.0, "evolution": 0.4, "seed": 3, "jitter": 0.5, "metric": metric}
    first, second, gap = (
        run(Worley(feature=feature, **values), size=(160, 120), output="value")[..., 0]
        for feature in ("f1", "f2", "f2-f1")
    )
    assert (second >= first).all() and np.abs(second - first - gap).max() < 1e-6
    for distance in (first, second):
        steps = [np.abs(np.diff(distance, axis=axis)) for axis in (0, 1)]
        assert max(step.max() for step in steps) <= 1.0 / 16.0 + 1e-5
        assert min(step.max() for step in steps) > 0.9 / 16.0
