"""Masks by number against numpy's equality."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import sample_layer
from halation.nodes.geometry.id_mask import IdMask


@pytest.mark.parametrize(
    ("pick", "spans"),
    [
        ("3", [(3, 3)]),
        ("1, 4, 7-9", [(1, 1), (4, 4), (7, 9)]),
        ("2;5 11 - 13", [(2, 2), (5, 5), (11, 13)]),
        ("-3--1, 0", [(-3, -1), (0, 0)]),
        ("2.5", [(2.5, 2.5)]),
        ("floor12, x3, 4th, 1.2.3", []),
        ("", []),
    ],
)
@pytest.mark.parametrize("invert", [False, True])
def test_it_is_exact(run, pick, spans, invert):
    ids = np.random.default_rng(1).integers(-5, 16, (17, 23)) * 0.5
    ids[::2] = np.random.default_rng(2).integers(-5, 16, (9, 23))
    expected = np.zeros(ids.shape, bool)
    for low, high in spans:
        expected |= (ids >= low) & (ids <= high)
    found = run(IdMask(pick=pick, invert=invert), {"ids": ids}, output="mask")[..., 0]
    np.testing.assert_array_equal(found, expected != invert)


def test_any_count_of_numbers(run):
    ids = np.arange(200.0).reshape(10, 20)
    picked = [n for n in range(200) if n % 3 == 0]
    found = run(IdMask(pick=",".join(map(str, picked))), {"ids": ids}, output="mask")[..., 0]
    np.testing.assert_array_equal(found, np.isin(ids, picked))


def test_neighbors_among_large_numbers(run):
    ids = np.array([[16777214.0, 16777215.0, 16777216.0]])
    assert run(IdMask(pick="16777215"), {"ids": ids}, output="mask")[..., 0].tolist() == [[0.0, 1.0, 0.0]]


@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_a_proxy_is_as_hard(run, scale):
    found = run(IdMask(pick="3"), {"ids": sample_layer("Object Index")}, output="mask", scale=scale)
    assert set(np.unique(found)) == {0.0, 1.0}


def test_every_number_has_its_color(run):
    ids = np.arange(256.0).reshape(16, 16)
    found = run(IdMask(), {"ids": ids}, output="colors").reshape(256, 4)
    assert (found[0] == (0.0, 0.0, 0.0, 1.0)).all()
    assert len(np.unique(found.round(4), axis=0)) > 250
    assert found[1:, :3].max(axis=1).min() > 0.25 and found[..., :3].max() <= 1.0
