"""Numbers about pixels."""

import numpy as np
import pytest
from halation.editor.viewer import measuring


def test_statistics_leave_out_what_is_not_finite() -> None:
    found = measuring.statistics(np.asarray([[[1.0, -2.0], [3.0, np.nan]], [[5.0, 4.0], [np.inf, 1.0]]]))
    assert found.low == (1.0, -2.0) and found.high == (5.0, 4.0)
    assert found.mean == pytest.approx((3.0, 1.0))
    assert (found.wrong, found.count) == (2, 4)


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (0.18, "0.18000"),
        (1.5, "1.5000"),
        (123.456, "123.46"),
        (1e7, "1.00e+07"),
        (-0.0001, "-1.00e-04"),
        (float("nan"), "NaN"),
        (float("-inf"), "-inf"),
        (0.0, "0.00000"),
    ],
)
def test_numbers_are_short(number: float, text: str) -> None:
    assert measuring.format_pixel_number(number) == text


def test_copies_keep_every_digit() -> None:
    assert measuring.format_pixel("A", (3, 4), (float(np.float32(0.1)), 1.0)) == "A 3 4: 0.10000000149011612 1.0"
    assert measuring.hsv((0.0, 0.5, 0.0)) == pytest.approx((120.0, 1.0, 0.5))
