"""Grid warps against scipy's natural cubic splines and its bilinear interpolation."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.distort.grid_warp import GridWarp
from scipy.interpolate import CubicSpline, RegularGridInterpolator
from warps import sample_bilinear, waves

WIDTH, HEIGHT = 96, 64
KNOTS = np.arange(4) / 3
REST = np.stack(np.meshgrid(KNOTS, KNOTS), -1)


def make_grid(seed: int = 2, most: float = 0.07) -> np.ndarray:
    """The places of the points, by row and column, in fractions of the picture."""
    return REST + np.random.default_rng(seed).uniform(-most, most, REST.shape)


def make_node(grid: np.ndarray, **values: object) -> GridWarp:
    points = {f"point_{row + 1}{column + 1}": tuple(map(float, grid[row, column])) for row, column in np.ndindex(4, 4)}
    return GridWarp(**points, **values)


def warp_places(grid: np.ndarray, u: np.ndarray, v: np.ndarray, interpolation: str) -> np.ndarray:
    """Where places of the picture go, both in fractions, by scipy: [..., 2]."""
    if interpolation == "linear":
        return RegularGridInterpolator((KNOTS, KNOTS), grid)(np.stack([v, u], -1))
    down = CubicSpline(KNOTS, grid, axis=0, bc_type="natural")(v)
    return np.array([CubicSpline(KNOTS, row, axis=0, bc_type="natural")(at) for row, at in zip(down, u, strict=True)])


def positions() -> np.ndarray:
    """A picture that is its own positions."""
    y, x = np.mgrid[:HEIGHT, :WIDTH].astype(np.float32) + 0.5
    return np.stack([x / WIDTH, y / HEIGHT, np.ones_like(x), np.ones_like(x)], -1)


@pytest.mark.parametrize("interpolation", ["smooth", "linear"])
@pytest.mark.parametrize("seed", [2, 5])
def test_places_go_where_scipy_says(run, interpolation, seed):
    """What a pixel shows comes from a place that goes to that pixel."""
    grid = make_grid(seed)
    out = run(make_node(grid, interpolation=interpolation, kernel="triangle"), {"image": positions()})
    u, v = out[..., 0].astype(np.float64), out[..., 1].astype(np.float64)
    inside = (out[..., 3] > 0.9999) & (u > 0.02) & (u < 0.98) & (v > 0.02) & (v < 0.98)
    assert inside.mean() > 0.6
    went = warp_places(grid, u[inside], v[inside], interpolation) * (WIDTH, HEIGHT)
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    # A pixel at a crease of the linear grid averages both sides.
    assert np.quantile(np.abs(went - np.stack([x, y], -1)[inside]), 0.9) < 2e-3
    assert np.abs(went - np.stack([x, y], -1)[inside]).max() < 0.3


def test_pictures_are_those_of_scipy(run):
    """Sampled bilinear where the whole picture is moved and stretched evenly."""
    grid = REST * (1.15, 1.1) + (-0.05, 0.02)
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    picture = waves(WIDTH, HEIGHT)
    expected = sample_bilinear(
        picture, (x / WIDTH + 0.05) / 1.15 * WIDTH, (y / HEIGHT - 0.02) / 1.1 * HEIGHT, "nearest"
    )
    out = run(make_node(grid, kernel="triangle", edge="clamp"), {"image": picture})
    np.testing.assert_allclose(out, expected, atol=1e-4)


def test_a_point_takes_its_pixel_along(run):
    """A dot at a point of the grid is where the point was dragged."""
    picture = np.zeros((HEIGHT, WIDTH, 4), np.float32)
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    picture[:] = np.exp(-((x - WIDTH / 3) ** 2 + (y - 2 * HEIGHT / 3) ** 2) / 8)[..., None]
    out = run(GridWarp(point_32=(0.4, 0.6)), {"image": picture})[..., 0]
    row, column = np.unravel_index(out.argmax(), out.shape)
    assert abs(column + 0.5 - 0.4 * WIDTH) <= 1.0 and abs(row + 0.5 - 0.6 * HEIGHT) <= 1.0
    assert out.max() > 0.9


def test_at_rest_it_is_nothing_and_folds_are_finite(run):
    assert GridWarp().identity() == "image" and GridWarp(point_11=(0.1, 0.0)).identity() is None
    folded = make_grid(1, 0.6)
    for interpolation in ("smooth", "linear"):
        assert np.isfinite(run(make_node(folded, interpolation=interpolation), {"image": waves(40, 30)})).all()
    flat = run(make_node(REST * (1.0, 0.0)), {"image": waves(40, 30)})
    np.testing.assert_array_equal(flat, 0.0)


def test_a_proxy_is_bent_the_same(run):
    node, picture = make_node(make_grid()), waves(192, 128)
    small = picture.reshape(64, 2, 96, 2, 4).mean((1, 3))
    full, half = run(node, {"image": picture}), run(node, {"image": small})
    whole = half[..., 3] > 0.999
    difference = np.abs(half - full.reshape(64, 2, 96, 2, 4).mean((1, 3)))[whole]
    assert difference.mean() < 1e-3 and whole.mean() > 0.6
