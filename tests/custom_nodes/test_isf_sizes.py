"""Formulas of sizes against Python's own arithmetic, which never sees them: both are made from the same tree."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import pytest
from halation.custom_nodes.isf.sizes import MAX_DEPTH, SizeError, read_size
from hypothesis import assume, given
from hypothesis import strategies as some

VALUES = {"WIDTH": 1920.0, "HEIGHT": 1080.0, "k": 0.375}


@dataclass(frozen=True)
class Tree:
    """A formula as text, and what Python makes of it."""

    text: str
    value: float


def joined(pair: tuple[Tree, str, Tree]) -> Tree:
    left, sign, right = pair
    calls = {"+": left.value.__add__, "-": left.value.__sub__, "*": left.value.__mul__}
    if sign == "/":
        return Tree(f"({left.text})/({right.text})", left.value / right.value if right.value else math.nan)
    return Tree(f"({left.text}) {sign} ({right.text})", calls[sign](right.value))


def called(pair: tuple[str, Tree, Tree]) -> Tree:
    name, a, b = pair
    if name in ("min", "max"):
        return Tree(f"{name}({a.text}, {b.text})", {"min": min, "max": max}[name](a.value, b.value))
    call = {"floor": math.floor, "ceil": math.ceil, "abs": abs}[name]
    return Tree(f"{name}({a.text})", float(call(a.value)) if math.isfinite(a.value) else math.nan)


LEAVES = some.one_of(
    some.floats(0.001, 1e4).map(lambda x: Tree(repr(x), x)),
    some.integers(0, 5000).map(lambda x: Tree(str(x), float(x))),
    some.sampled_from(sorted(VALUES)).map(lambda name: Tree(f"${name}", VALUES[name])),
)
TREES = some.recursive(
    LEAVES,
    lambda inner: some.one_of(
        some.tuples(inner, some.sampled_from("+-*/"), inner).map(joined),
        some.tuples(some.sampled_from(["min", "max", "floor", "ceil", "abs"]), inner, inner).map(called),
        inner.map(lambda tree: Tree(f"-({tree.text})", -tree.value)),
    ),
    max_leaves=12,
)


@given(TREES)
def test_formulas_agree_with_python(tree: Tree) -> None:
    assume(math.isfinite(tree.value))
    exact = max(1.0, tree.value)
    whole = round(exact)
    assume(abs(exact - whole) > 1e-6 * exact or exact == whole)
    assert read_size(tree.text).pixels(VALUES) == max(1, math.floor(exact))


@pytest.mark.parametrize(
    ("text", "pixels"),
    [
        ("1", 1),
        ("512", 512),
        ("$WIDTH", 1920),
        ("$HEIGHT/16.0", 67),
        ("floor($WIDTH/4.0)", 480),
        (" $WIDTH / 100.0 ", 19),
        ("max(floor($WIDTH*0.02),1.0)", 38),
        ("floor($HEIGHT*min((0.3),1.0))", 324),
        ("max(8.0,floor($WIDTH*$k))", 720),
        ("2+3*4", 14),
        ("20-5-4", 11),
        ("64/4/2", 8),
        ("2^3^2", 512),
        ("-2^2 + 10", 6),
        ("- - 3", 3),
        ("7%4", 3),
        ("-5", 1),
        ("clamp(2, $WIDTH, 8)", 8),
        ("mod(9, 5) + pow(2, 3) + round(2.5)", 15),
        ("$WIDTH*0.1", 192),
        ("1e2", 100),
    ],
)
def test_formulas(text: str, pixels: int) -> None:
    assert read_size(text).pixels(VALUES) == pixels


@given(some.integers(1, 10**7), some.integers(0, 4), some.integers(1, 10**6), some.integers(-3, 3))
def test_lengths_that_are_whole_are_not_cut(digits: int, places: int, factor: int, nudge: int) -> None:
    """The product of decimals, as fractions have it: doubles that come out just below it mean the same length.

    A thousandth of a pixel below is one pixel less.
    """
    decimal = f"{digits / 10**places:.{places}f}"
    exact = Fraction(digits, 10**places) * factor + Fraction(nudge, 1000)
    assume(exact < 10**5)
    text = f"{decimal} * {factor} + {nudge} / 1000" if nudge >= 0 else f"{decimal} * {factor} - {-nudge} / 1000"
    assert read_size(text).pixels(VALUES) == max(1, math.floor(exact))


@pytest.mark.parametrize("length", [2, 3, 100, 1920, 10**6, 10**8])
def test_a_length_is_whole_within_a_part_of_itself(length: int) -> None:
    """What is wrong grows with the length, and so does what is forgiven: a billionth of it."""
    half, twice = (f"{length} - {length} * {part!r}" for part in (0.5e-9, 2.5e-9))
    assert read_size(half).pixels(VALUES) == length and read_size(twice).pixels(VALUES) == length - 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "ends too early"),
        ("1 +", "ends too early"),
        ("(1", "missing"),
        ("1)", "not expected"),
        ("2 3", "not expected"),
        ("min(1,", "ends too early"),
        ("floor(1, 2)", "takes 1 numbers, not 2"),
        ("__import__('os')", "no function"),
        ("$WIDTH; 1", "not expected"),
        ("1 = 1", "not expected"),
        ("sqrt()", "not expected"),
        ("min()", "not expected"),
        ("(" * (MAX_DEPTH + 1) + "1" + ")" * (MAX_DEPTH + 1), "nests deeper"),
        ("2" + "^2" * 200, "nests deeper"),
        ("1+" * 600 + "1", "more than 1000"),
        ("9" * 400 + "^9", "has no value|not finite"),
    ],
)
def test_what_is_no_formula(text: str, said: str) -> None:
    with pytest.raises(SizeError, match=said):
        read_size(text).pixels(VALUES)


@given(some.text(alphabet="$WIDTHk0123456789.+-*/%^(), minaxflor\n\x00é", max_size=60))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        formula = read_size(text)
        if formula.names <= VALUES.keys():
            assert formula.pixels(VALUES) >= 1
    except SizeError as fault:
        assert str(fault)
