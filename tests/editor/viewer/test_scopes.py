"""Scopes against NumPy and pictures made by hand."""

import math

import numpy as np
import pytest
from halation.editor.viewer import scopes


def test_histogram_counts_as_numpy_does() -> None:
    rgb = np.random.default_rng(1).random((40, 60, 3), np.float32)
    counts = scopes.histogram(rgb)
    for channel in range(3):
        expected, _ = np.histogram(rgb[..., channel], bins=scopes.BINS, range=(0.0, 1.0))
        assert np.array_equal(counts[channel], expected)
    assert counts[3].sum() == 40 * 60


def test_histogram_piles_up_what_is_outside() -> None:
    rgb = np.asarray([[[-5.0, 0.5, 9.0]]], np.float32)
    counts = scopes.histogram(rgb)
    assert counts[0, 0] == 1 and counts[1, 128] == 1 and counts[2, -1] == 1
    assert scopes.histogram(rgb, -10.0, 10.0)[0, 64] == 1


def test_clipping_is_a_part_of_the_pixels() -> None:
    rgb = np.asarray([[[0.0, 0.0, 0.0], [0.0, 0.2, 0.0], [0.5, 1.0, 0.5], [0.1, 0.1, 0.1]]], np.float32)
    assert scopes.measure_clipping(rgb) == (0.25, 0.25)


def test_waveform_of_a_ramp_is_a_diagonal() -> None:
    ramp = np.repeat(np.linspace(0.0, 0.999, 32, dtype=np.float32)[None, :, None], 3, axis=2).repeat(5, axis=0)
    counts = scopes.waveform(ramp, 32, 32)
    assert np.array_equal(counts[..., 0], np.eye(32, dtype=int)[::-1] * 5)


def test_waveform_of_narrow_pictures_leaves_columns_out() -> None:
    counts = scopes.waveform(np.full((4, 2, 3), 0.5, np.float32), 8, 8)
    assert counts.sum() == 4 * 2 * 3
    assert set(np.nonzero(counts[..., 0])[1]) == {0, 4}


def test_parade_sets_channels_side_by_side() -> None:
    counts = scopes.parade(np.broadcast_to(np.float32([0.1, 0.5, 0.9]), (6, 6, 3)), 9, 10)
    assert [np.nonzero(counts[..., index])[0][0] for index in range(3)] == [8, 4, 0]
    assert [sorted(set(np.nonzero(counts[..., index])[1])) for index in range(3)] == [[0, 1, 2], [3, 4, 5], [6, 7, 8]]


def test_gray_is_in_the_middle_of_the_vectorscope() -> None:
    counts = scopes.vectorscope(np.full((3, 3, 3), 0.7, np.float32), 101)
    assert counts[50, 50] == 9 and counts.sum() == 9


@pytest.mark.parametrize(("name", "color"), scopes.TARGETS)
def test_bars_hit_their_targets(name: str, color: tuple[float, float, float]) -> None:
    counts = scopes.vectorscope(np.broadcast_to(np.float32(color), (1, 1, 3)), 200)
    row, column = (int(found[0]) for found in np.nonzero(counts))
    x, y = scopes.chroma_place(color)
    assert abs(column + 0.5 - x * 200) <= 1.0 and abs(row + 0.5 - y * 200) <= 1.0


def test_chroma_is_that_of_bt709() -> None:
    assert scopes.chroma(np.asarray((0.0, 0.0, 1.0)))[0] == pytest.approx(0.5, abs=1e-4)
    assert scopes.chroma(np.asarray((1.0, 0.0, 0.0)))[1] == pytest.approx(0.5, abs=1e-4)
    blue, red = scopes.chroma(np.asarray((0.86, 0.64, 0.52)))
    assert math.degrees(math.atan2(red, blue)) == pytest.approx(scopes.SKIN_ANGLE, abs=6.0)


def test_glow_shows_single_pixels() -> None:
    shown = scopes.glow(np.asarray([0, 1, 10, 100]))
    assert shown[0] == 0.0 and 0.0 < shown[1] < shown[2] <= shown[3] <= 1.0
    assert not scopes.glow(np.zeros(3)).any()


def test_color_of_any_channels_without_what_is_not_finite() -> None:
    assert scopes.rgb_of(np.full((2, 2, 1), 0.25)).tolist() == [[[0.25] * 3] * 2] * 2
    assert scopes.rgb_of(np.asarray([[[1.0, np.nan]]])).tolist() == [[[1.0, 0.0, 0.0]]]
    assert scopes.rgb_of(np.asarray([[[1.0, np.inf, 2.0, 0.5]]])).tolist() == [[[1.0, 0.0, 2.0]]]


def test_extent_grows_with_the_picture() -> None:
    assert scopes.extent(np.full((2, 2, 3), 0.5)) == (0.0, 1.0)
    assert scopes.extent(np.asarray([[[-1.0, 0.0, 8.0]]]))[0] == -1.0
