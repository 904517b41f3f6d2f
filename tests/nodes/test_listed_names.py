"""Texts that list names: a choice is one of them, or the number that it says."""

from __future__ import annotations

import pytest
from halation.nodes._declare.listed_names import find_number, is_number

NAMES = "day, night,,3, 12"


@pytest.mark.parametrize(
    ("name", "number"),
    [("day", 1), ("night", 2), ("3", 4), ("12", 5), ("4", 4), ("999", 999), ("1000", None), ("0", None), ("007", None),
     ("-1", None), ("1.5", None), ("dusk", None), ("", None), ("\u0663", None), ("\u00b2", None)],
)  # fmt: skip
def test_a_name_counts_before_the_number_that_it_says(name: str, number: int | None) -> None:
    assert find_number(NAMES, name) == number


@pytest.mark.parametrize(
    ("text", "is_small"), [("1", True), ("10", True), ("999", True), ("1000", False), ("01", False)]
)
def test_numbers_are_small_and_written_plainly(text: str, is_small: bool) -> None:
    assert is_number(text) is is_small
