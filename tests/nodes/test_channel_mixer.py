"""The channel mixer against OpenImageIO's color matrix."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.color.channel_mixer import ChannelMixer
from oiio_pictures import make_buffer

ROWS = {"red": (0.5, 0.7, -0.3), "green": (-0.2, 1.1, 0.4), "blue": (0.1, 0.1, 0.6)}
CONSTANT = (0.1, -0.05, 0.2)
GRAY = (0.9, 0.3, -0.1)


def mixed(picture: np.ndarray, rows: np.ndarray, constant: tuple[float, ...]) -> np.ndarray:
    """OpenImageIO multiplies rows from the left; what meets alpha is the constant."""
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(rows).T
    matrix[3, :3] = constant
    return oiio.ImageBufAlgo.colormatrixtransform(make_buffer(picture), tuple(matrix.ravel()), False).get_pixels(
        "float"
    )


def assert_close(found: np.ndarray, expected: np.ndarray) -> None:
    assert (np.abs(found - expected) / np.maximum(np.abs(expected).max(-1, keepdims=True), 1.0)).max() < 1e-6


@pytest.mark.parametrize("normalized", [False, True])
def test_it_is_openimageios_color_matrix(run, hdr, normalized):
    picture = hdr(23, 17)
    rows = np.array(list(ROWS.values()))
    rows = rows / rows.sum(1, keepdims=True) if normalized else rows
    node = ChannelMixer(**ROWS, constant=CONSTANT, normalized=normalized)
    assert_close(run(node, {"image": picture}), mixed(picture, rows, CONSTANT))


def test_monochrome_is_one_mix(run, hdr):
    picture = hdr(23, 17)
    node = ChannelMixer(monochrome=True, gray=GRAY, constant=CONSTANT)
    assert_close(run(node, {"image": picture}), mixed(picture, np.array([GRAY] * 3), CONSTANT))
    node = ChannelMixer(monochrome=True, gray=GRAY, normalized=True)
    white = run(node, {"image": np.ones((2, 2, 4))})
    assert np.abs(white - 1.0).max() < 1e-6


def test_a_mix_of_sum_zero_is_not_divided_by_it(run, hdr):
    picture = hdr(9, 7)
    mix = {"red": (1.0, -1.0, 0.0)}
    plain, normalized = (run(ChannelMixer(**mix, normalized=on), {"image": picture}) for on in (False, True))
    np.testing.assert_array_equal(plain, normalized)


def test_neutral_values_vanish():
    assert ChannelMixer().identity() == "image" and ChannelMixer(monochrome=True).identity() is None
    assert ChannelMixer(constant=CONSTANT).identity() is None
