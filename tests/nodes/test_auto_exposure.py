"""Auto Exposure against numpy in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.tone.auto_exposure import AutoExposure

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
METERINGS = AutoExposure.values["metering"].choices


def luminance(picture, weight=None):
    """Of the color without its alpha."""
    alpha = picture[..., 3:].astype(np.float64)
    return (picture[..., :3] / np.where(alpha > 1e-6, alpha, 1)) @ WEIGHTS


def histogram(light, weight):
    """128 bins of a quarter stop from 2^-16 on; every pixel is shared among its two nearest."""
    place = np.clip((np.log2(np.maximum(light, 1e-9)) + 16) * 4, 0, 127).ravel()
    lower = np.minimum(np.floor(place).astype(int), 126)
    bins = np.zeros(128)
    np.add.at(bins, lower, weight.ravel() * (lower + 1 - place))
    np.add.at(bins, lower + 1, weight.ravel() * (place - lower))
    return bins


def metered(picture, metering, low=0.1, high=0.9, weight=None):
    light = luminance(picture)
    weight = picture[..., 3].astype(np.float64) * (1 if weight is None else weight)
    if metering == "average":
        return np.average(light, weights=weight)
    if metering == "log average":
        return np.exp(np.average(np.log(1e-5 + light), weights=weight))
    if metering == "maximum":
        return light[weight > 0].max()
    bins = histogram(light, weight) / weight.sum()
    ends = np.cumsum(bins).clip(low, high)
    part = np.diff(np.concatenate([[low], ends]))
    return 2 ** (-16 + 0.25 * np.average(np.arange(128), weights=part))


def found(run, node, inputs):
    """The luminance that is metered and the exposure in stops."""
    return tuple(float(run(node, inputs, output=name).item()) for name in ("average", "exposure"))


@pytest.mark.parametrize("metering", METERINGS)
@pytest.mark.parametrize("size", [(1, 1), (2, 1), (1, 37), (31, 33), (241, 67), (3, 1057)], ids=str)
def test_it_meters_as_numpy(run, hdr, metering, size):
    for opaque in (True, False):
        picture = hdr(*size, opaque=opaque)
        average, stops = found(run, AutoExposure(metering=metering), {"image": picture})
        expected = metered(picture, metering)
        assert average == pytest.approx(expected, rel=1e-5)
        wanted = 1.0 if metering == "maximum" else 0.18
        assert stops == pytest.approx(np.clip(np.log2(wanted / expected), -8, 8), abs=2e-5)


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (0.5, 0.95), (0.0, 0.3), (0.8, 0.801), (0.333, 0.334)])
def test_percentiles_cut_the_histogram(run, hdr, low, high):
    picture = hdr(57, 43, opaque=True)
    average, _ = found(run, AutoExposure(low=low, high=high), {"image": picture})
    assert average == pytest.approx(metered(picture, "histogram", low, high), rel=1e-5)
    # What sorting all pixels finds, to the width of a bin, which matters little for a wide range.
    stops = np.sort(np.log2(luminance(picture)).ravel())
    inside = np.diff(np.arange(stops.size + 1).clip(low * stops.size, high * stops.size))
    assert np.log2(average) == pytest.approx(np.average(stops, weights=inside), abs=0.25 if high - low < 0.1 else 0.05)


def test_the_whole_histogram_is_the_geometric_mean(run, hdr):
    picture = hdr(57, 43, opaque=True)
    average, _ = found(run, AutoExposure(low=0.0, high=1.0), {"image": picture})
    assert average == pytest.approx(np.exp(np.log(luminance(picture)).mean()), rel=1e-5)


def test_bins_are_numpys_histogram(run):
    """Light at the middle of bins falls in one alone: the narrowest percentiles then read numpy's histogram."""
    random = np.random.default_rng(3)
    places = random.choice([20, 40, 41, 60, 90], (23, 29), p=[0.1, 0.3, 0.2, 0.3, 0.1])
    light = 2.0 ** (-16 + 0.25 * places)
    picture = np.stack([light, light, light, np.ones_like(light)], -1).astype(np.float32)
    counts, _ = np.histogram(np.log2(light), np.arange(129) / 4 - 16.125)
    shares = np.cumsum(counts) / places.size
    for place in (20, 40, 41, 60, 90):
        start, end = shares[place - 1], shares[place]
        for share in (start + 0.002, end - 0.003):
            average, _ = found(run, AutoExposure(low=share, high=share + 0.001), {"image": picture})
            assert average == pytest.approx(2.0 ** (-16 + 0.25 * place), rel=1e-5)


