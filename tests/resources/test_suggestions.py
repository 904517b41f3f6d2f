"""Which names are near enough to an unknown one to be suggested."""

from __future__ import annotations

import pytest
from halation.resources.suggestions import find_near_names, measure_distance


@pytest.mark.parametrize(
    ("a", "b", "letters"),
    [
        ("", "abc", 3),
        ("kitten", "sitting", 3),  # the example of Levenshtein's distance in most textbooks
        ("saturday", "sunday", 3),
        ("shto", "shot", 1),  # neighbors that are swapped are one fault
        ("ca", "abc", 3),  # a pair that is swapped is not edited again, unlike in the unrestricted distance, 2
        ("exposure", "exposure", 0),
    ],
)
def test_the_distance_of_two_names(a: str, b: str, letters: int) -> None:
    assert measure_distance(a, b) == measure_distance(b, a) == letters


@pytest.mark.parametrize(
    ("name", "names", "near"),
    [
        ("water", ["wave", "paint"], []),
        ("gray", ["grade"], []),
        ("sepia", ["separate"], []),
        ("exposrue", ["exposure", "noise"], ["exposure"]),
        ("chroma", ["chroma_key", "aberration"], ["chroma_key"]),
        ("glow", ["aglow", "soft_glow"], ["aglow", "soft_glow"]),
        ("in", ["invert", "paint"], []),
        ("x", ["y"], []),
        ("blom", ["bloom", "blo", "blot"], ["bloom", "blo", "blot"]),
    ],
)
def test_only_near_names_are_suggested(name: str, names: list[str], near: list[str]) -> None:
    assert set(find_near_names(name, names, 3)) == set(near)
    assert find_near_names(name, names) == find_near_names(name, names, 3)[:1]
