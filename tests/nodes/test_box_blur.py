"""Box blur against scipy's uniform_filter and numpy in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.blur.box_blur import BoxBlur
from scipy.ndimage import correlate1d, uniform_filter

TIMES = {"box": 1, "tent": 2, "iterated": 3}


def kernel(radius: float) -> np.ndarray:
    """By its definition: a pixel at distance x counts as far as the box covers it."""
    x = np.arange(-int(radius) - 1, int(radius) + 2)
    weights = np.clip(radius + 1.0 - np.abs(x), 0.0, 1.0)
    return weights / weights.sum()


def spread(picture: np.ndarray, radius: float, kind: str, mode: str) -> np.ndarray:
    weights = np.ones(1)
    for _ in range(TIMES[kind]):
        weights = np.convolve(weights, kernel(radius / TIMES[kind]))
    found = picture.astype(np.float64)
    for axis in (0, 1):
        found = correlate1d(found, weights, axis, mode=mode)
    return found


def close(found: np.ndarray, expected: np.ndarray) -> None:
    np.testing.assert_allclose(found, expected, rtol=2e-6, atol=5e-7 * float(np.abs(expected).max()))


@pytest.mark.parametrize("size", [(41, 29), (7, 1), (1, 1)])
@pytest.mark.parametrize("radius", [0.4, 3.0, 30.0, 36.7, 300.0])
def test_a_box_equals_numpy(run, hdr, edge, radius, size):
    picture = hdr(*size)
    found = run(BoxBlur(radius=radius, edge=edge.name), {"image": picture})
    close(found, spread(picture, radius, "box", edge.scipy))


@pytest.mark.parametrize(
    ("kind", "radius"),
    [
        *(("tent", radius) for radius in (6.0, 7.3, 80.0, 219.5)),
        *(("iterated", radius) for radius in (6.0, 7.3, 68.0)),
    ],
)
def test_repeated_boxes_equal_numpy(run, hdr, edge, radius, kind):
    picture = hdr(33, 21)
    found = run(BoxBlur(kind=kind, radius=radius, edge=edge.name), {"image": picture})
    close(found, spread(picture, radius, kind, edge.scipy))


@pytest.mark.parametrize("radius", [73.0, 80.0, 144.4, 219.5, 600.0])
@pytest.mark.parametrize("size", [(64, 32), (33, 21)])
def test_three_wide_boxes_nearly_equal_numpy(run, hdr, edge, radius, size):
    picture = hdr(*size)
    expected = spread(picture, radius, "iterated", edge.scipy)
    error = run(BoxBlur(kind="iterated", radius=radius, edge=edge.name), {"image": picture}) - expected
    assert np.abs(error).max() <= 3e-4 * expected.max()


@pytest.mark.parametrize("radius", [72.0, 100.5, 144.0, 200.0, 290.0])
@pytest.mark.parametrize("phase", [0, 1, 3])
def test_three_wide_boxes_nearly_equal_numpy_around_a_single_pixel(run, radius, phase):
    side = int(radius) + 20
    picture = np.zeros((side, side, 4), np.float32)
    picture[2 + phase, 4 + phase] = 1.0
    found = run(BoxBlur(kind="iterated", radius=radius, edge="black"), {"image": picture})
    expected = spread(picture, radius, "iterated", "constant")
    assert np.abs(found - expected).max() <= 1e-3 * expected.max()
    assert found.min() >= 0.0


@pytest.mark.parametrize("radius", [5, 23, 24, 100])
def test_a_box_equals_scipy(run, hdr, radius):
    picture = hdr(150, 40)
    expected = uniform_filter(picture.astype(np.float64), (2 * radius + 1, 2 * radius + 1, 1), mode="nearest")
    close(run(BoxBlur(radius=radius), {"image": picture}), expected)


@pytest.mark.parametrize("radius", [8, 60])
def test_a_tent_falls_off_in_straight_lines(run, radius):
    line = np.zeros((1, 4 * radius + 1, 4), np.float32)
    line[0, 2 * radius] = 1.0
    expected = np.maximum(1.0 - np.abs(np.arange(-2 * radius, 2 * radius + 1)) / (radius + 1.0), 0.0) / (radius + 1.0)
    found = run(BoxBlur(kind="tent", radius=radius), {"image": line})
    np.testing.assert_allclose(found[0, :, 0], expected, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("kind", TIMES)
@pytest.mark.parametrize("radius", [2.5, 40.25])
def test_no_light_is_lost_and_directions_are_alike(run, hdr, kind, radius):
    margin = int(radius) + 2
    picture = np.pad(hdr(9, 9), ((margin, margin), (margin, margin), (0, 0)))
    node = BoxBlur(kind=kind, radius=radius, edge="black")
    found = run(node, {"image": picture})
    expected = picture.sum((0, 1), dtype=np.float64)
    np.testing.assert_allclose(found.sum((0, 1), dtype=np.float64), expected, rtol=1e-6)
    for turn in (lambda a: a[::-1], lambda a: a[:, ::-1], lambda a: a.transpose(1, 0, 2)):
        close(run(node, {"image": turn(picture).copy()}), turn(found))


def test_no_radius_changes_nothing():
    assert BoxBlur(radius=0.0).identity() == "image"


@pytest.mark.parametrize("radius", [2.0, 50.0])
def test_a_hole_is_skipped(run, hdr, radius):
    picture = hdr(31, 23)
    picture[11, 12] = np.nan
    patched = picture.copy()
    patched[11, 12] = 0.0
    node = BoxBlur(radius=radius)
    np.testing.assert_array_equal(run(node, {"image": picture}), run(node, {"image": patched}))
