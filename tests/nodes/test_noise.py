"""Noise against the papers' formulas in 64 bits, on numpy's own integers."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.input.noise import Noise
from hashes import pcg3d
from noises import KINDS, PERLIN, lattice, places, stream

SMOOTH = ("gradient", "value", "simplex")


def folded(fractal: str, layer: np.ndarray, contrast: float, carried: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What a layer adds, and what it leaves for the next."""
    if fractal == "turbulence":
        return np.abs(contrast * layer).clip(0, 1), carried
    if fractal == "ridged":
        crest = (1 - np.abs(contrast * layer).clip(0, 1)) ** 2 * carried
        return crest, (2 * crest).clip(0, 1)
    return layer, carried


def model(p: np.ndarray, node: Noise) -> np.ndarray:
    """All three outputs of the node in double precision, -1..1: [h, w, 3]."""
    if node.fractal == "warped":
        bend = model(p, node.with_values(fractal="fbm", contrast=1.0))[..., 1:]
        p = p + node.warp * np.concatenate([bend, 0 * bend[..., :1]], -1)
    total, carried, strengths = np.zeros(p.shape), np.ones(p.shape), node.gain ** np.arange(node.octaves)
    for octave, strength in enumerate(strengths):
        layer = KINDS[node.kind](p * node.lacunarity**octave, stream(node.seed, octave))
        part, carried = folded(node.fractal, layer, node.contrast, carried)
        total += strength * part / strengths.sum()
    if node.fractal in ("ridged", "turbulence"):
        return 2 * total - 1
    return (node.contrast * total).clip(-1, 1)


def three(run, node: Noise, size: tuple[int, int]) -> np.ndarray:
    """What the node makes, as the model gives it."""
    value, vector = (run(node, size=size, output=name) for name in ("value", "vector"))
    return np.concatenate([2 * value[..., :1] - 1, vector[..., :2]], -1)


def test_hash_has_the_published_values():
    assert pcg3d(np.zeros(3, np.uint32)).tolist() == [2611992518, 2833812075, 1058359340]
    assert pcg3d(np.array([1, 2, 3], np.uint32)).tolist() == [4204755366, 1223881804, 1500469937]


@pytest.mark.parametrize("seed", [0, 1, 77, -5])
def test_white_noise_is_the_hash_to_the_bit(run, seed):
    width, height = 50, 37
    node = Noise(kind="white", size=1.0, octaves=1, contrast=1.0, seed=seed, evolution=3.0)
    y, x = np.mgrid[:height, :width]
    bits = lattice(np.stack([x, y, np.full_like(x, 3)], -1), stream(seed))
    unit = ((bits >> np.uint32(8)) * np.float32(2**-24)).astype(np.float32)
    signed = unit * np.float32(2) - np.float32(1)
    value = 0.5 + np.float32(0.5) * signed[..., 0]
    assert np.array_equal(run(node, size=(width, height), output="value")[..., 0], value)
    assert np.array_equal(run(node, size=(width, height), output="vector")[..., :2], signed[..., 1:])


def test_white_noise_is_uniform(run):
    value = run(Noise(kind="white", size=1.0, octaves=1, contrast=1.0), size=(256, 256), output="value")
    assert value.mean() == pytest.approx(0.5, abs=0.005)
    assert value.std() == pytest.approx(12**-0.5, abs=0.003)


@pytest.mark.parametrize("fractal", ["fbm", "ridged", "turbulence", "warped"])
@pytest.mark.parametrize("kind", SMOOTH)
def test_it_is_the_papers_formula(run, kind, fractal):
    node = Noise(
        kind=kind,
        fractal=fractal,
        size=13.0,
        octaves=3,
        lacunarity=2.5,
        gain=0.6,
        contrast=1.4,
        seed=9,
        evolution=1.3,
        warp=0.7,
    )
    assert np.abs(three(run, node, (64, 48)) - model(places(64, 48, 13.0, 1.3), node)).max() < 2e-5


def test_gradient_noise_is_zero_on_its_lattice(run):
    node = Noise(kind="gradient", size=0.5, octaves=1)  # every pixel center is a lattice point
    assert np.all(run(node, size=(33, 17), output="value") == 0.5)
    assert np.all(run(node, size=(33, 17), output="vector") == 0.0)


def test_simplex_noise_is_zero_on_its_lattice(run):
    """In the plane z = 0 the skewed lattice holds the whole numbers x and y whose sum divides by 3."""
    found = three(run, Noise(kind="simplex", size=0.25, octaves=1), (33, 17))  # pixel centers are at 2x + 1, 2y + 1
    y, x = 2 * np.mgrid[:17, :33] + 1
    on = (x + y) % 3 == 0
    assert np.abs(found[on]).max() < 1e-6 and np.abs(found[~on]).max() > 0.3


