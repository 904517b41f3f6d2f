"""Resize against OpenImageIO and numpy in 64 bits."""

from __future__ import annotations

import cv2
import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.distort.resize import Resize
from oiio_pictures import make_buffer

NAMES = {
    "box": "box",
    "triangle": "triangle",
    "catmull-rom": "catmull-rom",
    "mitchell": "mitchell",
    "lanczos": "lanczos3",
}
SCALES = [(2.0, 3.0), (0.5, 0.4), (1.37, 0.61), (0.21, 1.9)]


def cubic(x: np.ndarray, b: float, c: float) -> np.ndarray:
    x = np.abs(x)
    near = (12 - 9 * b - 6 * c) * x**3 + (-18 + 12 * b + 6 * c) * x**2 + 6 - 2 * b
    far = (-b - 6 * c) * x**3 + (6 * b + 30 * c) * x**2 + (-12 * b - 48 * c) * x + 8 * b + 24 * c
    return np.where(x < 1, near, np.where(x < 2, far, 0.0)) / 6


KERNELS = {
    "triangle": lambda x: np.maximum(1 - np.abs(x), 0),
    "catmull-rom": lambda x: cubic(x, 0, 0.5),
    "mitchell": lambda x: cubic(x, 1 / 3, 1 / 3),
    "lanczos": lambda x: np.where(np.abs(x) < 3, np.sinc(x) * np.sinc(x / 3), 0),
}


def matrix(before: int, after: int, kernel: str, mode: str) -> np.ndarray:
    """What every source pixel weighs in every result pixel."""
    step, pad = before / after, 8 * before + 40
    center, width = (np.arange(after)[:, None] + 0.5) * step, max(step, 1.0)
    pixels = np.arange(-pad, before + pad)[None]
    if kernel == "box":
        low, high = center - step / 2, center + step / 2
        weights = np.maximum(np.minimum(pixels + 1, high) - np.maximum(pixels, low), 0)
    else:
        weights = KERNELS[kernel]((pixels + 0.5 - center) / width)
    weights /= weights.sum(1, keepdims=True)
    source = (
        np.pad(np.arange(before), pad, mode=mode)
        if mode != "constant"
        else np.pad(np.arange(before), pad, constant_values=-1)
    )
    return np.stack([weights[:, source == pixel].sum(1) for pixel in range(before)], 1)


@pytest.mark.parametrize("kernel", NAMES)
@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("size", [(23, 17), (3, 2), (5, 1)])
def test_it_is_the_filter(run, hdr, kernel, scale, size):
    picture = hdr(*size)
    node = Resize(scale=scale, kernel=kernel)
    width, height = node.output_size({"image": size}, size)
    out = run(node, {"image": picture})
    assert out.shape == (height, width, 4)
    down, across = matrix(size[1], height, kernel, "edge"), matrix(size[0], width, kernel, "edge")
    expected = np.einsum("ij,jkc,lk->ilc", down, picture.astype(np.float64), across)
    assert np.abs(out - expected).max() < 3e-6 * picture.max()


def test_every_edge_mode(run, hdr, edge):
    picture = hdr(9, 7)
    out = run(Resize(scale=(1.5, 2.0), kernel="lanczos", edge=edge.name), {"image": picture})
    down, across = matrix(7, 14, "lanczos", edge.numpy), matrix(9, 14, "lanczos", edge.numpy)
    expected = np.einsum("ij,jkc,lk->ilc", down, picture.astype(np.float64), across)
    assert np.abs(out - expected).max() < 3e-6 * picture.max()


@pytest.mark.parametrize(
    ("kernel", "scale"),
    [
        ("box", (3.0, 3.0)),  # between whole factors, OpenImageIO's box counts whole pixels
        *((kernel, scale) for kernel in NAMES if kernel != "box" for scale in ((3.0, 3.0), (0.5, 0.4), (1.25, 0.6))),
    ],
)
def test_it_is_openimageios(run, hdr, kernel, scale):
    picture = hdr(40, 30)
    width, height = Resize(scale=scale).output_size({"image": (40, 30)}, (40, 30))
    expected = oiio.ImageBufAlgo.resize(
        make_buffer(picture), NAMES[kernel], roi=oiio.ROI(0, width, 0, height, 0, 1, 0, 4)
    ).get_pixels("float")
    out = run(Resize(scale=scale, kernel=kernel), {"image": picture})
    assert np.abs(out - expected).max() < 1e-5 * picture.max()


@pytest.mark.parametrize("kernel", NAMES)
def test_an_even_picture_stays_even(run, kernel):
    for scale in SCALES:
        out = run(Resize(scale=scale, kernel=kernel), {"image": np.full((7, 9, 4), 0.37)})
        assert np.abs(out - 0.37).max() < 1e-6


def test_a_single_pixel_stays_one(run):
    """It is a constant, not a picture."""
    assert run(Resize(scale=(2.0, 3.0)), {"image": np.full((1, 1, 4), 0.5)}).tolist() == [[[0.5] * 4]]


def test_a_box_is_opencvs_area(run, hdr):
    picture = hdr(40, 30)
    expected = cv2.resize(picture, (17, 11), interpolation=cv2.INTER_AREA)
    out = run(Resize(scale=(17 / 40, 11 / 30), kernel="box"), {"image": picture})
    assert np.abs(out - expected).max() < 2e-6 * picture.max()


def test_whole_boxes_average_exactly(run, hdr):
    picture = hdr(24, 12)
    out = run(Resize(scale=(0.25, 0.5), kernel="box"), {"image": picture})
    expected = picture.astype(np.float64).reshape(6, 2, 6, 4, 4).mean((1, 3))
    assert np.abs(out - expected).max() < 1e-6 * picture.max()


def test_the_same_size_vanishes():
    assert Resize().identity() == "image" and Resize(scale=(1.0, 2.0)).identity() is None
