"""Kuwahara filters against their formulas in 64 bits."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from halation.nodes.stylize.kuwahara import Kuwahara
from scipy.ndimage import gaussian_filter, sobel, uniform_filter


def encoded(light):
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def decoded(code):
    return np.where(code <= 0.04045, code / 12.92, ((np.maximum(code, 0) + 0.055) / 1.055) ** 2.4)


def tones_of(picture: np.ndarray) -> np.ndarray:
    """Of an opaque picture; what lies outside of it may be transparent."""
    tones = encoded(picture.astype(np.float64))
    tones[..., 3] = 1.0
    return tones


def light_of(tones: np.ndarray) -> np.ndarray:
    alpha = tones[..., 3:]
    return np.concatenate([decoded(tones[..., :3] / alpha) * alpha, alpha], axis=-1)


def classic(tones: np.ndarray, radius: int, mode: str) -> np.ndarray:
    """Of the four boxes that have the pixel as a corner, the mean of the one that varies least."""

    def boxes(picture: np.ndarray) -> np.ndarray:
        middle, size = (radius + 1) // 2, (radius + 1, radius + 1, 1)
        starts = [(y, x, 0) for y in (radius - middle, -middle) for x in (radius - middle, -middle)]
        return np.array([uniform_filter(picture, size, mode=mode, origin=start) for start in starts])

    means = boxes(tones)
    best = np.argmin((boxes(tones**2) - means**2)[..., :3].sum(-1), axis=0)
    return np.choose(best[..., None], means)


def soft(tones: np.ndarray, radius: float, q: float, smoothing: float | None, mode, step: int = 1) -> np.ndarray:
    """The soft filters by their formula, of every pixel or of one in `step` across and down."""
    height, width = tones.shape[:2]
    gx, gy = (np.stack([sobel(tones[..., c], axis, mode=mode.scipy) for c in range(3)], axis=-1) for axis in (1, 0))
    products = [(a * b).sum(-1) for a, b in ((gx, gx), (gx, gy), (gy, gy))]
    e, f, g = (gaussian_filter(product, smoothing or 1, mode=mode.scipy) for product in products)
    reach = int(2 * radius) + 1
    wide = np.pad(tones, ((reach, reach), (reach, reach), (0, 0)), mode=mode.numpy)
    dy, dx = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    gamma, zeta = 3 * np.pi / 16, 2.0 / radius
    eta = (zeta + np.cos(gamma)) / np.sin(gamma) ** 2
    found = np.zeros_like(tones)
    for y in range(0, height, step):
        for x in range(0, width, step):
            tensor = np.array([[e[y, x], f[y, x]], [f[y, x], g[y, x]]])
            low, high = np.linalg.eigvalsh(tensor)
            a = (high - low) / (high + low) if smoothing and high > 1e-12 else 0.0
            t = np.linalg.eigh(tensor)[1][:, 0] if smoothing else np.array([1.0, 0.0])
            u = (dx * t[0] + dy * t[1]) / (radius * (1 + a))
            v = (-dx * t[1] + dy * t[0]) / (radius / (1 + a))
            inside = u * u + v * v <= 1.0
            u, v = u[inside], v[inside]
            turns = np.arange(8)[:, None] * np.pi / 4
            across, along = v * np.cos(turns) - u * np.sin(turns), u * np.cos(turns) + v * np.sin(turns)
            w = np.maximum(along + zeta - eta * across**2, 0.0) ** 2
            w *= np.exp(-3.125 * (u * u + v * v)) / w.sum(0)
            colors = wide[y : y + 2 * reach + 1, x : x + 2 * reach + 1][inside]
            mean = (w @ colors) / w.sum(1, keepdims=True)
            variance = ((w @ colors**2) / w.sum(1, keepdims=True) - mean**2)[:, :3].sum(-1)
            calm = 1.0 / (1.0 + np.minimum(255.0 * np.sqrt(np.maximum(variance, 0.0)), 1e3) ** q)
            found[y, x] = (calm[:, None] * mean).sum(0) / calm.sum()
    return found[::step, ::step]


@pytest.mark.parametrize("radius", [1, 3, 6])
@pytest.mark.parametrize("size", [(33, 22), (9, 8)])
def test_classic_equals_the_definition(run, hdr, edge, radius, size):
    picture = hdr(*size, opaque=True)
    found = run(Kuwahara(kind="classic", radius=float(radius), edge=edge.name), {"image": picture})
    expected = light_of(classic(tones_of(picture), radius, edge.scipy))
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=2e-6)


@pytest.mark.parametrize("kind", ["generalized", "anisotropic"])
@pytest.mark.parametrize(("radius", "q"), [(2.6, 8.0), (4.3, 2.0)])
def test_soft_sectors_equal_the_formula(run, hdr, edge, kind, radius, q):
    picture = gaussian_filter(np.minimum(hdr(11, 8, opaque=True), 4.0), (0.7, 0.7, 0))
    node = Kuwahara(kind=kind, radius=radius, sharpness=q, smoothing=1.5, edge=edge.name)
    expected = light_of(soft(tones_of(picture), radius, q, 1.5 if kind == "anisotropic" else None, edge))
    found = run(node, {"image": picture})
    np.testing.assert_allclose(found, expected, rtol=2e-5, atol=2e-6)


@pytest.mark.parametrize("kind", ["classic", "generalized", "anisotropic"])
def test_flat_stays(run, kind):
    flat = np.full((12, 17, 4), 0.7, np.float32)
    np.testing.assert_allclose(run(Kuwahara(kind=kind), {"image": flat}), flat, rtol=1e-6)


def step_of(turns: int) -> np.ndarray:
    step = np.ones((22, 24, 4), np.float32)
    step[:, :13, :3] = 0.1
    return np.ascontiguousarray(np.rot90(step, turns))


@pytest.mark.parametrize("kind", ["classic", "anisotropic"])
@pytest.mark.parametrize("radius", [1.0, 2.0, 4.0, 7.0])
@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_a_step_stays(run, kind, radius, turns):
    """On either side there is a quadrant, or an ellipse along the step, that does not reach across."""
    step = step_of(turns)
    np.testing.assert_allclose(run(Kuwahara(kind=kind, radius=radius), {"image": step}), step, atol=1e-6)


@pytest.mark.parametrize(("radius", "softened"), [(2.0, 5.5e-5), (4.0, 0.0265), (5.0, 0.021), (8.0, 0.0122)])
def test_generalized_softens_a_step_as_its_sectors_overlap(run, radius, softened):
    """Sectors begin a little behind the pixel, so that none beside a step is quite calm: by the formula so much."""
    step = step_of(0)
    found = run(Kuwahara(kind="generalized", radius=radius), {"image": step})
    row = light_of(soft(tones_of(step[:1]), radius, 8.0, None, SimpleNamespace(scipy="nearest", numpy="edge")))
    np.testing.assert_allclose(found, np.broadcast_to(row, found.shape), atol=1e-6)
    assert np.abs(found - step).max() == pytest.approx(softened, rel=0.01)


@pytest.mark.parametrize("kind", ["classic", "generalized", "anisotropic"])
@pytest.mark.parametrize("radius", [3.3, 5.0])
def test_turning_the_picture_turns_the_strokes(run, hdr, kind, radius):
    picture = np.minimum(hdr(15, 15, opaque=True), 4.0)
    still = run(Kuwahara(kind=kind, radius=radius), {"image": picture})
    for turn in (np.rot90, np.flipud, np.fliplr):
        turned = run(Kuwahara(kind=kind, radius=radius), {"image": np.ascontiguousarray(turn(picture))})
        np.testing.assert_allclose(turned, turn(still), rtol=2e-5, atol=1e-6)


def test_no_radius_changes_nothing():
    assert Kuwahara(radius=0.0).identity() == "image"


@pytest.mark.parametrize(("kind", "radius"), [("generalized", 17.0), ("anisotropic", 24.0)])
def test_a_wide_brush_of_cells_paints_as_one_of_pixels(run, hdr, kind, radius):
    """Means and variances of cells are those of their pixels; only the weights of far pixels are a little coarser."""
    picture = np.minimum(hdr(97, 67, opaque=True), 1.0)
    picture[:, :40, :3] *= 0.2
    picture = gaussian_filter(picture, (2.0, 2.0, 0))
    found = run(Kuwahara(kind=kind, radius=radius, smoothing=4.0), {"image": picture})
    clamp = SimpleNamespace(scipy="nearest", numpy="edge")
    expected = soft(tones_of(picture), radius, 8.0, 4.0 if kind == "anisotropic" else None, clamp, step=16)
    difference = np.abs(tones_of(found)[::16, ::16] - expected)
    assert expected[..., :3].std() > 0.02
    assert difference.mean() <= 1e-3


@pytest.mark.parametrize(("kind", "radius"), [("generalized", 40.0), ("anisotropic", 24.0)])
def test_a_brush_larger_than_the_picture_equals_the_formula(run, hdr, edge, kind, radius):
    """Cells would be as large as the picture: where it repeats, its mean was off by up to 0.022."""
    picture = np.minimum(hdr(13, 9, opaque=True), 1.0)
    picture[:, :6, :3] *= 0.2
    found = run(Kuwahara(kind=kind, radius=radius, smoothing=4.0, edge=edge.name), {"image": picture})
    expected = soft(tones_of(picture), radius, 8.0, 4.0 if kind == "anisotropic" else None, edge, step=4)
    np.testing.assert_allclose(found[::4, ::4], light_of(expected), rtol=1e-4, atol=1e-5)
