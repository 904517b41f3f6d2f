"""Film grain: its formula in 64 bits, and the statistics that it promises, measured."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import graph_of
from halation.graph import Port
from halation.nodes.stylize.film_grain import FilmGrain
from halation.renderer import RenderRequest
from hashes import normal3, pcg3d
from scipy.interpolate import BSpline
from scipy.stats import kstest

MIDDLE, FRAME = 0.18, 1


def gray(level: float, size: int = 256) -> np.ndarray:
    picture = np.full((size, size, 4), level, np.float32)
    picture[..., 3] = 1.0
    return picture


def weights(at: np.ndarray) -> np.ndarray:
    """What the cells around positions count, by scipy's B-spline, so that squares sum to 1: [3, n]."""
    spline = BSpline.basis_element([-1.5, -0.5, 0.5, 1.5], extrapolate=False)
    found = np.stack([np.nan_to_num(spline(at - (np.floor(at) + k + 0.5))) for k in (-1, 0, 1)])
    return found / np.linalg.norm(found, axis=0)


def grain(node: FilmGrain, width: int, height: int) -> np.ndarray:
    """The normal numbers of every pixel: [h, w, 3]."""
    x, y = ((np.arange(count) + 0.5) / max(node.size, 1.0) for count in (width, height))
    stream = pcg3d(np.array([node.seed, FRAME if node.animate else 0, 0], np.uint32))
    found = np.zeros((height, width, 3))
    for j, down in enumerate(weights(y)):
        for i, across in enumerate(weights(x)):
            cell = (np.floor(x)[None, :] + i - 1, np.floor(y)[:, None] + j - 1, 0)
            found += (down[:, None] * across)[..., None] * np.moveaxis(normal3(cell, stream), 0, -1)
    correlation = np.full((3, 3), 1 - node.color) + np.eye(3) * node.color
    values, vectors = np.linalg.eigh(correlation)
    return found @ (vectors * np.sqrt(values.clip(0))) @ vectors.T


def spread(node: FilmGrain, light: np.ndarray) -> np.ndarray:
    """The standard deviation of the logarithm of light."""
    u = light / (light + MIDDLE)
    tone = node.shadows * (1 - u) ** 2 + 2 * node.midtones * u * (1 - u) + node.highlights * u**2
    return np.log(2) * node.amount * node.size / np.hypot(node.size, 0.55) * 2 * np.sqrt(u * (1 - u)) * tone


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"size": 3.7, "color": 1.0, "seed": 9},
        {"size": 0.4, "color": 0.0, "animate": False},
        {"amount": 1.0, "shadows": 0.3, "midtones": 2.0, "highlights": 1.4},
    ],
)
def test_it_is_the_formula(run, hdr, values):
    node, picture = FilmGrain(**values), hdr(41, 27)
    straight = picture[..., :3].astype(np.float64) / picture[..., 3:]
    sigma = spread(node, straight)
    expected = straight * np.exp(sigma * grain(node, 41, 27) - sigma**2 / 2) * picture[..., 3:]
    found = run(node, {"image": picture})
    np.testing.assert_allclose(found[..., :3], expected, rtol=5e-5)
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])


@pytest.mark.parametrize("level", [0.002, 0.18, 1.0, 30.0])
def test_the_average_stays_and_the_variance_is_the_formulas(run, level):
    node = FilmGrain(amount=0.5, size=1.0, color=1.0)
    light = run(node, {"image": gray(level)})[..., :3].astype(np.float64)
    sigma = float(spread(node, np.array(level)))
    width = light.size / 2.0  # neighbors share a little
    assert abs(light.mean() / level - 1) < 4 * np.sqrt(np.expm1(sigma**2) / width)
    assert light.var() / level**2 == pytest.approx(np.expm1(sigma**2), rel=0.04)


