"""Lists of names of a cryptomatte: what they pick, and what a click makes of them."""

from __future__ import annotations

from random import Random

import pytest
from halation.nodes import Matte, float_bits, format_names, matte_of, murmur3, pick_ids, pick_names, toggle_name

NAMES = ("monkey", "ring_blue", "ring_pink", "a, b", 'say "hi"', "-minus", "x*", "[y]", " blank ", "Ärger", "two words")
MANIFEST = {name: murmur3(name.encode()) for name in NAMES}


@pytest.mark.parametrize("name", NAMES)
def test_every_name_can_be_listed(name):
    assert pick_names(format_names([name]), MANIFEST) == {name}
    assert pick_names(format_names(["*", f"-{name}"]), MANIFEST) == set(NAMES) - {name}


@pytest.mark.parametrize(
    ("pick", "name", "wanted"),
    [
        ("*", "monkey", "monkey"),
        ("", "monkey", "monkey"),
        ("monkey", "ring_blue", "monkey, ring_blue"),
        ("monkey, ring_blue", "monkey", "ring_blue"),
        ("monkey", "monkey", ""),
        ("ring_*", "ring_blue", "ring_*, -ring_blue"),
        ("ring_*, -ring_blue", "ring_blue", "ring_*"),
        ("*, -monkey", "monkey", "*"),
        ("monkey", "a, b", 'monkey, "a, b"'),
        ('"a, b", monkey', "a, b", "monkey"),
        ("monkey\nring_blue", "ring_pink", "monkey, ring_blue, ring_pink"),
        (" monkey ,, ring_blue ", "monkey", "ring_blue"),
        ("elsewhere", "monkey", "elsewhere, monkey"),
    ],
)
def test_a_click_changes_one_name(pick, name, wanted):
    assert toggle_name(pick, name, MANIFEST) == wanted


def test_whatever_was_typed_a_click_changes_that_name_alone():
    random = Random(5)
    entries = [*map(str, NAMES), "ring_*", "?onkey", "-ring_*", "-monkey", "*", "-*", "nobody", "[xy]*"]
    for _ in range(2000):
        pick = format_names(random.choices(entries, k=random.randint(0, 5)))
        name = random.choice(NAMES)
        before, after = pick_names(pick, MANIFEST), pick_names(toggle_name(pick, name, MANIFEST), MANIFEST)
        assert after == ({name} if pick == "*" else before ^ {name}), (pick, name)


def test_a_name_that_is_not_in_the_manifest_is_hashed():
    assert pick_ids("first, monkey", {}) == {float_bits(murmur3(b"first")), float_bits(murmur3(b"monkey"))}


def test_which_cryptomatte_is_meant():
    made = [Matte("object", ("a00",), {}), Matte("", ("b00",), {})]
    assert matte_of(made, "object") is made[0] and matte_of(made, "material") is made[1]
    assert matte_of([*made, Matte("", ("c00",), {})], "material") is None and matte_of([], "object") is None
