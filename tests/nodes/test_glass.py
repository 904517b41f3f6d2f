"""Glass against Snell's law in 64 bits and scipy's interpolation."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.distort.glass import Glass
from warps import sample_bilinear, waves


def snell(dx: np.ndarray, dy: np.ndarray, thickness: float, index: float) -> tuple[np.ndarray, np.ndarray]:
    """By angles: the ray comes from straight above a surface of this slope."""
    steep = np.hypot(dx, dy)
    angle = np.arctan(steep)
    shift = thickness * np.tan(angle - np.arcsin(np.sin(angle) / index))
    return shift * dx / np.maximum(steep, 1e-30), shift * dy / np.maximum(steep, 1e-30)


@pytest.mark.parametrize("size", [(33, 26), (3, 2), (1, 1)])
@pytest.mark.parametrize(("index", "dispersion"), [(1.5, 0.0), (1.33, 0.1), (2.4, 0.3)])
def test_it_bends_by_snells_law(run, hdr, edge, size, index, dispersion):
    picture, height = hdr(*size), size[1]
    surface = np.random.default_rng(9).random((size[1], size[0])).astype(np.float32)
    wide = np.pad(surface.astype(np.float64), 1, mode="edge") * 0.1 * height
    dx, dy = (wide[1:-1, 2:] - wide[1:-1, :-2]) / 2, (wide[2:, 1:-1] - wide[:-2, 1:-1]) / 2
    y, x = np.mgrid[: size[1], : size[0]] + 0.5
    places = np.linspace(-1, 1, 7) if dispersion else np.zeros(1)
    response = np.stack([np.maximum(-places, 0), 1 - np.abs(places), np.maximum(places, 0), places * 0 + 1], -1)
    response = response / response.sum(0) if dispersion else np.ones((1, 4))
    expected = 0
    for weight, place in zip(response, places, strict=True):
        right, down = snell(dx, dy, 0.2 * height, index + place * dispersion / 2)
        expected = expected + weight * sample_bilinear(picture, x + right, y + down, edge.scipy_map)
    node = Glass(relief=0.1, thickness=0.2, index=index, dispersion=dispersion, samples=7, edge=edge.name)
    out = run(node, {"image": picture, "surface": surface})
    assert np.abs(out - expected).max() < 1e-5 * picture.max()


def test_a_wedge_moves_everything_alike(run):
    """A prism of 45 degrees and index sqrt(2) deviates by 15 degrees."""
    picture = waves(64, 32)
    surface = np.broadcast_to(np.arange(64) / 32, (32, 64)).astype(np.float32)
    node = Glass(relief=1.0, thickness=0.5, index=np.sqrt(2), dispersion=0.0)
    out = run(node, {"image": picture, "surface": surface})
    y, x = np.mgrid[:32, :64] + 0.5
    expected = sample_bilinear(picture, x + 16 * np.tan(np.radians(15)), y, "nearest")
    assert np.abs(out - expected)[:, 1:-8].max() < 1e-5


def test_flat_glass_shows_the_picture(run, hdr):
    picture = hdr(23, 17)
    out = run(Glass(dispersion=0.0), {"image": picture, "surface": np.full((17, 23), 0.7)})
    np.testing.assert_array_equal(out, picture)
    assert Glass(relief=0.0).identity() == "image" and Glass(index=1.0, dispersion=0.0).identity() == "image"


def test_hammered_glass_keeps_an_even_picture_and_follows_its_seed(run):
    even = run(Glass(), {"image": np.full((21, 33, 4), 0.37)})
    assert np.abs(even - 0.37).max() < 1e-6
    picture = waves(48, 40)
    one, same, other = (run(Glass(seed=seed), {"image": picture}) for seed in (1, 1, 2))
    assert np.array_equal(one, same) and np.abs(one - other).max() > 0.01


@pytest.mark.parametrize("wild", [np.nan, np.inf, 1e30])
def test_wild_surfaces_stay_harmless(run, hdr, wild):
    surface = np.zeros((10, 11), np.float32)
    surface[4, 5] = wild
    assert np.isfinite(run(Glass(edge="wrap"), {"image": hdr(11, 10), "surface": surface})).all()
