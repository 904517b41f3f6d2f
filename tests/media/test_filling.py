"""Nothing in color stays infinite or without a number, wherever it lies and however large its neighbors are."""

from __future__ import annotations

import numpy as np
import pytest
from halation.media import LayerRequest, read_layer
from halation.media.pictures.finite import fill_non_finite
from halation.media.pictures.row_reader import read_rows
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from oiio_pictures import write_with_attributes


def test_all_values_of_half_floats(tmp_path):
    """As OpenEXR's AllHalfValues.exr: whole rows of what is no number, below the largest numbers that there are."""
    values = np.arange(1 << 16, dtype=np.uint16).view(np.float16).reshape(256, 256, 1).repeat(3, axis=2)
    path = write_with_attributes(tmp_path / "a.exr", values)
    pixels = read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)
    assert np.isfinite(pixels.array).all() and pixels.repaired == 2048
    finite = np.isfinite(values)
    np.testing.assert_array_equal(pixels.array[..., :3][finite], values[finite])
    assert np.abs(pixels.array[124, :, 0].astype(float) - 65504).max() < 10000


@pytest.mark.parametrize("dtype", [np.float16, np.float32])
@pytest.mark.parametrize("size", [1.0, 0.9, 1e-3])
def test_holes_among_numbers_of_any_size(size, dtype):
    """Three rows and a column of nothing, below and beside the largest numbers."""
    number = dtype(np.finfo(dtype).max * size)
    array = np.full((40, 50, 4), number, dtype)
    array[7:10], array[30, 10:], array[39, 3] = np.inf, np.nan, -np.inf
    filled = fill_non_finite(array)
    assert filled.dtype == dtype
    np.testing.assert_allclose(filled.astype(np.float64), float(number), rtol=2e-3)


@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf])
def test_where_nothing_is_finite_there_is_no_light(number):
    assert not fill_non_finite(np.full((5, 5, 4), number, np.float32)).any()


def test_rows_alone_are_filled_as_in_the_whole(tmp_path):
    array = np.random.default_rng(1).random((120, 30, 4)).astype(np.float32)
    array[:45], array[60:90, 3:9], array[100:, ::2] = np.nan, np.inf, np.nan
    path = write_with_attributes(tmp_path / "a.exr", array, format="float")
    whole = read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)
    assert np.isfinite(whole.array).all()
    for first, end in ((0, 10), (10, 44), (44, 70), (70, 120)):
        rows = read_rows(path, LayerRequest("", Kind.IMAGE), first, end, sandbox=UNRESTRICTED)
        np.testing.assert_array_equal(rows.array, whole.array[first:end])
