"""The 3 x 3 convolution against scipy, OpenCV and OpenImageIO."""

from __future__ import annotations

import cv2
import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.filter.convolve3x3 import Convolve3x3
from scipy.ndimage import correlate, laplace

KERNEL = (0.5, -1.0, 2.0, 3.0, -4.0, 0.25, -0.75, 1.5, 0.125)
PRESETS = Convolve3x3.values["preset"].choices
SIZES = [(31, 18), (5, 7), (1, 4), (1, 1)]

# Written again from the literature, in reading order.
REFERENCE = {
    "sharpen": [[0, -1, 0], [-1, 5, -1], [0, -1, 0]],
    "box": np.full((3, 3), 1 / 9),
    "laplacian 4": [[0, 1, 0], [1, -4, 1], [0, 1, 0]],
    "laplacian 8": [[1, 1, 1], [1, -8, 1], [1, 1, 1]],
    "laplacian isotropic": np.array([[1, 4, 1], [4, -20, 4], [1, 4, 1]]) / 6,
    "emboss": [[2, 0, 0], [0, -1, 0], [0, 0, -1]],
    "relief": [[-1, -2, -1], [0, 1, 0], [1, 2, 1]],
    "sobel x": np.outer([1, 2, 1], [-1, 0, 1]),
    "sobel y": np.outer([-1, 0, 1], [1, 2, 1]),
    "prewitt x": np.outer([1, 1, 1], [-1, 0, 1]),
    "prewitt y": np.outer([-1, 0, 1], [1, 1, 1]),
    "scharr x": np.outer([3, 10, 3], [-1, 0, 1]),
    "scharr y": np.outer([-1, 0, 1], [3, 10, 3]),
}


def correlated(image: np.ndarray, kernel: object, mode: str = "nearest") -> np.ndarray:
    weights = np.asarray(kernel, np.float64).reshape(3, 3, 1)
    return correlate(image.astype(np.float64), weights, mode=mode)


def assert_close(found: np.ndarray, expected: np.ndarray, scale: float) -> None:
    """Within 1e-6 of the largest sum of the terms' sizes, which is what rounding is measured against."""
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-6 * scale)


@pytest.mark.parametrize("size", SIZES)
def test_any_kernel_equals_scipy(run, hdr, edge, size):
    picture = hdr(*size)
    node = Convolve3x3(preset="custom", kernel=KERNEL, filter_alpha=True, edge=edge.name)
    expected = correlated(picture, KERNEL, edge.scipy)
    assert_close(run(node, {"image": picture}), expected, correlated(picture, np.abs(KERNEL), edge.scipy).max())


@pytest.mark.parametrize("preset", [name for name in PRESETS if name != "custom"])
def test_presets_are_the_kernels_of_the_literature(run, hdr, preset):
    picture = hdr(24, 19, opaque=True)
    found = run(Convolve3x3(preset=preset), {"image": picture})
    expected = correlated(picture, REFERENCE[preset])
    assert_close(found[..., :3], expected[..., :3], correlated(picture, np.abs(REFERENCE[preset])).max())
    np.testing.assert_array_equal(found[..., 3], 1.0)


def test_the_kernel_is_drawn_as_seen(run, hdr):
    picture = hdr(9, 8)
    above_left = Convolve3x3(preset="custom", kernel=(1, 0, 0, 0, 0, 0, 0, 0, 0), filter_alpha=True)
    np.testing.assert_array_equal(run(above_left, {"image": picture})[1:, 1:], picture[:-1, :-1])


def test_opencv_agrees(run, hdr):
    picture = hdr(40, 27)
    expected = cv2.filter2D(picture, -1, np.float32(KERNEL).reshape(3, 3), borderType=cv2.BORDER_REPLICATE)
    found = run(Convolve3x3(preset="custom", kernel=KERNEL, filter_alpha=True), {"image": picture})
    assert_close(found, expected, correlated(picture, np.abs(KERNEL)).max())


def test_openimageio_agrees(run, hdr):
    picture = hdr(40, 27)
    spec = oiio.ImageSpec(3, 3, 1, "float")
    spec.x = spec.y = -1
    kernel = oiio.ImageBuf(spec)
    kernel.set_pixels(oiio.ROI(-1, 2, -1, 2), np.float32(KERNEL).reshape(3, 3, 1))
    expected = oiio.ImageBufAlgo.convolve(oiio.ImageBuf(picture), kernel, False).get_pixels(oiio.FLOAT)
    found = run(Convolve3x3(preset="custom", kernel=KERNEL, filter_alpha=True), {"image": picture})
    assert_close(found, expected, correlated(picture, np.abs(KERNEL)).max())


def test_the_laplacian_equals_openimageio_and_scipy(run, hdr):
    picture = hdr(40, 27)
    found = run(Convolve3x3(preset="laplacian 4", filter_alpha=True), {"image": picture})
    scale = correlated(picture, np.abs(REFERENCE["laplacian 4"])).max()
    assert_close(found, oiio.ImageBufAlgo.laplacian(oiio.ImageBuf(picture)).get_pixels(oiio.FLOAT), scale)
    channels = [laplace(picture[..., channel].astype(np.float64), mode="nearest") for channel in range(4)]
    assert_close(found, np.stack(channels, axis=-1), scale)


def test_normalization_scale_and_bias(run, hdr):
    picture, kernel = hdr(16, 12, opaque=True), np.float64(KERNEL)
    for normalize, total in (("none", 1.0), ("sum", kernel.sum()), ("absolute sum", np.abs(kernel).sum())):
        node = Convolve3x3(preset="custom", kernel=KERNEL, normalize=normalize, scale=-1.5, bias=0.25)
        expected = correlated(picture, kernel / total * -1.5)[..., :3] + 0.25
        scale = correlated(picture, np.abs(kernel / total * 1.5)).max()
        assert_close(run(node, {"image": picture})[..., :3], expected, scale)


def test_a_kernel_of_sum_zero_is_not_divided_by_it():
    assert Convolve3x3(preset="laplacian 8", normalize="sum").weights() == Convolve3x3(preset="laplacian 8").weights()


def test_alpha_is_kept_and_bias_stays_within_it(run, hdr):
    picture = hdr(16, 12)
    flat = run(Convolve3x3(preset="laplacian 8", bias=0.18), {"image": np.full((5, 6, 4), 0.5, np.float32)})
    np.testing.assert_allclose(flat, np.broadcast_to([0.09, 0.09, 0.09, 0.5], (5, 6, 4)), rtol=1e-6)
    np.testing.assert_array_equal(run(Convolve3x3(preset="emboss"), {"image": picture})[..., 3], picture[..., 3])


def test_the_identity_kernel_vanishes(run, hdr):
    assert Convolve3x3(preset="custom").identity() == "image"
    assert Convolve3x3(preset="custom", bias=0.1).identity() is None
    assert Convolve3x3(preset="custom", kernel=(0, 0, 0, 0, 2, 0, 0, 0, 0), scale=0.5).identity() == "image"
    picture = hdr(8, 8)
    np.testing.assert_array_equal(run(Convolve3x3(preset="custom"), {"image": picture}), picture)
