"""Over Exposure against its formulas in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.tone.over_exposure import OverExposure


def exposed(rgb, stops=2.0, white=16.0, shoulder=0.7, bleach=1.0):
    rgb = rgb.astype(np.float64) * 2.0**stops
    peak = rgb.max(-1, keepdims=True)
    start = white * (1 - shoulder)
    room = max(white - start, 1e-30)
    held = np.where(peak <= start, peak, white - room * np.exp(-np.maximum(peak - start, 0) / room))
    lost = bleach * (peak - held) / white
    return (rgb * held / np.maximum(peak, 1e-30) + lost * held) / (1 + lost)


def gray(*values):
    return np.array([[(value, value, value, 1.0) for value in values]], np.float32)


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"stops": 0.0},
        {"stops": 5.0},
        {"white": 1.0},
        {"shoulder": 0.0},
        {"shoulder": 1.0},
        {"bleach": 0.0},
        {"white": 1.0, "shoulder": 0.3, "bleach": 3.0},
    ],
    ids=str,
)
def test_it_is_the_formula(run, hdr, values):
    picture = hdr(41, 29, opaque=True)
    found = run(OverExposure(**values), {"image": picture})
    expected = exposed(picture[..., :3], **values)
    assert (np.abs(found[..., :3] - expected) / np.maximum(expected, 1.0)).max() < 5e-6
    assert np.array_equal(found[..., 3], picture[..., 3])


def test_below_the_shoulder_it_is_exposure(run, hdr):
    """Whole stops, bit for bit, negative light too; none leave the picture as it is."""
    picture = np.minimum(hdr(23, 19, opaque=True), 1.0)
    picture[3, 4, 1] = -0.4
    for stops in (0.0, 2.0):
        found = run(OverExposure(stops=stops, white=16.0, shoulder=0.7), {"image": picture})
        assert np.array_equal(found[..., :3], picture[..., :3] * np.float32(2.0**stops))


def test_no_shoulder_clips(run):
    light = np.float32([0.1, 0.9, 1.0, 1.1, 7.0, 1e4])
    found = run(OverExposure(stops=0.0, white=1.0, shoulder=0.0, bleach=0.0), {"image": gray(*light)})
    assert found[0, :, 0] == pytest.approx(np.minimum(light, 1.0), abs=1e-6)


def test_grays_stay_gray_and_grow_toward_white(run):
    ramp = np.geomspace(1e-3, 1e6, 2000)
    found = run(OverExposure(stops=0.0, white=4.0), {"image": gray(*ramp)})[0, :, :3]
    assert np.diff(found[:, 0]).min() >= -1e-6 and found.max() <= 4.0 + 1e-6
    assert np.abs(found - found[:, :1]).max() < 2e-6
    assert found[-1, 0] == pytest.approx(4.0, rel=1e-6)


def test_the_shoulder_starts_without_a_corner(run):
    """Values and slopes on both sides of its start, where the slope is 1."""
    step = 2.0**-8
    light = 0.5 + step * np.arange(-2, 3)
    found = run(OverExposure(stops=0.0, white=1.0, shoulder=0.5), {"image": gray(*light)})[0, :, 0].astype(np.float64)
    assert np.diff(found) / step == pytest.approx(1.0, abs=0.02)


def test_bleach_turns_strong_color_white(run):
    """A red of 9 with 1 as white, clipped: x = bleach * 8, so green becomes x / (1 + x)."""
    red = np.array([[[9.0, 0.0, 0.0, 1.0]]], np.float32)
    for bleach in (0.0, 0.25, 1.0, 4.0):
        node = OverExposure(stops=0.0, white=1.0, shoulder=0.0, bleach=bleach)
        x = 8.0 * bleach
        assert run(node, {"image": red})[0, 0, :3] == pytest.approx([1.0, x / (1 + x), x / (1 + x)], abs=1e-6)


def test_coverage_does_not_change_the_color(run, hdr):
    picture = hdr(21, 17, opaque=True)
    whole = run(OverExposure(), {"image": picture})
    assert np.abs(run(OverExposure(), {"image": picture * 0.5}) - whole * 0.5).max() < 1e-5


def test_grays_by_hand(run):
    """From half of white on the rest of the way to white is gone exponentially: 1 - 1/e of it at twice the start."""
    light = np.array([0.25, 0.5, 1.0, 1.5, 50.0])
    picture = np.stack([light, light, light, np.ones(5)], -1)[None]
    found = run(OverExposure(stops=0.0, white=1.0, shoulder=0.5, bleach=0.0), {"image": picture})[0, :, 2]
    np.testing.assert_allclose(found, [0.25, 0.5, 0.81606028, 0.93233236, 1.0], rtol=1e-6)
    stops = run(OverExposure(stops=1.0, white=1.0, shoulder=0.5, bleach=0.0), {"image": picture})[0, :3, 2]
    np.testing.assert_allclose(stops, [0.5, 0.81606028, 0.97510647], rtol=1e-6)
