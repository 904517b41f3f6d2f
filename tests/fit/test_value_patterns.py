"""Which values may change, as people write it."""

from __future__ import annotations

import pytest
from halation.errors import UsageError
from halation.fit.value_patterns import ValuePattern, parse_patterns


def test_patterns_are_names_with_ranges() -> None:
    assert parse_patterns(["grade.*, bloom.intensity=0..2", "knob=-1.5..1e2"]) == (
        ValuePattern("grade.*"),
        ValuePattern("bloom.intensity", 0.0, 2.0),
        ValuePattern("knob", -1.5, 100.0),
    )


@pytest.mark.parametrize(
    "text", ["", "a,,b", "=0..1", "a=", "a=1", "a=0..", "a=..1", "a=1..1", "a=2..1", "a=0..inf", "a=-inf..0",
             "a=nan..1", "a=0..1..2", "a=x..1"]
)  # fmt: skip
def test_what_is_no_pattern_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="--values"):
        parse_patterns([text])


@pytest.mark.parametrize(
    ("pattern", "name", "fits"),
    [
        ("grade.*", "grade.gain", True), ("grade.*", "grade.gain.red", False), ("*.gain", "grade.gain", True),
        ("grade.g?in", "grade.gain", True), ("grade.gain", "grade.gain", True), ("grade.gain", "grade.Gain", False),
        ("*", "grade.gain", False), ("*", "knob", True), ("grade.[ab]", "grade.b", True),
        ("grade.[ab]", "grade.c", False),
    ],
)  # fmt: skip
def test_a_pattern_fits_part_by_part(pattern: str, name: str, fits: bool) -> None:
    assert ValuePattern(pattern).matches(name) is fits
    assert ValuePattern(pattern).is_exact is not any(sign in pattern for sign in "*?[")
