"""Searching by a few letters finds what a person means, first."""

from __future__ import annotations

import pytest
from halation.editor.shared.fuzzy import Match, match, split_matched

NODES = (
    "Blend",
    "Bloom",
    "Box Blur",
    "Directional Blur",
    "Gaussian Blur",
    "Grade",
    "Luminance",
    "Premultiply",
    "RGB Curves",
    "Threshold",
    "Tone Map",
    "Unpremultiply",
)


def found(query: str, candidates: tuple[str, ...] = NODES) -> list[str]:
    return [candidates[one.index] for one in match(query, candidates)]


@pytest.mark.parametrize(
    ("query", "first"),
    [
        ("gb", "Gaussian Blur"),
        ("blur", "Box Blur"),
        ("bl", "Blend"),
        ("blo", "Bloom"),
        ("tm", "Tone Map"),
        ("lum", "Luminance"),
        ("premul", "Premultiply"),
        ("rgb", "RGB Curves"),
        ("blur gauss", "Gaussian Blur"),
        ("GRADE", "Grade"),
        ("hold", "Threshold"),
        ("up", "Unpremultiply"),
    ],
)
def test_the_wanted_one_is_first(query: str, first: str) -> None:
    assert found(query)[0] == first


def test_letters_must_be_there_in_order() -> None:
    assert found("xyz") == []
    assert found("mt", ("Tone Map",)) == []
    assert found("blur zoom") == []


def test_nothing_typed_keeps_everything_in_order() -> None:
    assert match("  ", NODES) == tuple(Match(index, 0.0, ()) for index in range(len(NODES)))


def test_equals_stay_in_order() -> None:
    assert [one.index for one in match("a", ("ab", "ac", "ad"))] == [0, 1, 2]


def test_whole_words_beat_scattered_letters() -> None:
    assert found("save", ("Select all values everywhere", "Save")) == ["Save", "Select all values everywhere"]
    assert found("blur", ("Blur Under Red", "Big long utter red"))[0] == "Blur Under Red"


def test_positions_are_the_letters() -> None:
    (one,) = match("gb", ("Gaussian Blur",))
    assert one.positions == (0, 9)
    assert list(split_matched("Gaussian Blur", one.positions)) == [
        ("G", True),
        ("aussian ", False),
        ("B", True),
        ("lur", False),
    ]


def test_letters_that_grow_in_lower_case_do_no_harm() -> None:
    (one,) = match("i", ("İi",))
    assert one.positions
