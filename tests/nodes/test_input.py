"""Constant, Ramp, Checker and Noise against closed forms, OpenImageIO and numpy's own integers."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.input.checker import Checker
from halation.nodes.input.constant import Constant
from halation.nodes.input.noise import Noise
from halation.nodes.input.ramp import Ramp
from hashes import pcg3d

RED, BLUE = (1.0, 0.25, 0.0, 1.0), (0.0, 0.5, 4.0, 0.5)


def oiio_canvas(width: int, height: int) -> oiio.ImageBuf:
    return oiio.ImageBuf(oiio.ImageSpec(width, height, 4, "float"))


def centers(width: int, height: int) -> tuple[np.ndarray, np.ndarray]:
    y, x = np.mgrid[:height, :width] + 0.5
    return x, y


def lattice(cell: np.ndarray, seed: int, octave: int) -> np.ndarray:
    """The hashed bits of integer cells [..., 3]."""
    stream = pcg3d(np.array([seed, octave, 0], np.int64).astype(np.uint32))
    return pcg3d(cell.astype(np.int64).astype(np.uint32) + stream)


def test_constant_fills_the_canvas(run):
    out = run(Constant(color=BLUE), size=(7, 5))
    assert out.shape == (5, 7, 4)
    assert np.all(out == np.array(BLUE, np.float32))


def test_linear_ramp_is_the_gradient_of_openimageio(run):
    width, height = 33, 4
    ends = Ramp(start=(0.5 / width, 0.5), end=(1 - 0.5 / width, 0.5), first=RED, second=BLUE)
    reference = oiio_canvas(width, height)
    oiio.ImageBufAlgo.fill(reference, RED, BLUE, RED, BLUE)
    assert np.abs(run(ends, size=(width, height)) - reference.get_pixels("float")).max() < 1e-6


def test_ramp_runs_along_its_axis_in_pixels(run):
    size, start, end = (40, 20), np.array([0.25, 0.1]), np.array([0.75, 0.9])
    out = run(Ramp(start=tuple(start), end=tuple(end)), size=size, output="value")[..., 0]
    x, y = centers(*size)
    axis = (end - start) * size
    t = ((x - start[0] * size[0]) * axis[0] + (y - start[1] * size[1]) * axis[1]) / (axis @ axis)
    assert np.abs(out - t.clip(0, 1)).max() < 1e-6


def test_radial_ramp_is_round_in_a_wide_picture(run):
    size = (64, 32)
    out = run(Ramp(shape="radial", start=(0.5, 0.5), end=(0.75, 0.5)), size=size, output="value")[..., 0]
    x, y = centers(*size)
    assert np.abs(out - (np.hypot(x - 32, y - 16) / 16).clip(0, 1)).max() < 1e-6


def test_angular_ramp_turns_clockwise_from_the_end(run):
    size = (31, 31)
    out = run(Ramp(shape="angular", start=(0.5, 0.5), end=(0.5, 1.0)), size=size, output="value")[..., 0]
    x, y = centers(*size)
    turn = ((np.arctan2(y - 15.5, x - 15.5) - np.pi / 2) / (2 * np.pi)) % 1.0
    distance = np.abs(out - turn)
    distance[15, 15] = 0.0  # the center has no direction
    assert np.minimum(distance, 1 - distance).max() < 1e-6
    assert out[15, 5] == pytest.approx(0.25, abs=1e-6)  # left comes a quarter turn after down


def test_smooth_ramp_eases_in_and_out(run):
    straight, eased, half = (
        run(Ramp(smoothness=amount), size=(64, 1), output="value")[..., 0] for amount in (0.0, 1.0, 0.5)
    )
    assert np.abs(eased - straight**2 * (3 - 2 * straight)).max() < 1e-6
    assert np.abs(half - 0.5 * (straight + eased)).max() < 1e-6


def test_ramp_mixes_premultiplied_colors(run):
    colors, value = (run(Ramp(first=RED, second=BLUE), size=(16, 2), output=name) for name in ("out", "value"))
    assert np.abs(colors - (np.array(RED) * (1 - value) + np.array(BLUE) * value)).max() < 1e-6


@pytest.mark.parametrize("shape", ["linear", "radial", "angular"])
def test_ramp_without_length_is_finite(run, shape):
    assert np.isfinite(run(Ramp(shape=shape, start=(0.5, 0.5), end=(0.5, 0.5)), size=(9, 9))).all()


@pytest.mark.parametrize("offset", [(0.0, 0.0), (3.0, -5.0)])
def test_checker_is_the_checker_of_openimageio(run, offset):
    reference = oiio_canvas(45, 31)
    oiio.ImageBufAlgo.checker(
        reference, 8, 8, 1, RED, BLUE, xoffset=int(offset[0]), yoffset=int(offset[1]), zoffset=0
    )
    out = run(Checker(size=8.0, first=RED, second=BLUE, offset=offset), size=(45, 31))
    assert np.array_equal(out, reference.get_pixels("float"))


def test_checker_shrinks_with_the_proxy(run):
    full, half = (run(Checker(size=8.0, offset=(4.0, 2.0)), size=(64, 48), scale=scale) for scale in (1.0, 0.5))
    assert half.shape == (24, 32, 4)
    assert np.array_equal(half, full[::2, ::2])


def test_hash_has_the_published_values():
    assert pcg3d(np.zeros(3, np.uint32)).tolist() == [2611992518, 2833812075, 1058359340]
    assert pcg3d(np.array([1, 2, 3], np.uint32)).tolist() == [4204755366, 1223881804, 1500469937]


@pytest.mark.parametrize("seed", [0, 1, 77, -5])
def test_white_noise_is_the_hash_to_the_bit(run, seed):
    width, height = 50, 37
    node = Noise(kind="white", size=1.0, octaves=1, contrast=1.0, seed=seed, evolution=3.0)
    y, x = np.mgrid[:height, :width]
    bits = lattice(np.stack([x, y, np.full_like(x, 3)], -1), seed, 0)
    unit = ((bits >> np.uint32(8)) * np.float32(2**-24)).astype(np.float32)
    signed = unit * np.float32(2) - np.float32(1)
    value = 0.5 + np.float32(0.5) * signed[..., 0]
    assert np.array_equal(run(node, size=(width, height), output="value")[..., 0], value)
    assert np.array_equal(run(node, size=(width, height), output="vector")[..., :2], signed[..., 1:])


def test_white_noise_is_uniform(run):
    value = run(Noise(kind="white", size=1.0, octaves=1, contrast=1.0), size=(256, 256), output="value")
    assert value.mean() == pytest.approx(0.5, abs=0.005)
    assert value.std() == pytest.approx(12**-0.5, abs=0.003)


PERLIN = np.array([
    (1, 1, 0), (-1, 1, 0), (1, -1, 0), (-1, -1, 0), (1, 0, 1), (-1, 0, 1), (1, 0, -1), (-1, 0, -1),
    (0, 1, 1), (0, -1, 1), (0, 1, -1), (0, -1, -1), (1, 1, 0), (0, -1, 1), (-1, 1, 0), (0, -1, -1),
], np.float64)
"""The sixteen cases of Perlin's reference implementation (2002): x, y and z of each edge."""