def test_simplex_noise_just_reaches_its_ends():
    """The largest sum of any four edges, over a tetrahedron: what the scale is one over."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1)], np.float64)
    corners -= corners.sum(-1, keepdims=True) / 6
    n = 48
    parts = np.array([(a, b, c, n - a - b - c) for a, b, c in np.ndindex(n, n, n) if a + b + c <= n]) / n
    away = (parts @ corners)[:, None] - corners
    reach = np.maximum(0.5 - (away**2).sum(-1), 0) ** 4
    most = 76.88075 * (reach * (away @ PERLIN.T).max(-1)).sum(-1).max()
    assert 0.9999 < most <= 1.0


def test_value_noise_on_its_lattice_is_white_noise(run):
    value, white = (run(Noise(kind=kind, size=0.5, octaves=1), size=(33, 17)) for kind in ("value", "white"))
    assert np.array_equal(value, white)


@pytest.mark.parametrize("kind", KINDS)
def test_noise_keeps_its_range_and_mean(run, kind):
    node = Noise(kind=kind, size=6.0, octaves=5, gain=0.9, contrast=3.0)
    value = run(node, size=(256, 256), output="value")
    vector = run(node, size=(256, 256), output="vector")[..., :2]
    assert value.min() >= 0.0 and value.max() <= 1.0 and np.abs(vector).max() <= 1.0
    assert abs(value.mean() - 0.5) < 0.02 and np.abs(vector.mean((0, 1))).max() < 0.03
    out = run(node, size=(256, 256))
    assert np.array_equal(out[..., 0], value[..., 0]) and np.all(out[..., 3] == 1.0)


def test_variances_of_layers_add(run):
    """Independent layers: var(fBm) = sum gain^2i var / (sum gain^i)^2."""

    def spread(octaves: int) -> float:
        node = Noise(kind="white", size=1.0, octaves=octaves, gain=0.5, contrast=1.0)
        return float(run(node, size=(256, 256), output="value").var())

    assert spread(3) / spread(1) == pytest.approx((1 + 0.25 + 0.0625) / 1.75**2, rel=0.03)


def test_contrast_spreads_from_the_middle(run):
    plain, strong = (run(Noise(contrast=contrast), size=(64, 64), output="value") for contrast in (1.0, 3.0))
    assert np.abs(strong - (0.5 + 3 * (plain - 0.5)).clip(0, 1)).max() < 1e-6


def test_seed_and_evolution_change_the_pattern(run):
    def noise(**values):
        return run(Noise(size=16.0, **values), size=(64, 64), output="value").ravel()

    assert abs(np.corrcoef(noise(seed=0), noise(seed=1))[0, 1]) < 0.35
    assert np.abs(noise(evolution=0.0) - noise(evolution=0.01)).max() < 0.05
    assert np.abs(noise(evolution=0.0) - noise(evolution=0.5)).max() > 0.1


def test_noise_shrinks_with_the_proxy(run):
    node = Noise(kind="gradient", size=40.0, octaves=1, contrast=1.0)
    full, half = (run(node, size=(96, 64), scale=scale, output="value")[..., 0] for scale in (1.0, 0.5))
    averaged = full.reshape(32, 2, 48, 2).mean((1, 3))
    assert np.abs(half - averaged).max() < 2e-3


@pytest.mark.parametrize(("fractal", "mean"), [("ridged", None), ("turbulence", None), ("warped", 0.5)])
@pytest.mark.parametrize("kind", KINDS)
def test_folded_and_warped_layers_keep_the_range(run, kind, fractal, mean):
    node = Noise(kind=kind, fractal=fractal, size=6.0, octaves=5, gain=0.9, contrast=3.0)
    value, vector = (run(node, size=(128, 128), output=name) for name in ("value", "vector"))
    assert value.min() >= 0.0 and value.max() <= 1.0 and np.abs(vector).max() <= 1.0
    assert value.std() > 0.05 and (mean is None or abs(value.mean() - mean) < 0.03)


def test_ridges_and_creases_lie_where_the_noise_is_zero(run):
    """Of one layer: fbm 0 is ridged 1 and turbulence 0, and both are even."""
    plain, ridged, turbulent = (
        three(run, Noise(fractal=fractal, octaves=1, size=16.0, contrast=1.0), (64, 64))
        for fractal in ("fbm", "ridged", "turbulence")
    )
    assert np.abs(ridged - (2 * (1 - np.abs(plain)) ** 2 - 1)).max() < 1e-6
    assert np.abs(turbulent - (2 * np.abs(plain) - 1)).max() < 1e-6


def test_layers_are_as_strong_whatever_they_are(run):
    """var(fBm) = sum gain^2i var / (sum gain^i)^2, for a smooth noise: far layers are independent."""

    def spread(octaves: int) -> float:
        node = Noise(kind="simplex", size=3.0, lacunarity=2.3, octaves=octaves, contrast=1.0)
        return float(run(node, size=(256, 256), output="value").var())

    assert spread(3) / spread(1) == pytest.approx((1 + 0.25 + 0.0625) / 1.75**2, rel=0.05)


def test_unwarped_is_fbm(run):
    plain, warped = (run(Noise(fractal=fractal, warp=0.0), size=(40, 30)) for fractal in ("fbm", "warped"))
    np.testing.assert_array_equal(warped, plain)


@pytest.mark.parametrize("fractal", ["fbm", "ridged", "turbulence", "warped"])
@pytest.mark.parametrize("kind", SMOOTH)
def test_evolution_is_smooth(run, kind, fractal):
    """Ten times smaller a step, ten times smaller a change."""

    def change(step: float) -> float:
        node = Noise(kind=kind, fractal=fractal, size=16.0, octaves=2, contrast=1.0, warp=0.5)
        first, then = (run(node.with_values(evolution=z), size=(48, 48), output="value") for z in (0.7, 0.7 + step))
        return float(np.abs(first - then).mean())

    assert 0.0 < change(0.001) < 0.15 * change(0.01) < 0.002


def test_simplex_features_are_as_large_as_those_of_gradient_noise(run):
    def slope(kind: str) -> float:
        value = run(Noise(kind=kind, octaves=1, contrast=1.0, evolution=0.5), size=(512, 512), output="value")[..., 0]
        return float(np.abs(np.diff(value)).mean() / value.std())

    assert 0.8 < slope("simplex") / slope("gradient") < 1.25


def test_simplex_noise_is_as_strong_at_every_evolution(run):
    node = Noise(kind="simplex", size=4.0, octaves=1, contrast=1.0)
    spreads = [run(node.with_values(evolution=z), size=(256, 256), output="value").std() for z in (0.0, 0.37, 1.0, 5.5)]
    assert np.ptp(spreads) < 0.03 * np.mean(spreads)
