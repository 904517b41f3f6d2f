"""Numbers about pixels."""

import numpy as np
import pytest
from halation.app.editor.viewer import measuring


def test_statistics_leave_out_what_is_not_finite() -> None:
    found = measuring.statistics(np.asarray([[[1.0, -2.0], [3.0, np.nan]], [[5.0, 4.0], [np.inf, 1.0]]]))
    assert found.low == (1.0, -2.0) and found.high == (5.0, 4.0)
    assert found.mean == pytest.approx((3.0, 1.0))
    assert (found.wrong, found.count) == (2, 4)


def test_ranges_ignore_stray_extremes() -> None:
    depth = np.linspace(2.0, 9.0, 1000).reshape(20, 50, 1)
    depth[0, 0], depth[0, 1] = 1e10, np.inf
    low, high = measuring.data_range(depth)
    assert 2.0 <= low < 2.1 and 8.9 < high <= 9.0


@pytest.mark.parametrize("sky", [1e10, 65504.0])
def test_the_sky_is_not_part_of_the_range_of_depth(sky: float) -> None:
    depth = np.linspace(2.0, 9.0, 1000).reshape(20, 50, 1)
    depth[:8] = sky
    low, high = measuring.data_range(depth)
    assert 4.0 < low < high <= 9.0
    assert measuring.data_range(np.full((2, 2, 1), sky))[0] == sky


def test_ranges_of_masks_and_of_nothing() -> None:
    mask = np.zeros((100, 100, 1))
    mask[:10] = 1.0
    assert measuring.data_range(mask) == (0.0, 1.0)
    spot = np.zeros((100, 100, 1))
    spot[0, 0] = 4.0
    assert measuring.data_range(spot) == (0.0, 4.0)
    assert measuring.data_range(np.zeros((3, 3, 1))) == (0.0, 1.0)
    assert measuring.data_range(np.full((3, 3, 1), np.nan)) == (0.0, 1.0)


def test_signed_data_is_balanced() -> None:
    assert measuring.balanced(-2.0, 5.0) == (-5.0, 5.0)
    assert measuring.balanced(1.0, 5.0) == (1.0, 5.0)


def test_normals_are_known_by_their_length() -> None:
    rng = np.random.default_rng(3)
    some = rng.normal(size=(20, 20, 3))
    unit = some / np.linalg.norm(some, axis=2, keepdims=True)
    unit[:5] = 0.0  # no surface there
    assert measuring.are_normals(unit)
    assert not measuring.are_normals(some)
    assert not measuring.are_normals(unit[..., :2])
    assert not measuring.are_normals(np.zeros((4, 4, 3)))


@pytest.mark.parametrize(
    ("number", "text"),
    [(0.18, "0.18000"), (1.5, "1.5000"), (123.456, "123.46"), (1e7, "1.00e+07"), (-0.0001, "-1.00e-04"),
     (float("nan"), "NaN"), (float("-inf"), "-inf"), (0.0, "0.00000")],
)
def test_numbers_are_short(number: float, text: str) -> None:
    assert measuring.written(number) == text


def test_copies_keep_every_digit() -> None:
    assert measuring.copied("A", (3, 4), (float(np.float32(0.1)), 1.0)) == "A 3 4: 0.10000000149011612 1.0"
    assert measuring.hsv((0.0, 0.5, 0.0)) == pytest.approx((120.0, 1.0, 0.5))