def test_it_is_strongest_at_middle_gray_and_gone_at_the_ends(run):
    levels = MIDDLE * 4.0 ** np.arange(-6, 7)
    found = [np.log2(run(FilmGrain(color=0.0), {"image": gray(level, 64)})[..., 0] / level).std() for level in levels]
    assert np.argmax(found) == 6 and found[6] == pytest.approx(0.2 * 1.5 / np.hypot(1.5, 0.55), rel=0.05)
    np.testing.assert_allclose(found, found[::-1], rtol=0.02)  # as weak in light as in shade
    assert found[0] < 0.05 * found[6]
    black = gray(0.0, 8)
    np.testing.assert_array_equal(run(FilmGrain(), {"image": black}), black)


def test_it_is_normal(run):
    """Clumps that are far enough apart are independent."""
    light = run(FilmGrain(size=1.0, color=1.0), {"image": gray(MIDDLE)})[::3, ::3, :3].astype(np.float64)
    sigma = float(spread(FilmGrain(size=1.0), np.array(MIDDLE)))
    assert kstest((np.log(light / MIDDLE).ravel() + sigma**2 / 2) / sigma, "norm").pvalue > 0.05


def test_clumps_are_as_large_as_the_size_says(run):
    """The correlation along a row is that of the splines, averaged over where pixels lie in cells."""
    size = 4
    node = FilmGrain(amount=0.1, size=float(size), color=0.0)
    field = np.log(run(node, {"image": gray(MIDDLE, 384)})[..., 0].astype(np.float64))
    field = (field - field.mean()) / field.std()
    at = (np.arange(12 * size) + 0.5) / size
    spans = np.zeros((len(at), 16))  # what each cell counts for each pixel
    for k, part in enumerate(weights(at)):
        spans[np.arange(len(at)), np.floor(at).astype(int) + k] = part
    alike = spans @ spans.T
    for lag in (1, 2, 4, 8, 12):
        expected = np.mean([alike[start, start + lag] for start in range(8, 8 + size)])
        for pair in (field[:, lag:] * field[:, :-lag], field[lag:] * field[:-lag]):
            assert pair.mean() == pytest.approx(expected, abs=0.03)


@pytest.mark.parametrize("color", [0.0, 0.3, 1.0])
def test_color_is_how_little_the_layers_share(run, color):
    light = np.log(run(FilmGrain(size=1.0, color=color), {"image": gray(MIDDLE)})[..., :3]).reshape(-1, 3)
    assert np.abs(np.corrcoef(light.T)[np.triu_indices(3, 1)] - (1 - color)).max() < 0.015


def test_a_proxy_averages_as_the_eye_would(run):
    """Selwyn: over areas larger than clumps, the deviation falls as the root of the area grows."""
    node, picture = FilmGrain(amount=0.1, size=1.5, color=0.0), gray(MIDDLE, 512)
    full = run(node, {"image": picture})[..., 0].astype(np.float64)
    for factor in (2, 4):
        side = 512 // factor
        averaged = full.reshape(side, factor, side, factor).mean((1, 3))
        proxy = run(node, {"image": picture}, scale=1 / factor)[..., 0]
        assert proxy.std() == pytest.approx(averaged.std(), rel=0.15)


def test_frames_differ_on_demand(renderer):
    picture = gray(MIDDLE, 32)
    for animate in (False, True):
        graph = graph_of(FilmGrain(animate=animate), {"image": picture})
        one, again, other = (
            renderer.render(graph, RenderRequest({"image": picture}, {"out": Port("outputs", "out")}, frame=frame))[
                "out"
            ]
            for frame in (3, 3, 4)
        )
        assert np.array_equal(one, again) and np.array_equal(one, other) != animate


def test_without_amount_it_vanishes():
    assert FilmGrain(amount=0.0).identity() == "image"
    assert FilmGrain(shadows=0.0, midtones=0.0, highlights=0.0).identity() == "image"
    assert FilmGrain(shadows=0.0, midtones=0.0).identity() is None
