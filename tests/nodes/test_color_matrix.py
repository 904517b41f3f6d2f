"""The color matrix against OpenImageIO, OpenColorIO and numpy."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import PyOpenColorIO as ocio
import pytest
from halation.nodes.color.color_matrix import ColorMatrix
from oiio_pictures import make_buffer

MATRIX = (0.9, 0.2, -0.1, 0.05, 0.8, 0.3, -0.2, 0.1, 1.4)
PRESETS = ColorMatrix.values["preset"].choices
SPACES = {
    "rec709 to rec2020": "Linear Rec.2020",
    "rec709 to p3": "Linear P3-D65",
    "rec709 to acescg": "ACEScg",
}


def assert_close(found: np.ndarray, expected: np.ndarray, wanted: float = 1e-6) -> None:
    assert (np.abs(found - expected) / np.maximum(np.abs(expected).max(-1, keepdims=True), 1.0)).max() < wanted


@pytest.mark.parametrize("direction", ["forward", "inverse"])
def test_it_is_openimageios(run, hdr, direction):
    picture, offset = hdr(23, 17), (0.1, -0.2, 0.05)
    rows = np.array(MATRIX).reshape(3, 3)
    matrix = np.eye(4)
    matrix[:3, :3] = (rows if direction == "forward" else np.linalg.inv(rows)).T
    matrix[3, :3] = offset
    expected = oiio.ImageBufAlgo.colormatrixtransform(make_buffer(picture), tuple(matrix.ravel()), False).get_pixels(
        "float"
    )
    node = ColorMatrix(preset="custom", matrix=MATRIX, direction=direction, offset=offset)
    assert_close(run(node, {"image": picture}), expected)


@pytest.mark.parametrize("preset", SPACES)
def test_conversions_are_opencolorios(run, hdr, preset):
    """Its built-in matrices are computed in 64 bits from the same primaries."""
    picture = hdr(23, 17, opaque=True)
    config = ocio.Config.CreateFromBuiltinConfig("cg-config-v2.1.0_aces-v1.3_ocio-v2.3")
    processor = config.getProcessor("Linear Rec.709 (sRGB)", SPACES[preset])
    expected = np.ascontiguousarray(picture[..., :3]).reshape(-1, 3)
    processor.getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS).applyRGB(expected)
    out = run(ColorMatrix(preset=preset), {"image": picture})[..., :3]
    assert_close(out.reshape(-1, 3), expected)


def test_white_is_the_white_of_xyz(run):
    """D65 is x 0.3127, y 0.3290 (ITU-R BT.709); luminance is the middle row."""
    x, y, z = run(ColorMatrix(preset="rec709 to xyz"), {"image": np.ones((1, 1, 4))})[0, 0, :3]
    assert abs(y - 1.0) < 1e-6 and abs(x - 0.3127 / 0.3290) < 1e-6 and abs(z - 0.3583 / 0.3290) < 1e-6


@pytest.mark.parametrize("preset", [name for name in SPACES if name != "custom"])
def test_inverse_undoes(run, hdr, preset):
    picture = hdr(9, 7)
    there = run(ColorMatrix(preset=preset), {"image": picture})
    assert_close(run(ColorMatrix(preset=preset, direction="inverse"), {"image": there}), picture, 2e-6)


def test_a_matrix_without_an_inverse_is_used_as_it_is(run, hdr):
    flat = (0.2, 0.7, 0.1) * 3
    node = ColorMatrix(preset="custom", matrix=flat, direction="inverse")
    assert node.resolve_matrix() == flat


def test_the_identity_vanishes(run, hdr):
    assert ColorMatrix(preset="custom").identity() == "image"
    assert ColorMatrix(preset="custom", offset=(0.1, 0.0, 0.0)).identity() is None and ColorMatrix().identity() is None
