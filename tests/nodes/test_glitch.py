"""Glitch against the hash of the paper and scipy's interpolation."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.distort.glitch import Glitch
from hashes import hash3
from warps import sample_bilinear


def test_the_hash_is_the_papers():
    assert (hash3((0, 0, 0)) * 2**24).tolist() == [part >> 8 for part in (2611992518, 2833812075, 1058359340)]
    assert (hash3((1, 2, 3)) * 2**24).tolist() == [part >> 8 for part in (4204755366, 1223881804, 1500469937)]


def cover_bands(y, band):
    """Which thin bands rows of pixels with middles at `y` show, and how much of each; one band if it is thinner."""
    if band <= 1.0:
        return [(np.floor(y / band), np.ones(y.shape))]
    first = np.floor((y - 0.5) / band)
    rows = (first, first + 1.0)
    return [
        (row, np.clip(np.minimum(y + 0.5, (row + 1.0) * band) - np.maximum(y - 0.5, row * band), 0.0, 1.0))
        for row in rows
    ]


@pytest.mark.parametrize("size", [(33, 26), (3, 2), (1, 1)])
@pytest.mark.parametrize("hold", [1, 3])
def test_bands_jump_as_the_hash_says(run, hdr, edge, size, hold):
    """On frame 1."""
    picture, height = hdr(*size), size[1]
    y, x = np.mgrid[: size[1], : size[0]] + 0.5
    expected = np.zeros(picture.shape)
    for row, weight in cover_bands(y, 0.075 * height):
        moved, apart = np.zeros(y.shape), np.zeros(y.shape)
        for level, many in enumerate((4, 1)):
            dice = hash3((np.floor(row / many), 1 // hold, level), (5, 0, 0))
            jumps = dice[0] < 0.6
            moved += jumps * 0.2 * height * (2 * dice[1] - 1)
            apart += jumps * 0.05 * height * (2 * dice[2] - 1)
        red, middle, blue = (sample_bilinear(picture, x + moved + way * apart, y, edge.scipy_map) for way in (1, 0, -1))
        expected += weight[..., None] * np.stack([red[..., 0], middle[..., 1], blue[..., 2], middle[..., 3]], -1)
    node = Glitch(amount=0.6, shift=0.2, colors=0.05, band=0.3, hold=hold, seed=5, edge=edge.name)
    assert np.abs(run(node, {"image": picture}) - expected).max() < 1e-5 * picture.max()


def test_wrapped_bands_lose_no_light(run, hdr):
    picture = hdr(40, 32)
    out = run(Glitch(colors=0.0, amount=1.0), {"image": picture})
    assert np.abs(out.sum(1) / picture.sum(1) - 1.0).max() < 1e-4
    assert not np.array_equal(out, picture)


def test_without_amount_it_vanishes():
    assert Glitch(amount=0.0).identity() == "image" and Glitch(shift=0.0, colors=0.0).identity() == "image"
    assert Glitch(shift=0.0).identity() is None
