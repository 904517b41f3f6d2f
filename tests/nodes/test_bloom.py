"""Bloom against the pyramid as its author published it, its own point spread by FFT, and conservation laws."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.glow.bloom import Bloom
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import map_coordinates
from scipy.signal import fftconvolve

# Five overlapping boxes of four bilinear samples each, in pixels from the center of a block (Jimenez 2014).
DOWN = (
    [(0, 0, 0.125)]
    + [(x, y, 0.125) for x in (-1, 1) for y in (-1, 1)]
    + [(x, y, 0.0625) for x, y in ((-2, 0), (2, 0), (0, -2), (0, 2))]
    + [(x, y, 0.03125) for x in (-2, 2) for y in (-2, 2)]
)
UP = [(x, y, (2 - abs(x)) * (2 - abs(y)) / 16) for x in (-1, 0, 1) for y in (-1, 0, 1)]
WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


Taps = list[tuple[float, float, float]]


def sampled(image: np.ndarray, size: tuple[int, int], taps: Taps, scale: float) -> np.ndarray:
    """Weighted bilinear samples around the centers of a picture of another size; the edge pixels go on outside."""
    y, x = np.mgrid[: size[1], : size[0]]
    y, x = (y + 0.5) * scale - 0.5, (x + 0.5) * scale - 0.5
    return np.stack(
        [
            sum(
                weight * map_coordinates(channel, [y + down, x + across], order=1, mode="nearest")
                for across, down, weight in taps
            )
            for channel in np.moveaxis(image, -1, 0)
        ],
        axis=-1,
    )


def half(image: np.ndarray) -> tuple[int, int]:
    return ((image.shape[1] + 1) // 2, (image.shape[0] + 1) // 2)


def pyramid(image: np.ndarray, sigma: float, scatter: float) -> np.ndarray:
    """The glow in 64 bits, for a standard deviation in pixels."""
    depth = math.log(1.0 + sigma * sigma / 1.5) / math.log(4.0)
    variances = [1.5 * (4.0**level - 1.0) for level in range(20)]
    last = int(depth)
    part = (sigma * sigma - variances[last]) / (variances[last + 1] - variances[last])
    levels = [image.astype(np.float64)]
    for _ in range(last + 1):
        levels.append(sampled(levels[-1], half(levels[-1]), DOWN, 2.0))
    glow = levels.pop()
    for level in range(last, -1, -1):
        # Light is shared out over the four octaves below the radius; the finest level keeps what is finer still.
        missing = 4.0 - (last + part - 1.0 - level)
        share = scatter ** max(missing, 0.0) if level == 0 else scatter ** min(max(missing, 0.0), 1.0)
        share *= part if level == last else 1.0
        below = sampled(glow, levels[level].shape[1::-1], UP, 0.5)
        glow = levels[level] * (1.0 - share) + below * share
    return glow


def weighed(image: np.ndarray, sigma: float, scatter: float, curve: tuple[float, ...]) -> np.ndarray:
    """The glow as the sum of its levels, each times its weight, in 64 bits.

    Levels go on below the finest of the picture, where they are the picture itself, so that sizes do not matter.
    """
    depth = math.log(1.0 + sigma * sigma / 1.5) / math.log(4.0)
    last = int(depth)
    part = (sigma * sigma - levels(last) ** 2) / (levels(last + 1) ** 2 - levels(last) ** 2)
    weight = PchipInterpolator(curve[0::2], curve[1::2])
    total, rest, sizes = 0.0, 1.0, [image]
    glow = np.zeros(image.shape)
    for level in range(last - 12, last + 2):
        octave = last + part - level
        onward = scatter ** float(np.clip(5.0 - octave, 0.0, 1.0)) * (part if level == last else float(level < last))
        amount = rest * (1.0 - onward) * float(weight(np.clip(1.0 - octave / 4.0, 0.0, 1.0)))
        rest *= onward
        total += amount
        if level > 0:
            sizes.append(sampled(sizes[-1], half(sizes[-1]), DOWN, 2.0))
        wide = sizes[-1].astype(np.float64)
        for smaller in reversed(sizes[:-1]):
            wide = sampled(wide, smaller.shape[1::-1], UP, 0.5)
        glow += amount * wide
    return glow / total


CURVES = [(0.0, 0.2, 0.4, 2.0, 1.0, 0.5), (0.0, 0.0, 1.0, 1.0), (0.0, 3.0, 0.7, 0.0, 1.0, 0.0)]


@pytest.mark.parametrize("curve", CURVES)
@pytest.mark.parametrize(("sigma", "scatter"), [(2.5, 0.7), (9.0, 0.5), (31.0, 0.8)])
def test_every_level_has_its_weight(run, hdr, sigma, scatter, curve):
    picture = hdr(61, 47)
    found = glow_of(run, picture, sigma, scatter=scatter, levels=curve)
    expected = weighed(picture, sigma, scatter, curve)
    # A share in 32 bits leaves that much of the picture on a level that counts for nothing.
    np.testing.assert_allclose(found, expected, rtol=2e-5, atol=1.2e-7 * float(picture.max()))


@pytest.mark.parametrize("height", [0.0, 0.3, 2.0])
def test_levels_that_all_count_alike_change_nothing(run, hdr, height):
    picture = hdr(40, 30)
    found = glow_of(run, picture, 7.0, levels=(0.0, height, 1.0, height))
    np.testing.assert_allclose(found, glow_of(run, picture, 7.0), rtol=1e-5)


@pytest.mark.parametrize("curve", CURVES)
def test_weights_lose_no_light(run, hdr, curve):
    flat = np.full((33, 47, 4), 2.5, np.float32)
    np.testing.assert_allclose(run(Bloom(levels=curve), {"image": flat}, output="glow"), flat, rtol=1e-5)
    picture = np.pad(hdr(31, 23, opaque=True), ((100, 101), (100, 97), (0, 0)))
    found = glow_of(run, picture, 9.0, levels=curve)[..., :3].sum(dtype=np.float64)
    assert found == pytest.approx(picture[..., :3].sum(dtype=np.float64), rel=1e-5)


def test_the_tint_is_the_color_of_the_glow(run, hdr):
    picture, tint = hdr(24, 20), (0.9, 0.3, 0.1, 0.0)
    plain = run(Bloom(), {"image": picture}, output="glow")
    found = run(Bloom(tint=tint), {"image": picture}, output="glow")
    np.testing.assert_allclose(found, plain * np.float32([0.9, 0.3, 0.1, 1.0]), rtol=1e-6)


def glow_of(run, picture: np.ndarray, sigma: float, **values: object) -> np.ndarray:
    return run(Bloom(radius=sigma / picture.shape[0], **values), {"image": picture}, output="glow")


def levels(count: int) -> float:
    """The standard deviation of this many levels, in pixels."""
    return math.sqrt(1.5 * (4.0**count - 1.0))


@pytest.mark.parametrize("size", [(64, 64), (61, 47), (9, 33)])
@pytest.mark.parametrize(("sigma", "scatter"), [(0.7, 0.7), (2.5, 0.7), (9.0, 1.0), (9.0, 0.3), (9.0, 0.0)])
def test_the_glow_is_the_published_pyramid(run, hdr, size, sigma, scatter):
    picture = hdr(*size)
    expected = pyramid(picture, sigma, scatter)
    found = glow_of(run, picture, sigma, scatter=scatter)
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-6 * float(expected.max()))


def test_it_is_the_convolution_with_its_point_spread(run, hdr):
    """The pyramid repeats every 2^n pixels: the picture is taken apart by phase, each phase has its point spread."""
    count, side = 2, 64
    period, sigma = 2**count, levels(count)
    picture = np.zeros((side, side, 4), np.float32)
    picture[20:44, 20:44] = hdr(24, 24)
    expected = np.zeros((side, side, 4))
    for y in range(period):
        for x in range(period):
            impulse = np.zeros_like(picture)
            impulse[side // 2 + y, side // 2 + x] = 1.0
            spread = glow_of(run, impulse, sigma)[..., 0].astype(np.float64)
            phase = np.zeros_like(picture, np.float64)
            phase[y::period, x::period] = picture[y::period, x::period]
            for channel in range(4):
                whole = fftconvolve(phase[..., channel], spread)
                expected[..., channel] += whole[side // 2 + y :, side // 2 + x :][:side, :side]
    assert np.abs(glow_of(run, picture, sigma) - expected).max() <= 1e-4 * expected.max()


@pytest.mark.parametrize(("count", "table"), [(1, 2.12), (2, 4.74), (3, 9.72), (4, 19.6), (5, 39.2)])
def test_the_radius_is_the_standard_deviation(run, count, table):
    """Measured over all phases of a line; the table is that of the published pyramid."""
    assert levels(count) == pytest.approx(table, rel=5e-3)
    width, height = 512, 64
    place = np.arange(width)
    variances, shifts = [], []
    for phase in range(2**count):
        line = np.zeros((height, width, 4), np.float32)
        line[:, width // 2 + phase] = 1.0
        spread = glow_of(run, line, levels(count), scatter=1.0)[height // 2, :, 0].astype(np.float64)
        assert spread.sum() == pytest.approx(1.0, abs=1e-5)
        away = place - (width // 2 + phase)
        variances.append((spread * away**2).sum())
        shifts.append((spread * away).sum())
    assert math.sqrt(np.mean(variances)) == pytest.approx(levels(count), rel=1e-3)
    assert abs(np.mean(shifts)) <= 1e-3


def test_a_radius_between_levels_is_kept_too(run):
    width, height, sigma = 256, 64, 7.3
    variances = []
    for phase in range(8):
        line = np.zeros((height, width, 4), np.float32)
        line[:, width // 2 + phase] = 1.0
        spread = glow_of(run, line, sigma, scatter=1.0)[height // 2, :, 0].astype(np.float64)
        variances.append((spread * (np.arange(width) - width // 2 - phase) ** 2).sum())
    assert math.sqrt(np.mean(variances)) == pytest.approx(sigma, rel=1e-3)


def test_the_glow_does_not_jump_where_a_level_begins(run, hdr):
    picture = hdr(64, 64)
    below, above = (glow_of(run, picture, levels(3) * factor) for factor in (0.9999, 1.0001))
    assert np.abs(above - below).max() <= 1e-3 * above.max()


def test_without_radius_the_glow_is_the_picture(run, hdr):
    picture = hdr(21, 17)
    np.testing.assert_array_equal(run(Bloom(radius=0.0), {"image": picture}, output="glow"), picture)


@pytest.mark.parametrize("size", [(64, 64), (53, 37), (1, 1)])
def test_a_flat_picture_stays(run, size):
    flat = np.full((size[1], size[0], 4), 2.5, np.float32)
    np.testing.assert_allclose(run(Bloom(), {"image": flat}), flat, rtol=1e-5)
    np.testing.assert_allclose(run(Bloom(), {"image": flat}, output="glow"), flat, rtol=1e-5)
    np.testing.assert_allclose(run(Bloom(firefly=True), {"image": flat}, output="glow"), flat, rtol=1e-5)


def test_no_light_is_lost(run, hdr):
    picture = np.pad(hdr(31, 23, opaque=True), ((100, 101), (100, 97), (0, 0)))
    node = Bloom(radius=9.0 / picture.shape[0], intensity=0.6)
    found = run(node, {"image": picture})[..., :3].sum(dtype=np.float64)
    assert found == pytest.approx(picture[..., :3].sum(dtype=np.float64), rel=1e-5)


def test_it_is_alike_in_all_directions(run):
    picture = np.zeros((64, 64, 4), np.float32)
    picture[31:33, 31:33] = 40.0
    found = glow_of(run, picture, levels(4))
    for turned in (found[::-1], found[:, ::-1], found.transpose(1, 0, 2)):
        np.testing.assert_allclose(turned, found, rtol=0.0, atol=1e-6 * float(found.max()))


def test_moving_by_the_period_moves_the_glow(run, hdr):
    picture = np.pad(hdr(16, 16), ((96, 96), (96, 96), (0, 0)))
    still = glow_of(run, picture, levels(3))
    moved = glow_of(run, np.roll(picture, (8, -16), (0, 1)), levels(3))
    np.testing.assert_allclose(moved, np.roll(still, (8, -16), (0, 1)), rtol=0.0, atol=1e-7 * float(still.max()))


@pytest.mark.parametrize("mode", ["mix", "add"])
def test_the_glow_joins_the_picture(run, hdr, mode):
    picture = hdr(40, 33)
    node = Bloom(intensity=0.3, mode=mode)
    glow = run(node, {"image": picture}, output="glow")
    expected = picture + 0.3 * (glow if mode == "add" else glow - picture)
    expected[..., 3] = picture[..., 3]
    np.testing.assert_allclose(run(node, {"image": picture}), expected, rtol=1e-5, atol=1e-6)


def test_no_intensity_changes_nothing(run, hdr):
    picture = hdr(19, 23)
    np.testing.assert_array_equal(run(Bloom(intensity=0.0), {"image": picture}), picture)


@pytest.mark.parametrize("light", [0.01, 0.3, 0.9, 1.0, 1.3, 2.0, 30.0, 400.0])
def test_threshold_knee_and_limit(run, light):
    threshold, knee, limit = 1.0, 0.5, 50.0
    color = np.array([2.0, 0.8, 0.3])
    color *= light / (color @ WEIGHTS)
    soft = threshold * knee
    bounded = min(light, limit)
    eased = min(max(bounded - threshold + soft, 0.0), 2.0 * soft) ** 2 / (4.0 * soft + 1e-5)
    expected = color * max(eased, bounded - threshold) / light
    flat = np.broadcast_to(np.float32([*color, 1.0]), (8, 8, 4))
    found = run(Bloom(threshold=threshold, knee=knee, limit=limit), {"image": flat.copy()}, output="glow")
    np.testing.assert_allclose(found[..., :3], np.broadcast_to(expected, (8, 8, 3)), rtol=1e-5, atol=1e-6)


def test_the_firefly_filter_weighs_boxes_by_their_light(run, hdr):
    """One level: five boxes of 4 x 4 pixels, each divided by 1 + its luminance (Karis 2013)."""
    picture = hdr(32, 24)
    picture[13, 17, :3] = 20000.0
    padded = np.pad(picture.astype(np.float64), ((2, 4), (2, 4), (0, 0)), mode="edge")
    total, light = np.zeros((12, 16, 1)), np.zeros((12, 16, 4))
    for x, y, share in [(0, 0, 0.125), (2, 0, 0.125), (0, 2, 0.125), (2, 2, 0.125), (1, 1, 0.5)]:
        box = sum(padded[y + j : y + j + 24 : 2, x + i : x + i + 32 : 2] for j in range(4) for i in range(4)) / 16.0
        weight = share / (1.0 + box[..., :3] @ WEIGHTS)[..., None]
        total += weight
        light += weight * box
    expected = sampled(light / total, (32, 24), UP, 0.5)
    found = glow_of(run, picture, levels(1), firefly=True, scatter=1.0)
    np.testing.assert_allclose(found, expected, rtol=2e-5, atol=1e-5)
    assert found.max() < 0.5 * glow_of(run, picture, levels(1), scatter=1.0).max()


@pytest.mark.parametrize("scatter", [0.3, 0.7, 1.0])
def test_the_shape_of_the_glow_is_the_same_at_any_size(run, scatter):
    """How much light stays within a twentieth and a fifth of the height, from 135 to 1080 lines."""
    shares = []
    for height in (135, 270, 540, 1080):
        picture = np.zeros((height, height, 4), np.float32)
        spot = slice(height // 2 - height // 54, height // 2 + height // 54 + 1)
        picture[spot, spot] = 1.0
        glow = run(Bloom(radius=0.08, scatter=scatter), {"image": picture}, output="glow")[..., 0].astype(np.float64)
        y, x = np.mgrid[:height, :height]
        away = np.hypot(y - height // 2, x - height // 2) / height
        shares.append([glow[away < 0.05].sum() / glow.sum(), glow[away < 0.2].sum() / glow.sum()])
    assert np.ptp(shares, axis=0).max() < 0.04


@pytest.mark.parametrize("hole", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("values", [{}, {"threshold": 0.5}, {"firefly": True}, {"exact": True}])
def test_a_hole_does_not_spread(run, hdr, hole, values):
    picture = hdr(33, 29)
    picture[14, 15, 0] = hole
    assert np.isfinite(run(Bloom(**values), {"image": picture})).all()
    assert np.isfinite(run(Bloom(**values), {"image": picture}, output="glow")).all()


def test_a_rendered_frame(run, rendered_frame):
    picture = rendered_frame[:256, :384].copy()
    expected = pyramid(picture, 25.6, 0.7)
    found = glow_of(run, picture, 25.6)
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-6 * float(expected.max()))


@pytest.mark.parametrize(("radius", "scatter"), [(0.02, 0.7), (0.05, 0.6), (0.03, 1.0)])
def test_an_exact_glow_has_the_same_variance_at_any_size(run, radius, scatter):
    """Octaves 4 to 0 below the radius and one above, each of which passes `scatter` of what it gets on to the next."""
    found, expected = [], []
    for height in (135, 270, 540):
        picture = np.zeros((height, height, 4), np.float32)
        picture[height // 2, height // 2] = 1.0
        node = Bloom(radius=radius, scatter=scatter, exact=True)
        glow = run(node, {"image": picture}, output="glow")[..., 0].astype(np.float64)
        away = (np.arange(height) - height // 2) / height
        found.append((glow.sum(axis=0) @ away**2 + glow.sum(axis=1) @ away**2) / 2.0)
        top = math.log((radius * height) ** 2 / 1.5, 4.0)
        last = math.floor(top)
        part = (4.0 ** (top - last) - 1.0) / 3.0
        variances = [1.5 * 4.0**level / height**2 for level in range(last - 4, last + 2)]
        passed = np.cumprod([1.0, scatter ** (1.0 - part), scatter, scatter, scatter, scatter * part])
        kept = -np.diff([*passed, 0.0])
        expected.append(kept @ variances)
    np.testing.assert_allclose(found, expected, rtol=0.02)


def test_an_exact_glow_is_the_same_picture_at_any_size(run, hdr):
    """A picture whose pixels are repeated 6 times: its glow is averaged again. Without `exact` it is another one."""
    small = hdr(90, 60, opaque=True)
    large = small.repeat(6, 0).repeat(6, 1)

    def difference(exact):
        node = Bloom(radius=0.1, scatter=0.6, exact=exact)
        one, many = (run(node, {"image": picture}, output="glow")[..., :3] for picture in (small, large))
        many = many.reshape(60, 6, 90, 6, 3).mean(axis=(1, 3))
        return np.sqrt(np.mean((one - many) ** 2) / np.mean((small[..., :3] - many) ** 2))

    assert difference(True) < 0.2 * difference(False)
