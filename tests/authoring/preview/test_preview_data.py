"""Which numbers of data are worth showing, and what vectors mean."""

import numpy as np
import pytest
from halation.media.comparison import data_range as data


def test_ranges_ignore_stray_extremes() -> None:
    depth = np.linspace(2.0, 9.0, 1000).reshape(20, 50, 1)
    depth[0, 0], depth[0, 1] = 1e10, np.inf
    low, high = data.find_data_range(depth)
    assert 2.0 <= low < 2.1 and 8.9 < high <= 9.0


@pytest.mark.parametrize("sky", [1e10, 65504.0])
def test_the_sky_is_not_part_of_the_range_of_depth(sky: float) -> None:
    depth = np.linspace(2.0, 9.0, 1000).reshape(20, 50, 1)
    depth[:8] = sky
    low, high = data.find_data_range(depth)
    assert 4.0 < low < high <= 9.0
    assert data.find_data_range(np.full((2, 2, 1), sky))[0] == sky


def test_ranges_of_masks_and_of_nothing() -> None:
    mask = np.zeros((100, 100, 1))
    mask[:10] = 1.0
    assert data.find_data_range(mask) == (0.0, 1.0)
    spot = np.zeros((100, 100, 1))
    spot[0, 0] = 4.0
    assert data.find_data_range(spot) == (0.0, 4.0)
    assert data.find_data_range(np.zeros((3, 3, 1))) == (0.0, 1.0)
    assert data.find_data_range(np.full((3, 3, 1), np.nan)) == (0.0, 1.0)


def test_signed_data_is_balanced() -> None:
    assert data.balance_range(-2.0, 5.0) == (-5.0, 5.0)
    assert data.balance_range(1.0, 5.0) == (1.0, 5.0)


def test_normals_are_known_by_their_length() -> None:
    rng = np.random.default_rng(3)
    some = rng.normal(size=(20, 20, 3))
    unit = some / np.linalg.norm(some, axis=2, keepdims=True)
    unit[:5] = 0.0  # no surface there
    assert data.are_normals(unit)
    assert not data.are_normals(some)
    assert not data.are_normals(unit[..., :2])
    assert not data.are_normals(np.zeros((4, 4, 3)))
