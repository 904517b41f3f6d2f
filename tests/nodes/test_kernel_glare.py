"""Kernel glare against scipy's convolution, its starburst against the transform of a polygon (Lee and Mittra 1983)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.glow.kernel_glare import KernelGlare
from scipy.ndimage import map_coordinates
from scipy.signal import fftconvolve

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
WHOLE = {"threshold": 0.0, "intensity": 1.0, "quality": "full"}


def spread(picture: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    height, width = picture.shape[:2]
    down, across = kernel.shape[0] // 2, kernel.shape[1] // 2
    whole = [fftconvolve(picture[..., c].astype(np.float64), kernel[..., c].astype(np.float64)) for c in range(3)]
    return np.stack(whole, axis=-1)[down : down + height, across : across + width]


def even(kernel: np.ndarray) -> np.ndarray:
    """As bright as 1 in sum."""
    color = np.maximum(kernel[..., :3].astype(np.float64), 0.0)
    return color / (color.sum((0, 1)) @ WEIGHTS)


def point(size: int, light: float = 1.0) -> np.ndarray:
    picture = np.zeros((size, size, 4), np.float32)
    picture[size // 2, size // 2] = light
    return picture


def transform(kx: np.ndarray, ky: np.ndarray, blades: int, angle: float) -> np.ndarray:
    """Of a regular polygon of radius 1 with an edge at an angle: a sum over its corners."""
    turn = angle + math.tau / blades * (np.arange(blades) + 0.5)
    corners = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    edges = np.roll(corners, -1, axis=0) - corners
    found = np.zeros(kx.shape, complex)
    for n in range(blades):
        a, b = edges[n - 1], edges[n]
        phase = np.exp(-1j * (kx * corners[n, 0] + ky * corners[n, 1]))
        found += phase * (a[0] * b[1] - a[1] * b[0]) / ((kx * a[0] + ky * a[1]) * (kx * b[0] + ky * b[1]))
    return found


def test_the_polygon_of_the_reference_is_that_of_a_picture_of_it():
    """Drawn in pixels and transformed by summing them up."""
    count, blades, angle = 1200, 5, 0.3
    place = (np.arange(count) + 0.5) / count * 2.2 - 1.1
    turn = angle + math.tau / blades * np.arange(blades)
    x, y = np.meshgrid(place, place)
    drawn = np.ones((count, count), bool)
    for one in turn:
        drawn &= x * math.cos(one) + y * math.sin(one) <= math.cos(math.pi / blades)
    k = np.linspace(-12.1, 13.3, 15)
    by_sum = np.exp(-1j * np.outer(k, place)) @ drawn @ np.exp(-1j * np.outer(place, k)) * (2.2 / count) ** 2
    kx, ky = np.meshgrid(k, k)
    assert np.abs(transform(kx, ky, blades, angle) - by_sum).max() <= 2e-3


def lobe(nm, middle, below, above):
    return np.exp(-0.5 * ((nm - middle) / np.where(nm < middle, below, above)) ** 2)


def color_of(nm: float) -> np.ndarray:
    """The observer by Wyman, Sloan and Shirley (2013), in the primaries of ITU-R BT.709."""
    x = 1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) - 0.065 * lobe(nm, 501.1, 20.4, 26.2)
    y = 0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1)
    z = 1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)
    to_rgb = np.array(
        [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]]
    )
    return np.maximum(to_rgb @ np.array([x, y, z]), 0.0)


def starburst(size: int, blades: int, angle: float, samples: int) -> np.ndarray:
    """White light behind an iris: what 5 nm each see of the squared transform, in pixels of a kernel."""
    pitch, wide = 400.0 / size, 2 * round((size * 1.375 + 1.0) / 2.0) + 1
    place = (np.arange(wide * samples) + 0.5) / samples - 0.5 * wide
    kx, ky = np.meshgrid(pitch * place + 1e-6, pitch * place + 2e-6)  # the sum has no value at 0
    area = 0.5 * blades * math.sin(math.tau / blades)
    iris = np.abs(transform(kx, ky, blades, angle) / area) ** 2
    iris = iris.reshape(wide, samples, wide, samples).mean((1, 3))
    y, x = np.mgrid[:size, :size] - (size // 2)
    found, white = np.zeros((size, size, 3)), np.zeros(3)
    for nm in np.arange(400.0, 701.0, 5.0):
        color = color_of(nm)
        scale = 550.0 / nm
        seen = map_coordinates(iris, [wide // 2 + scale * y, wide // 2 + scale * x], order=1)
        found += scale**2 * seen[..., None] * color
        white += color
    end = np.clip((2.0 * np.hypot(x, y) / size - 0.2) / 0.8, 0.0, 1.0)
    found = found / white * (1.0 - end * end * (3.0 - 2.0 * end))[..., None]
    return found / found.sum((0, 1))


@pytest.mark.parametrize(("blades", "rotation"), [(3, 11.0), (5, -7.0), (6, 33.0)])
def test_the_starburst_is_the_squared_transform_of_the_iris(run, blades, rotation):
    size = 59
    node = KernelGlare(size=1.0, blades=blades, rotation=rotation, falloff=1.0, **WHOLE)
    found = run(node, {"image": point(size, 1000.0)}, output="glow")[..., :3] / 1000.0
    wanted = starburst(size, blades, -math.radians(rotation), 7)
    assert np.abs(found - wanted).max() <= 1e-4 * wanted.max()
    rays = wanted > 1e-4 * wanted.max()
    np.testing.assert_allclose(found[rays], wanted[rays], rtol=5e-3)


@pytest.mark.parametrize(("blades", "arms"), [(3, 6), (4, 4), (5, 10), (6, 6), (7, 14), (8, 8)])
def test_an_odd_number_of_blades_makes_twice_as_many_rays(run, blades, arms):
    size = 141
    node = KernelGlare(size=1.0, blades=blades, falloff=0.5, **WHOLE)
    found = run(node, {"image": point(size)}, output="glow")[..., 1]
    turn = np.arange(720) * math.tau / 720.0
    rings = [
        map_coordinates(found, [size // 2 + r * np.sin(turn), size // 2 + r * np.cos(turn)], order=1)
        for r in np.arange(20.0, 45.0)
    ]
    waves = np.abs(np.fft.rfft(sum(rings)))
    assert 1 + int(waves[1:30].argmax()) == arms


def test_the_iris_turns_counterclockwise(run):
    size = 101

    def side(rotation: float) -> np.ndarray:
        node = KernelGlare(size=1.0, blades=4, rotation=rotation, falloff=0.5, **WHOLE)
        return run(node, {"image": point(size)}, output="glow")[..., 1]

    y, x = np.mgrid[:size, :size] - size // 2
    wedge = (x > 25) & (y < 0) & (y > -x * math.tan(math.radians(20.0)))
    assert side(10.0)[wedge].sum() > 2.0 * side(10.0)[::-1][wedge].sum()
    np.testing.assert_allclose(side(90.0), side(0.0), atol=1e-6)


@pytest.mark.parametrize("size", [5, 44, 91])
def test_the_starburst_keeps_white_and_energy(run, size):
    found = run(KernelGlare(size=size / 93, **WHOLE), {"image": point(93, 1e4)}, output="glow")[..., :3]
    np.testing.assert_allclose(found.sum((0, 1), dtype=np.float64), 1e4, rtol=1e-5)
    assert found.min() >= -1e-6 * found.max()


@pytest.mark.parametrize("shape", [(7, 9), (11, 5), (1, 1), (25, 41)])
def test_it_is_the_convolution_with_the_kernel(run, hdr, shape):
    """At its own height, in an odd number of pixels, the kernel stays as it is. Its alpha is not used."""
    picture, kernel = hdr(34, 29), hdr(shape[1], shape[0])
    node = KernelGlare(size=shape[0] / 29, **WHOLE)
    wanted = spread(picture, even(kernel))
    found = run(node, {"image": picture, "kernel": kernel}, output="glow")
    assert np.abs(found[..., :3] - wanted).max() <= 1e-5 * wanted.max()
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])
    opaque = kernel.copy()
    opaque[..., 3] = 1.0
    np.testing.assert_array_equal(run(node, {"image": picture, "kernel": opaque}, output="glow"), found)


def test_a_smaller_kernel_is_the_mean_of_what_its_pixels_cover(run, hdr):
    picture, kernel = point(21), hdr(35, 45)
    found = run(KernelGlare(size=9 / 21, **WHOLE), {"image": picture, "kernel": kernel}, output="glow")[..., :3]
    wanted = spread(picture, even(kernel[..., :3].reshape(9, 5, 7, 5, 3).mean((1, 3))))
    assert np.abs(found - wanted).max() <= 1e-5 * wanted.max()


@pytest.mark.parametrize("height", [3, 8, 13, 40])
def test_a_kernel_keeps_energy_and_middle_at_any_size(run, height):
    y, x = np.mgrid[-1.0:1.0:32j, -1.0:1.0:32j]
    kernel = np.repeat(np.exp(-4.0 * (x * x + y * y))[..., None], 4, axis=2).astype(np.float32)
    node = KernelGlare(size=height / 63, **WHOLE)
    found = run(node, {"image": point(63), "kernel": kernel}, output="glow")[..., 1].astype(np.float64)
    assert found.sum() == pytest.approx(1.0, rel=1e-5)
    np.testing.assert_allclose(found, found[::-1], atol=1e-7)
    np.testing.assert_allclose(found, found[:, ::-1], atol=1e-7)


@pytest.mark.parametrize(("quality", "block"), [("half", 12), ("quarter", 24)])
def test_less_quality_only_softens(run, quality, block):
    """Center and sum of the light stay; in blocks of six of its pixels nothing changes much."""
    picture = np.zeros((1000, 97, 4), np.float32)
    picture[501, 48] = 50.0
    nodes = (KernelGlare(size=0.05, **(WHOLE | {"quality": one})) for one in ("full", quality))
    full, less = (run(node, {"image": picture}, output="glow")[..., :3].astype(np.float64) for node in nodes)
    assert np.abs(less - full).max() > 0.01 * full.max()
    assert less.sum() == pytest.approx(full.sum(), rel=1e-4)
    y, x = np.mgrid[-40:41, -40:41]
    for found in (full, less):
        near = found[461:542, 8:89].sum(-1)
        assert np.hypot((near * y).sum(), (near * x).sum()) <= 1e-3 * near.sum()
    half = block * 3 // 2
    blocks = [
        found[501 - half : 501 + half, 48 - half : 48 + half].reshape(3, block, 3, block, 3).mean((1, 3))
        for found in (full, less)
    ]
    assert np.abs(blocks[1] - blocks[0]).sum() <= 0.05 * blocks[0].sum()


def test_a_small_picture_is_always_spread_in_full(run, hdr):
    picture = hdr(31, 90)
    full, less = (run(KernelGlare(quality=quality), {"image": picture}) for quality in ("full", "quarter"))
    np.testing.assert_array_equal(less, full)


@pytest.mark.parametrize("mode", ["mix", "add"])
@pytest.mark.parametrize("threshold", [0.0, 1.0])
def test_the_glare_joins_the_picture(run, hdr, mode, threshold):
    """To mix, the light that glares within the picture is taken from where it came."""
    picture, kernel = hdr(30, 26), hdr(7, 7)
    luminance = picture[..., :3].astype(np.float64) @ WEIGHTS
    eased = np.clip(luminance - 0.5 * threshold, 0.0, threshold) ** 2 / (2.0 * threshold + 1e-5)
    light = picture[..., :3] * (np.maximum(eased, luminance - threshold) / luminance)[..., None]
    weights = even(kernel)
    glare = spread(light, weights)
    inside = spread(np.ones((26, 30, 3)), np.repeat((weights @ WEIGHTS)[..., None], 3, axis=2))
    wanted = picture[..., :3] + 0.3 * (glare - (inside * light if mode == "mix" else 0.0))
    node = KernelGlare(size=7 / 26, mode=mode, threshold=threshold, intensity=0.3, quality="full")
    found = run(node, {"image": picture, "kernel": kernel})
    assert np.abs(found[..., :3] - wanted).max() <= 1e-5 * wanted.max()
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])


@pytest.mark.parametrize("quality", ["full", "half", "quarter"])
@pytest.mark.parametrize("size", [(17, 1021), (9, 2), (1, 1)])
def test_an_even_picture_stays_even(run, quality, size):
    flat = np.full((size[1], size[0], 4), 2.5, np.float32)
    node = KernelGlare(size=0.08, quality=quality, threshold=0.0, intensity=0.7)
    # Near the border its channels differ: of violet light, which stays nearer, less comes from outside.
    np.testing.assert_allclose(run(node, {"image": flat})[..., :3] @ WEIGHTS, 2.5, rtol=1e-5)
    gray = np.repeat(np.arange(1.0, 64.0).reshape(7, 9, 1), 4, axis=2)
    np.testing.assert_allclose(run(node, {"image": flat, "kernel": gray}), flat, rtol=1e-5)


def test_no_intensity_and_no_size_change_nothing(run, hdr):
    picture = hdr(33, 27)
    np.testing.assert_array_equal(run(KernelGlare(intensity=0.0), {"image": picture}), picture)
    found = run(KernelGlare(size=0.0, quality="full"), {"image": picture})
    np.testing.assert_allclose(found, picture, rtol=1e-5, atol=1e-5 * float(picture.max()))


def test_a_black_kernel_makes_no_glare(run, hdr):
    picture, kernel = hdr(19, 17), np.zeros((5, 5, 4), np.float32)
    np.testing.assert_array_equal(run(KernelGlare(), {"image": picture, "kernel": kernel}), picture)


def test_a_proxy_looks_the_same(run):
    picture = np.zeros((160, 160, 4), np.float32)
    picture[76:84, 90:98] = 30.0
    whole, half = (run(KernelGlare(quality="full"), {"image": picture}, scale=scale) for scale in (1.0, 0.5))
    smaller = whole.reshape(80, 2, 80, 2, 4).mean((1, 3))
    assert half.sum() == pytest.approx(smaller.sum(), rel=1e-3)
    for one in (half, smaller):  # the proxy of the lamp itself is blurred
        one[36:44, 43:51] = 0.0
    assert np.abs(half - smaller).mean() <= 0.1 * smaller.mean()


@pytest.mark.parametrize("hole", [np.nan, np.inf, -np.inf, 3e38])
def test_a_hole_does_not_spread(run, hdr, hole):
    picture, kernel = hdr(33, 29), hdr(9, 8)
    picture[14, 15, 0] = hole
    for spoiled in (kernel, np.where(kernel == kernel[3, 4], np.float32(hole), kernel)):
        for inputs in ({"image": picture}, {"image": picture, "kernel": spoiled}):
            for output in ("out", "glow"):
                assert np.isfinite(run(KernelGlare(), inputs, output=output)).all()
