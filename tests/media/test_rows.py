"""Rows of a picture are the same whether they are read alone or with all others."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.media import LayerRequest, read_info, read_layer
from halation.media.pictures.row_reader import read_rows
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from oiio_pictures import write_with_attributes

HEIGHT, WIDTH = 75, 40


def pixels(seed: int, channels: int = 4, *, broken: int = 0) -> np.ndarray:
    """Light, of which so many pixels are no numbers, and a column of them from top to bottom."""
    dice = np.random.default_rng(seed)
    array = dice.gamma(0.6, 1.0, (HEIGHT, WIDTH, channels)).astype(np.float32)
    for bad in (np.nan, np.inf, -np.inf):
        rows, columns = dice.integers(0, HEIGHT, broken), dice.integers(0, WIDTH, broken)
        array[rows, columns, dice.integers(0, channels, broken)] = bad
    if broken:
        array[5:60, 7:9] = np.nan
    return array


FILES = {
    "half": ("a.exr", {"format": "half"}, Kind.IMAGE),
    "float": ("a.exr", {"format": "float", "compression": "piz"}, Kind.IMAGE),
    "tiles": ("a.exr", {"format": "half", "tile": 16}, Kind.IMAGE),
    "codes": ("a.tif", {"format": "uint8"}, Kind.IMAGE),
    "straight": ("a.tif", {"format": "uint16", "oiio:UnassociatedAlpha": 1}, Kind.IMAGE),
    "data": ("a.exr", {"format": "float"}, Kind.VECTOR),
}


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("broken", [0, 40])
def test_rows_are_those_of_the_whole(tmp_path, name, broken):
    file, said, kind = FILES[name]
    path = write_with_attributes(tmp_path / file, pixels(1, broken=broken), **said)
    assert read_info(path, sandbox=UNRESTRICTED).by_rows
    whole, want, repaired = read_layer(path, "", kind, sandbox=UNRESTRICTED), LayerRequest("", kind), 0
    for first, end in ((0, 20), (20, 21), (21, 50), (50, HEIGHT)):
        rows = read_rows(path, want, first, end, sandbox=UNRESTRICTED)
        assert rows.array.dtype == whole.array.dtype
        np.testing.assert_array_equal(rows.array, whole.array[first:end])
        repaired += rows.repaired
    assert repaired == whole.repaired


def test_what_has_no_rows_of_its_own_says_so(tmp_path):
    assert not read_info(
        write_with_attributes(tmp_path / "a.png", pixels(1), format="uint8"), sandbox=UNRESTRICTED
    ).by_rows
    assert not read_info(
        write_with_attributes(tmp_path / "a.tif", pixels(1), format="uint8", Orientation=6), sandbox=UNRESTRICTED
    ).by_rows
    cut = oiio.ImageBuf(write_with_attributes(tmp_path / "whole.exr", pixels(1)))
    cut.set_full(-5, WIDTH, 0, HEIGHT, 0, 1)
    assert cut.write(str(tmp_path / "cut.exr")) and not read_info(tmp_path / "cut.exr", sandbox=UNRESTRICTED).by_rows
