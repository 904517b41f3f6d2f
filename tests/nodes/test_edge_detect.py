"""Edge detection against scipy and OpenCV."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.edge.edge_detect import EdgeDetect
from scipy import ndimage

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
OPERATORS = ("sobel", "scharr", "prewitt", "laplace")


def size_of_change(channel: np.ndarray, operator: str, edge) -> np.ndarray:
    """Of one channel, by the libraries, scaled so that a step of 1 reads 1."""
    if operator == "laplace":
        return np.abs(ndimage.laplace(channel, mode=edge.scipy))
    if operator == "scharr":
        padded = np.pad(channel, 1, mode=edge.numpy)
        across, down = (cv2.Scharr(padded, cv2.CV_64F, dx, 1 - dx)[1:-1, 1:-1] / 16.0 for dx in (1, 0))
    else:
        derive, total = (ndimage.sobel, 4.0) if operator == "sobel" else (ndimage.prewitt, 3.0)
        across, down = (derive(channel, axis, mode=edge.scipy) / total for axis in (1, 0))
    return np.hypot(across, down)


@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize("size", [(37, 22), (4, 3)])
def test_each_channel_equals_the_libraries(run, hdr, edge, operator, size):
    picture = hdr(*size)
    node = EdgeDetect(operator=operator, channels="separate", edge=edge.name)
    expected = np.stack([size_of_change(picture[..., c].astype(np.float64), operator, edge) for c in range(3)], axis=-1)
    found = run(node, {"image": picture})
    tolerance = 1e-6 * float(picture.max())
    np.testing.assert_allclose(found[..., :3], expected, rtol=1e-5, atol=tolerance)
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])
    magnitude = run(node, {"image": picture}, output="magnitude")
    np.testing.assert_allclose(magnitude[..., 0], expected.max(axis=-1), rtol=1e-5, atol=tolerance)


@pytest.mark.parametrize("operator", OPERATORS)
def test_the_luminance_equals_the_libraries(run, hdr, edge, operator):
    picture = hdr(37, 22)
    node = EdgeDetect(operator=operator, edge=edge.name, strength=2.0, threshold=0.25)
    expected = size_of_change(picture[..., :3].astype(np.float64) @ WEIGHTS, operator, edge)
    expected = 2.0 * np.maximum(expected - 0.25, 0.0)
    tolerance = 1e-6 * float(picture.max())
    found = run(node, {"image": picture})
    for channel in range(3):
        np.testing.assert_allclose(found[..., channel], expected, rtol=1e-5, atol=tolerance)
    magnitude = run(node, {"image": picture}, output="magnitude")
    np.testing.assert_allclose(magnitude[..., 0], expected, rtol=1e-5, atol=tolerance)


def test_a_wide_operator_is_that_of_a_smooth_picture(run, hdr, edge):
    """The pixels that are compared are 20 apart, of a picture that is blurred like boxes of as many pixels."""
    width, picture = 20, hdr(97, 71)
    tone = picture[..., :3].astype(np.float64) @ WEIGHTS
    tone = ndimage.gaussian_filter(tone, np.sqrt((width**2 - 1) / 12.0), mode=edge.scipy)
    kernel = np.zeros((2 * width + 1, 2 * width + 1))
    kernel[::width, ::width] = np.outer([1.0, 2.0, 1.0], [-1.0, 0.0, 1.0]) / 4.0
    expected = np.hypot(*(ndimage.correlate(tone, one, mode=edge.scipy) for one in (kernel, kernel.T)))
    found = run(EdgeDetect(operator="sobel", width=width, edge=edge.name), {"image": picture}, output="magnitude")
    np.testing.assert_allclose(found[..., 0], expected, rtol=0.0, atol=1e-5 * float(tone.max()))


@pytest.mark.parametrize("operator", OPERATORS)
def test_a_step_of_one_reads_one(run, operator):
    step = np.ones((9, 12, 4), np.float32)
    step[:, :6, :3] = 0.0
    for picture in (step, step.transpose(1, 0, 2).copy()):
        assert run(EdgeDetect(operator=operator), {"image": picture})[..., :3].max() == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize("operator", OPERATORS)
def test_a_flat_picture_has_no_edges(run, operator):
    flat = np.full((6, 7, 4), 0.7, np.float32)
    found = run(EdgeDetect(operator=operator), {"image": flat})
    np.testing.assert_allclose(found[..., :3], 0.0, atol=1e-6)


@pytest.mark.parametrize("hole", [np.nan, np.inf])
def test_a_hole_does_not_spread(run, hdr, hole):
    picture = hdr(9, 9)
    picture[4, 4, 2] = hole
    assert np.isfinite(run(EdgeDetect(), {"image": picture})).all()
