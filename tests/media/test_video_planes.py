"""Planes that go to an encoder, against BT.601 and BT.709 in 64 bits, scipy's filters, and small pictures by hand."""

from __future__ import annotations

import numpy as np
import pytest
from halation.color.dithering import make_dither
from halation.media.video.writer import _chroma_planes, _rgb_planes
from scipy.ndimage import correlate1d

MATRICES = {1: (0.2126, 0.0722), 6: (0.299, 0.114)}
"""Shares of red and blue in luma, by the numbers of H.273: BT.709 and BT.601."""

FORMATS = {"yuv444p": (1, 1), "yuv422p": (2, 1), "yuv420p": (2, 2)}
"""How many pixels share a sample of chroma, across and down."""


def convert(rgb: np.ndarray, matrix: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Luma and both differences by the equations of BT.709, which BT.601 has with other shares."""
    kr, kb = MATRICES[matrix]
    luma = kr * rgb[..., 0] + (1.0 - kr - kb) * rgb[..., 1] + kb * rgb[..., 2]
    return luma, (rgb[..., 2] - luma) / (2.0 * (1.0 - kb)), (rgb[..., 0] - luma) / (2.0 * (1.0 - kr))


def shrink(plane: np.ndarray, across: int, down: int) -> np.ndarray:
    """A triangle of three samples around every other column, then the mean of two rows; edges go on."""
    if across == 2:
        plane = correlate1d(plane, [0.25, 0.5, 0.25], axis=1, mode="nearest")[:, ::2]
    if down == 2:
        after = np.vstack([plane[1:], plane[-1:]])
        plane = (0.5 * (plane + after))[::2]
    return plane


@pytest.mark.parametrize("size", [(8, 6), (7, 5), (1, 1), (2, 1), (1, 2)])
@pytest.mark.parametrize("bits", [8, 10, 12])
@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("matrix", MATRICES)
def test_planes_are_those_of_the_standards(matrix: int, name: str, bits: int, size: tuple[int, int]) -> None:
    rgb = np.random.default_rng(bits).random((size[1], size[0], 3))
    luma, *differences = convert(rgb, matrix)
    step = 2.0 ** (bits - 8)
    expected = [16.0 * step + 219.0 * step * luma]
    expected += [128.0 * step + 224.0 * step * shrink(plane, *FORMATS[name]) for plane in differences]
    found = _chroma_planes(rgb.astype(np.float32), matrix, name + ("" if bits == 8 else f"{bits}le"), bits, None)
    for plane, exact in zip(found, expected, strict=True):
        assert plane.dtype == (np.uint8 if bits == 8 else np.uint16)
        assert plane.shape == exact.shape
        assert np.abs(plane - exact).max() <= 0.5 + 1e-3, "rounded to the nearest code"


@pytest.mark.parametrize("bits", [8, 10])
def test_the_ends_of_the_range(bits: int) -> None:
    """Black, white, and the strongest colors are the codes that BT.709 names; beyond them nothing wraps around."""
    rgb = np.array([[(0, 0, 0), (1, 1, 1), (0, 0, 1), (1, 1, 0), (9, 9, 9), (-9, -9, -9)]], np.float32)
    luma, blue, _ = _chroma_planes(rgb, 1, "yuv444p", bits, None)
    step = 2 ** (bits - 8)
    assert luma[0, :2].tolist() == [16 * step, 235 * step]
    assert blue[0, :4].tolist() == [128 * step, 128 * step, 240 * step, 16 * step]
    assert luma[0, 4:].tolist() == [2**bits - 1, 0]


@pytest.mark.parametrize("bits", [8, 10])
def test_alpha_has_the_full_range_and_is_opaque_where_there_is_none(bits: int) -> None:
    rgba = np.zeros((1, 4, 4), np.float32)
    rgba[0, :, 3] = (0.0, 0.25, 0.5, 1.0)
    top = 2**bits - 1
    *_, alpha = _chroma_planes(rgba, 1, "yuva444p", bits, None)
    assert alpha[0].tolist() == [0, round(0.25 * top), int(0.5 * top + 0.5), top]
    *_, alpha = _chroma_planes(rgba[..., :3], 1, "yuva444p", bits, None)
    assert alpha.tolist() == [[top] * 4]
    assert len(_chroma_planes(rgba, 1, "yuv444p", bits, None)) == 3


def test_color_is_dithered_by_the_frame_and_alpha_is_not() -> None:
    """What is added before a code is rounded is the grain of the frame and the plane."""
    rgba = np.full((16, 16, 4), 0.4242, np.float32)
    plain, dithered = (_chroma_planes(rgba, 1, "yuva444p", 8, frame) for frame in (None, 5))
    exact = 16.0 + 219.0 * 0.4242
    np.testing.assert_array_equal(dithered[0], np.floor(exact + make_dither(16, 16, 5, 0) + 0.5))
    for index in (1, 2):
        np.testing.assert_array_equal(dithered[index], np.floor(128.0 + make_dither(16, 16, 5, index) + 0.5))
    np.testing.assert_array_equal(dithered[3], plain[3])
    assert not np.array_equal(dithered[0], _chroma_planes(rgba, 1, "yuva444p", 8, 6)[0])


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("channels", [3, 4])
def test_planes_of_rgb_have_the_order_of_their_names(dtype: type[np.integer], channels: int) -> None:
    """`gbrap` has a plane for each letter, the others one in which letters take turns."""
    codes = np.arange(2 * 3 * channels, dtype=dtype).reshape(2, 3, channels)
    letters = {"r": codes[..., 0], "g": codes[..., 1], "b": codes[..., 2]}
    letters["a"] = codes[..., 3] if channels == 4 else np.full((2, 3), np.iinfo(dtype).max, dtype)
    for name in ("rgba", "bgra", "argb"):
        (packed,) = _rgb_planes(codes, name)
        np.testing.assert_array_equal(packed.reshape(2, 3, 4), np.stack([letters[letter] for letter in name], 2))
    for plane, letter in zip(_rgb_planes(codes, "gbrap"), "gbra", strict=True):
        np.testing.assert_array_equal(plane, letters[letter])
