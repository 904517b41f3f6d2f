"""Constants of GLSL have the numbers that 32-bit integers and floats have, where the reader is sure of them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.glsl.constants import combine, construct, is_float_number, negate, read_number, wrap

EDGES = (0, 1, 2, 3, 7, 31, 1000, 65535, 2**30, 2**31 - 1)
"""Whole numbers that no sign changes: as int and as uint they are the same."""

ARITHMETIC = {"+": np.add, "-": np.subtract, "*": np.multiply}
POSITIVE = {"&": np.bitwise_and, "|": np.bitwise_or, "^": np.bitwise_xor}
COMPARED = {"<": np.less, ">": np.greater, "<=": np.less_equal, ">=": np.greater_equal, "==": np.equal,
            "!=": np.not_equal}  # fmt: skip


@pytest.mark.parametrize("sign", [*ARITHMETIC, *POSITIVE, *COMPARED])
def test_operators_of_whole_numbers_are_those_of_32_bits(sign: str) -> None:
    function = (ARITHMETIC | POSITIVE | COMPARED)[sign]
    for a in EDGES:
        for b in EDGES:
            with np.errstate(over="ignore"):
                expected = int(function(np.array([a], np.int32), np.array([b], np.int32))[0])
            assert combine(sign, a, b) == expected, (a, b)


def test_division_and_shifts_are_sure_where_both_signs_agree() -> None:
    for a in EDGES:
        for b in EDGES[1:]:
            assert (combine("/", a, b), combine("%", a, b)) == divmod(a, b)
        for b in (1, 4, 31):
            assert combine("<<", a, b) == int(np.left_shift(np.array([a], np.int32), np.int32(b))[0])
            assert combine(">>", a, b) == int(np.right_shift(np.array([a], np.int32), np.int32(b))[0])
        assert combine("<<", a, 32) is combine(">>", a, 32) is combine("/", a, 0) is combine("%", a, 0) is None
    for sign in ("/", "%", "<<", ">>", "&", "<", "=="):
        assert combine(sign, -1, 2) is combine(sign, 2, -1) is None  # 4294967295, where it has no sign
    assert combine("?", 1, 2) is None


def test_floats() -> None:
    assert [combine(sign, 1.5, 2) for sign in "+-*/"] == [3.5, -0.5, 3.0, 0.75]
    assert combine("/", 1.0, 0) is combine("%", 5.0, 2.0) is combine("*", 1e300, 1e300) is None
    assert combine("+", None, 1) is combine("+", 1, None) is None


def test_vectors_are_computed_part_by_part() -> None:
    assert combine("*", (1, 2, 3), (4, 5, 6)) == (4, 10, 18)
    assert combine("-", 10, (4, 5)) == (6, 5) and combine("-", (4, 5), 10) == (-6, -5)
    assert combine("/", (4, 5), (2, 0)) is combine("*", (4, 5), 0.5) is None


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("12", 12), ("12u", 12), ("0x1F", 31), ("0X1fU", 31), ("017", 15), ("0", 0), ("0u", 0), ("1.", 1.0),
        (".5", 0.5), ("2e3", 2000.0), ("2E-1", 0.2), ("3f", 3.0), ("1.5F", 1.5), ("2.5lf", 2.5), ("1e999", None),
        ("4294967295u", -1), ("2147483648u", -(2**31)), ("0xFFFFFFFE", -2), ("0xEF", 239),
    ],
)  # fmt: skip
def test_literals(text: str, number: float | None) -> None:
    assert (found := read_number(text)) == number and type(found) is type(number)
    assert is_float_number(text) is (number is None or isinstance(number, float))


def test_the_other_sign() -> None:
    for number in (*EDGES, -1, -(2**31)):
        with np.errstate(over="ignore"):
            assert negate(number) == int(-np.array([number], np.int32)[0])
    assert negate(0.5) == -0.5 and wrap(2**32 + 5) == 5 and wrap(-(2**31) - 1) == 2**31 - 1


@pytest.mark.parametrize(
    ("name", "numbers", "expected"),
    [
        ("float", (3,), 3.0), ("float", (1, 2), None), ("min", (3, 1.5, 2), 1.5), ("max", (3, 1.5, 2), 3),
        ("floor", (-1.5,), -2.0), ("ceil", (-1.5,), -1.0), ("floor", (1.5, 2.5), None), ("int", (2.75,), 2),
        ("int", (-2.75,), -2), ("uint", (7,), 7), ("int", (1, 2), None), ("ivec2", (4, 5), (4, 5)),
        ("ivec3", (4,), (4, 4, 4)), ("uvec4", (1, 2, 3, 4), (1, 2, 3, 4)), ("ivec3", (4, 5), None),
        ("ivec2", (1.0, 2.5), (1, 2)), ("vec2", (1, 2), None), ("int", (), None), ("int", (None,), None),
        ("ivec2", ((1, 2),), None), ("int", (2.0**24 + 0.5,), None), ("int", (2.0**24,), None),
        ("int", (2.0**24 - 1.0,), 2**24 - 1),
        ("int", (math.nextafter(3.0, 0.0),), None),  # 32 bits make 3 of it
        ("int", (2.998,), 2), ("int", (3.0005,), None), ("int", (-3.002,), -3),
    ],
)  # fmt: skip
def test_constructors_are_sure_where_rounding_cannot_matter(name: str, numbers: tuple, expected: object) -> None:
    assert (found := construct(name, numbers)) == expected and type(found) is type(expected)
