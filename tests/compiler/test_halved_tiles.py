"""Tiles of pictures that are too large for a device are halved until they fit."""

from __future__ import annotations

import math

from halation.compiler.tiling import tiling
from hypothesis import given
from hypothesis import strategies as st

SIDES = st.integers(1, 40_000)
halve = tiling._halve_tile  # pyright: ignore[reportPrivateUsage]


def half(side: int) -> int:
    return max(math.ceil(side / 2), tiling.MIN_TILE)


@given(SIDES, SIDES)
def test_the_longer_side_is_halved(width: int, height: int) -> None:
    expected = (half(width), height) if width > height else (width, half(height))
    assert halve((width, height), (False, False)) == expected


@given(SIDES, SIDES)
def test_a_side_that_is_too_long_for_the_device_is_halved_before(width: int, height: int) -> None:
    if min(width, height) > tiling.MIN_TILE:
        assert halve((width, height), (True, False)) == halve((width, height), (True, True)) == (half(width), height)
        assert halve((width, height), (False, True)) == (width, half(height))


def test_the_smallest_tile_is_not_halved_across_again() -> None:
    """Then the longer side is, whatever is too long."""
    least = tiling.MIN_TILE
    assert halve((least, 9 * least), (True, False)) == (least, half(9 * least))
    assert halve((9 * least, least), (False, True)) == (half(9 * least), least)
