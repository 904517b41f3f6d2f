"""Sun beams against the closed form of the series that they sum, and against scipy sample by sample."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.glow.sun_beams import SunBeams
from scipy.ndimage import map_coordinates

ALL_LIGHT = {"threshold": 0.0, "knee": 0.0, "limit": 65504.0, "radius": 16.0}


def away(width: int, height: int, source: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """From the source to every pixel, right and down."""
    down, across = np.mgrid[:height, :width] + 0.5
    return across - source[0] * width, down - source[1] * height


def series(node: SunBeams, width: int, height: int) -> tuple[int, float, float]:
    """How many terms, and the factors of distance and weight from one to the next, at full quality."""
    far = math.hypot(max(node.source[0], 1 - node.source[0]) * width, max(node.source[1], 1 - node.source[1]) * height)
    shrink, fade = max(1.0 - node.length, 0.01), max(1.0 - node.decay, 0.01)
    terms = 4 ** max(math.ceil(math.log(max(-far * math.log(shrink), 1.0), 4.0)), 1)
    return terms, shrink ** (1.0 / terms), fade ** (1.0 / terms)


@pytest.mark.parametrize("quality", ["full", "half", "quarter"])
@pytest.mark.parametrize(
    "values",
    [
        {"source": (0.5, 0.5), "length": 0.6, "decay": 0.9},
        {"source": (0.3, 0.7), "length": 0.95, "decay": 0.0},
        {"source": (0.71, 0.2), "length": 0.3, "decay": 1.0},
    ],
)
def test_a_slope_is_known_in_closed_form(run, quality, values):
    """Bilinear samples of a plane are exact: its slope shrinks by a geometric series in fade x shrink."""
    width, height = 128, 96
    node = SunBeams(**ALL_LIGHT | values, quality=quality)
    x, y = away(width, height, node.source)
    plane = 900.0 + 2.0 * x - 3.0 * y
    found = run(node, {"image": np.repeat(plane[..., None], 4, -1)}, output="glow")[..., 1]
    factor = {"full": 1, "half": 2, "quarter": 4}[quality]
    terms, shrink, fade = series(node, width // factor, height // factor)
    weights = fade ** np.arange(terms)
    gain = (1.0 - (fade * shrink) ** terms) / (1.0 - fade * shrink) / weights.sum()
    expected = 900.0 + gain * (2.0 * x - 3.0 * y)
    # Within a pixel of the border, enlargement and samples outside are no plane anymore.
    inner = np.s_[2 * factor : -2 * factor, 2 * factor : -2 * factor]
    np.testing.assert_allclose(found[inner], expected[inner], rtol=1e-5)


@pytest.mark.parametrize("length", [0.2, 0.7, 1.0])
def test_a_soft_light_sample_by_sample(run, length):
    """The whole series at once, by scipy on a soft light: passes only differ by what bilinear samples lose."""
    width, height, soft = 90, 70, 7.0
    node = SunBeams(**ALL_LIGHT, source=(0.4, 0.3), length=length, quality="full")
    x, y = away(width, height, node.source)
    light = np.exp(-0.5 * ((x - 9.0) ** 2 + (y - 6.0) ** 2) / soft**2)
    terms, shrink, fade = series(node, width, height)
    expected, total = np.zeros((height, width)), 0.0
    for n in range(terms):
        place = [y * shrink**n + node.source[1] * height - 0.5, x * shrink**n + node.source[0] * width - 0.5]
        expected += fade**n * map_coordinates(light, place, order=3, mode="nearest")
        total += fade**n
    expected /= total
    found = run(node, {"image": np.repeat(light[..., None], 4, -1)}, output="glow")[..., 1]
    passes = round(math.log(terms, 4.0))
    assert np.abs(found - expected).max() <= passes * 2.0 / 8.0 / soft**2


@pytest.mark.parametrize("source", [(0.5, 0.5), (0.1, 0.9)])
def test_light_that_is_the_same_all_along_a_ray_stays(run, source):
    width, height = 120, 120
    x, y = away(width, height, source)
    rays = 1.0 + 0.5 * np.sin(2.0 * np.arctan2(y, x))
    node = SunBeams(**ALL_LIGHT, source=source, length=0.7, quality="full")
    found = run(node, {"image": np.repeat(rays[..., None], 4, -1)}, output="glow")[..., 1]
    outside = (np.hypot(x, y) > 40.0)[2:-2, 2:-2]
    assert np.abs(found - rays)[2:-2, 2:-2][outside].max() <= 0.01


@pytest.mark.parametrize("quality", ["full", "half", "quarter"])
def test_a_flat_picture_stays_flat(run, quality):
    flat = np.full((37, 53, 4), 2.5, np.float32)
    found = run(SunBeams(**ALL_LIGHT, quality=quality), {"image": flat}, output="glow")
    np.testing.assert_allclose(found, flat, rtol=1e-5)


def test_light_falls_outward_and_not_inward(run):
    picture = np.zeros((41, 41, 4), np.float32)
    picture[20, 25:27, :3] = 5.0
    glow = run(SunBeams(**ALL_LIGHT, source=(0.5, 0.5), quality="full"), {"image": picture}, output="glow")[..., 1]
    assert glow[20, 38] > 0.01
    assert glow[20, 27:].min() > 0.0
    assert np.abs(glow[:, :20]).max() == 0.0
    assert np.abs(glow[20, 21:24]).max() <= 1e-6


def test_only_light_near_the_source_and_in_the_mask(run, hdr):
    picture, mask = hdr(60, 40), np.zeros((40, 60), np.float32)
    mask[:, :30] = 1.0
    node = SunBeams(**ALL_LIGHT, source=(0.5, 0.5), length=0.5, quality="full")
    masked = run(node, {"image": picture, "mask": mask}, output="glow")
    cut = run(node, {"image": picture * np.r_[mask[0], 1.0][:60, None]}, output="glow")
    np.testing.assert_allclose(masked[..., :3], cut[..., :3], rtol=1e-6)
    near = run(node.with_values(radius=0.2), {"image": picture}, output="glow")
    x, y = away(60, 40, (0.5, 0.5))
    ramp = np.clip(np.hypot(x, y) / 8.0 - 1.0, 0.0, 1.0)
    window = 1.0 - ramp**2 * (3.0 - 2.0 * ramp)
    cut = run(node, {"image": picture * window[..., None]}, output="glow")
    np.testing.assert_allclose(near[..., :3], cut[..., :3], rtol=2e-5, atol=1e-5)


def test_the_beams_join_the_picture(run, hdr):
    picture = hdr(24, 20)
    values = {"tint": (0.9, 0.3, 0.1, 1.0), "intensity": 0.7, "threshold": 0.5, "radius": 0.6}
    glow = run(SunBeams(**values), {"image": picture}, output="glow")
    expected = picture + np.float32([0.7, 0.7, 0.7, 0.0]) * glow
    np.testing.assert_allclose(run(SunBeams(**values), {"image": picture}), expected, rtol=1e-6)
    assert glow[..., 0].max() > 0.0
    np.testing.assert_array_equal(run(SunBeams(intensity=0.0), {"image": picture}), picture)


def test_the_source_may_lie_outside(run, hdr):
    picture = hdr(40, 30)
    glow = run(SunBeams(**ALL_LIGHT, source=(1.3, -0.4)), {"image": picture}, output="glow")
    assert np.isfinite(glow).all()
    assert glow[..., :3].max() > 0.0
