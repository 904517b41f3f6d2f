"""At which size a fit compares pictures, and in which range it looks for a value that has no slider."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import cv2
import numpy as np
import pytest
from halation.fit import fitting, search_space


def scale_of(picture: tuple[int, int], reference: tuple[int, int], comparison: str) -> float:
    task: Any = SimpleNamespace(comparison=comparison, reference=np.zeros((*reference, 3)))
    return fitting._find_full_scale(np.zeros((*picture, 3)), task)  # pyright: ignore[reportPrivateUsage]


@pytest.mark.parametrize(
    ("picture", "reference", "by_pixels", "by_look"),
    [
        ((40, 80), (20, 40), 0.5, 0.5),
        ((20, 40), (40, 80), 1.0, 1.0),
        ((20, 40), (20, 40), 1.0, 1.0),
        ((30, 90), (20, 60), 2.0 / 3.0, 2.0 / 3.0),
    ],
)
def test_no_more_pixels_than_the_reference(
    picture: tuple[int, int], reference: tuple[int, int], by_pixels: float, by_look: float
) -> None:
    assert scale_of(picture, reference, "pixels") == pytest.approx(by_pixels)
    assert scale_of(picture, reference, "look") == pytest.approx(by_look)


def test_a_look_of_another_shape_has_as_many_pixels() -> None:
    assert scale_of((10, 90), (30, 12), "look") == pytest.approx((360 / 900) ** 0.5)


@pytest.mark.parametrize("factor", [2, 3])
def test_a_reference_is_made_as_large_as_the_picture(factor: int) -> None:
    """By area, as OpenCV does it; for a look in its own shape, with as many pixels."""
    reference = np.random.default_rng(factor).random((12 * factor, 6 * factor, 3)).astype(np.float32)
    match = fitting._match_size  # pyright: ignore[reportPrivateUsage]
    smaller = cv2.resize(reference, (6, 12), interpolation=cv2.INTER_AREA)
    for picture, comparison in (((12, 6), "pixels"), ((12, 6), "look"), ((6, 12), "look"), ((8, 9), "look")):
        found = match(reference, np.zeros((*picture, 3)), comparison)  # pyright: ignore[reportArgumentType]
        np.testing.assert_allclose(found, smaller, atol=1e-6)
    assert match(reference, np.zeros((99, 99, 3)), "look") is reference
    assert match(reference, np.zeros((*reference.shape[:2], 3)), "pixels") is reference


@pytest.mark.parametrize(
    ("facts", "number", "place", "limits"),
    [
        ({"low": -2.0, "high": 3.0}, 1.0, 0, (-2.0, 3.0)),
        ({"wheel": 0.25, "default": (1.0, 0.5, 1.0)}, 0.9, 1, (0.25, 0.75)),
        ({"low": 3.0, "high": 3.0}, 5.0, 0, (4.0, 6.0)),
        ({"low": 0.0}, 5.0, 0, (4.0, 6.0)),
        ({"high": 9.0}, -5.0, 0, (-6.0, -4.0)),
        ({"type": "color"}, 0.2, 0, (0.0, 1.0)),
        ({"type": "color"}, 4.0, 2, (0.0, 8.0)),
    ],
)
def test_a_range_is_that_of_the_wheel_or_the_slider_or_lies_around_the_number(
    facts: dict[str, Any], number: float, place: int, limits: tuple[float, float]
) -> None:
    value: Any = SimpleNamespace(
        **{"wheel": 0.0, "default": 0.0, "low": -np.inf, "high": np.inf, "type": "float"} | facts
    )
    found = search_space._find_declared_range(value, number, place)  # pyright: ignore[reportPrivateUsage]
    assert found == pytest.approx(limits)