@pytest.mark.parametrize("metering", METERINGS)
def test_what_is_metered_becomes_the_key(run, hdr, metering):
    picture = hdr(37, 23, opaque=True)
    node = AutoExposure(metering=metering, key=0.25, minimum=-20.0)
    average, stops = found(run, node, {"image": picture})
    out = run(node, {"image": picture})
    np.testing.assert_allclose(out[..., :3], picture[..., :3] * 2.0**stops, rtol=2e-6)
    assert np.array_equal(out[..., 3], picture[..., 3])
    again, _ = found(run, node, {"image": out})
    target = 1.0 if metering == "maximum" else 0.25
    # The tent of a bin and the 1e-5 of the logarithm do not scale with light.
    assert again == pytest.approx(target, rel={"histogram": 0.01, "log average": 1e-3}.get(metering, 1e-5))
    assert average * 2.0**stops == pytest.approx(target, rel=1e-5)


@pytest.mark.parametrize("metering", METERINGS)
def test_one_gray_becomes_the_key(run, metering):
    picture = np.full((13, 11, 4), 0.037, np.float32)
    picture[..., 3] = 1.0
    out = run(AutoExposure(metering=metering), {"image": picture})
    wanted = 1.0 if metering == "maximum" else 0.18
    # The percentiles cut the two bins of a light unevenly.
    assert out[..., :3] == pytest.approx(wanted, rel={"histogram": 6e-3, "log average": 3e-4}.get(metering, 1e-5))


def test_the_exposure_is_limited_and_compensated(run):
    picture = np.full((3, 5, 4), 0.18 / 2**5, np.float32)
    picture[..., 3] = 1.0
    for values, expected in (
        ({}, 5.0),
        ({"maximum": 3.0}, 3.0),
        ({"maximum": 3.0, "compensation": 1.5}, 4.5),
        ({"minimum": 6.0}, 6.0),
        ({"compensation": -2.0}, 3.0),
        ({"minimum": 4.0, "maximum": 2.0}, 2.0),
    ):
        node = AutoExposure(metering="average", **values)
        assert found(run, node, {"image": picture})[1] == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("metering", METERINGS)
def test_mask_and_spot_weigh_pixels(run, hdr, metering):
    picture = hdr(45, 31)
    mask = np.random.default_rng(7).random((31, 45)).astype(np.float32)
    mask[:, 30:] = 0.0
    mask[3, 4] = np.nan
    node = AutoExposure(metering=metering, center_weight=0.8, center=(0.3, 0.6), radius=0.15)
    y, x = np.mgrid[:31, :45] + 0.5
    off = np.hypot(x - 0.3 * 45, y - 0.6 * 31) / (0.15 * 31)
    weight = np.nan_to_num(mask.astype(np.float64)) * (0.2 + 0.8 * np.exp(-0.5 * off**2))
    average, _ = found(run, node, {"image": picture, "mask": mask})
    assert average == pytest.approx(metered(picture, metering, weight=weight), rel=1e-5)


@pytest.mark.parametrize("metering", METERINGS)
def test_what_cannot_be_metered_stays_as_it_is(run, hdr, metering):
    picture = hdr(9, 7, opaque=True)
    node = AutoExposure(metering=metering, compensation=1.0)
    for mask in (np.zeros((7, 9)), np.full((7, 9), np.nan), np.full((7, 9), -1.0)):
        assert found(run, node, {"image": picture, "mask": mask}) == (0.0, 1.0)
    holes = np.full((7, 9, 4), np.nan, np.float32)
    assert found(run, node, {"image": holes}) == (0.0, 1.0)
    picture[2, 3] = np.inf
    rest = picture.copy()
    rest[2, 3] = 0.0
    assert found(run, node, {"image": picture})[0] == pytest.approx(metered(rest, metering), rel=1e-5)


def test_auto_key_is_krawczyks(run):
    picture = np.full((3, 5, 4), 0.5, np.float32)
    picture[..., 3] = 1.0
    key = 1.03 - 2 / (2 + np.log10(0.5 * 20.0 + 1))
    node = AutoExposure(metering="average", auto_key=True, nits=20.0)
    assert run(node, {"image": picture})[..., :3] == pytest.approx(key, rel=1e-5)


def test_a_rendered_frame(run, rendered_frame):
    for metering in METERINGS:
        average, _ = found(run, AutoExposure(metering=metering), {"image": rendered_frame})
        assert average == pytest.approx(metered(rendered_frame, metering), rel=1e-5)