def smooth_noise(kind: str, size: tuple[int, int], feature: float, z: float, seed: int, octave: int) -> np.ndarray:
    """One layer in double precision, corner by corner: [h, w, 3]."""
    x, y = centers(*size)
    p = np.stack([x / feature, y / feature, np.full_like(x, z)], -1)
    cell, inside = np.floor(p), p - np.floor(p)
    fade = inside**3 * (inside * (inside * 6 - 15) + 10)
    total = np.zeros((*p.shape[:2], 3))
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, fade, 1 - fade), -1)
        bits = lattice(cell + corner, seed, octave)
        if kind == "value":
            part = (bits >> np.uint32(8)) * 2.0**-24 * 2 - 1
        else:
            part = np.einsum("hwcj,hwj->hwc", PERLIN[bits >> np.uint32(28)], inside - corner) * 0.9649214
        total += weight[..., None] * part
    return total


@pytest.mark.parametrize("kind", ["gradient", "value"])
def test_smooth_noise_is_the_papers_formula(run, kind):
    size, values = (64, 48), {"octaves": 3, "lacunarity": 2.5, "gain": 0.6, "contrast": 1.0, "seed": 9}
    node = Noise(kind=kind, size=13.0, evolution=1.3, **values)
    strengths = [0.6**i for i in range(3)]
    layers = (
        strength * smooth_noise(kind, size, 13.0 / 2.5**i, 1.3 * 2.5**i, 9, i) for i, strength in enumerate(strengths)
    )
    expected = sum(layers) / sum(strengths)
    assert np.abs(run(node, size=size, output="value")[..., 0] - (0.5 + 0.5 * expected[..., 0])).max() < 1e-5
    assert np.abs(run(node, size=size, output="vector")[..., :2] - expected[..., 1:]).max() < 1e-5


def test_gradient_noise_is_zero_on_its_lattice(run):
    node = Noise(kind="gradient", size=0.5, octaves=1)  # every pixel center is a lattice point
    assert np.all(run(node, size=(33, 17), output="value") == 0.5)
    assert np.all(run(node, size=(33, 17), output="vector") == 0.0)


def test_value_noise_on_its_lattice_is_white_noise(run):
    value, white = (run(Noise(kind=kind, size=0.5, octaves=1), size=(33, 17)) for kind in ("value", "white"))
    assert np.array_equal(value, white)


@pytest.mark.parametrize("kind", ["gradient", "value", "white"])
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
