"""Expressions: their values, and what they refuse, at which character."""

from __future__ import annotations

import copy
import inspect
import math
import pickle
import sys
from random import Random

import numpy as np
import pytest
from expression_values import at, fault
from halation.errors import GraphError
from halation.graph.expressions import Expression, ExpressionError
from halation.graph.expressions.functions import FUNCTIONS
from halation.graph.expressions.noise import mix_bits
from halation.graph.expressions.parser import MAX_DEPTH
from halation.graph.expressions.tokens import MAX_LENGTH, write_name


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1", 1.0),
        (".5", 0.5),
        ("1.", 1.0),
        ("1e-3", 1e-3),
        ("-2^2", -4.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("-7 % 3", 2.0),
        ("1 < 2", True),
        ("not 1 == 2", True),
        ("!1 == 2", False),
        ("true and not false", True),
        ("on", True),
        ("-on", -1.0),
        ("0 ? 1 : 2 ? 3 : 4", 3.0),
        ("frame > 3 ? glow : 1/0", 2.0),
        ("0 && 1/0", False),
        ("1 || 1/0", True),
        ("[1, 2, 3] * glow", (2.0, 4.0, 6.0)),
        ("move.offset - [1, 1, 1]", (0.0, 1.0, 2.0)),
        ("-[1, 2]", (-1.0, -2.0)),
        ("move.offset.x", 1.0),
        ("(move.offset).b", 3.0),
        ("[4, 5].g", 5.0),
        ("mix([0, 0], [2, 4], .5).y", 2.0),
        ("max([1, 5], [4, 2], 3)", (4.0, 5.0)),
        ("[true, 2]", (1.0, 2.0)),
        ("`my node`.x", 7.0),
        ("`frame`", 99.0),
        ("frame", 5.0),
        ("time * rate", 4.0),
        ("round(2.5) + round(-0.5)", 2.0),
        ("smoothstep(0, 2, 1)", 0.5),
        ("smoothstep(1, 1, 1)", 1.0),
        ("fit(3, 2, 4, 10, 20)", 15.0),
        ("fit(9, 2, 4, 10, 20)", 20.0),
        ("fit(2, 2, 2, 1, 5)", 5.0),
        ("pulse(5, 5, 6)", 1.0),
        ("pulse(6, 5, 6)", 0.0),
        ("clamp(7, 1, 3)", 3.0),
        ("e", math.e),
        ("count\n+\t1", 4.0),
        ("1" + "+1" * 499, 500.0),
    ],
)
def test_values(text: str, expected: object) -> None:
    found = at(text)
    assert found == pytest.approx(expected) and type(found) is type(expected)


@pytest.mark.parametrize(
    ("text", "position", "sentence"),
    [
        ("", 0, "empty"),
        ("  ", 0, "empty"),
        ("1 +", 3, "ends too early"),
        ("2pi", 1, "an operator is missing before 'pi'"),
        ("1 + sinn(3)", 4, "no function 'sinn'; did you mean 'sin'"),
        ("clamp(1, 2)", 0, "clamp(x, low, high)"),
        ("sin()", 0, "does not take 0"),
        ("(1 + 2", 0, "'(' is never closed"),
        ("1)", 1, "has no opening bracket"),
        ("[1, 2", 0, "'[' is never closed"),
        ("(1]", 2, "has no opening bracket"),
        ("[]", 0, "at least one"),
        ("1 = 2", 2, "=="),
        ("[1, [2]]", 0, "a list holds numbers"),
        ("'a'", 0, "cannot hold text"),
        ("1 if 2 else 3", 2, "? yes : no"),
        ("1 ? 2", 5, "':' is missing"),
        ("1 < 2 < 3", 6, "only two numbers"),
        ("1e999", 0, "too large"),
        ("1 , 2", 2, "','"),
        ("`a", 0, "closing backquote"),
        ("2 ÷ 3", 2, "'÷'"),
        ("1\x00", 1, "U+0000"),
        ("(glow).q", 7, "channel is missing"),
        ("* 2", 0, "value is missing before '*'"),
        ("1 + )", 4, "value is missing before ')'"),
        ("x²", 0, "'x²'"),
        ("glow.__class__", 0, "no control"),
        ("().x", 1, "value is missing"),
        ("lambda: 1", 6, "':' does not belong"),
        ("1 / (frame - 5)", 2, "division by zero: 1 / 0"),
        ("7 % 0", 2, "division by zero: 7 % 0"),
        ("2 + log(0-3)", 4, "log(-3)"),
        ("sqrt(0-4)", 0, "sqrt(-4) has no value"),
        ("asin(2)", 0, "asin(2)"),
        ("(0-8)^0.5", 5, "-8 ^ 0.5 has no value"),
        ("0^-1", 1, "0 ^ -1"),
        ("exp(1000)", 0, "exp(1000) is too large"),
        ("1e300 * 1e300", 6, "1e+300 * 1e+300 is too large"),
        ("9^9^9", 1, "too large"),
        ("[1, 0] + 1 / [1, 0]", 11, "1 / 0"),
        ("[1, 2] + [1, 2, 3]", 7, "cannot be combined"),
        ("glow + nope", 7, "no control 'nope'"),
        ("name + 1", 0, "text"),
        ("bad", 0, "not finite"),
        ("huge", 0, "not finite"),
        ("move.offset ? 1 : 2", 12, "neither true nor false"),
        ("move.offset > 1", 12, "cannot be compared"),
        ("(glow).x", 7, "a number has no channel"),
        ("[1, 2].z", 7, "a list of 2"),
    ],
)
def test_faults_point_at_the_character(text: str, position: int, sentence: str) -> None:
    error = fault(text)
    assert error.position == position and sentence in error.sentence, error
    if text.strip():
        line, caret = str(error).splitlines()[-2:]
        assert caret.index("^") == 4 + position and text.replace("\x00", " ") in line


def test_a_message_is_readable() -> None:
    assert str(fault("1 + sinn(3)")) == ("there is no function 'sinn'; did you mean 'sin'?\n    1 + sinn(3)\n        ^")
    assert str(fault("glow +\n  nope * 2")).endswith("\n      nope * 2\n      ^")
    assert str(fault("`日本` + 1")).endswith("\n    `日本` + 1\n    ^")
    assert str(fault("glow + 1/0*`日本`")).splitlines()[-1].index("^") == 12
    assert str(fault("[`日本`=2")).splitlines()[-1].index("^") == 11
    shown = str(fault("glow + " * 100 + "nope" + " + glow" * 20)).splitlines()[1:]
    assert all(len(line) < 70 for line in shown) and shown[0][shown[1].index("^") :].startswith("nope + glow")
    assert "…" in shown[0]


def test_a_fault_of_another_expression_is_passed_on() -> None:
    def other(name: str) -> float:
        raise ExpressionError("1/0", 1, "a division by zero: 1 / 0")

    with pytest.raises(ExpressionError) as found:
        Expression("2 + glow").evaluate(1, 0, 24, other)
    assert found.value.text == "1/0"
    assert isinstance(found.value, GraphError)
    blamed = Expression("2 + glow").blame_name("glow", "no")
    assert (blamed.position, blamed.sentence) == (4, "no")


def test_lengths_and_depths_are_limited() -> None:
    assert "longer than" in fault("1" * (MAX_LENGTH + 1)).sentence
    assert "deep" in fault("(" * 400 + "1" + ")" * 400).sentence
    for text in (
        "-" * 900 + "1",
        "2^" * 400 + "1",
        "1?" * 200 + "1" + ":1" * 200,
        "!" * 900,
        "[" * 900,
        "not " * 200 + "1",
        "sin(" * 200 + "1" + ")" * 200,
        "1 or 1 and 1 < 1 + 1 * (" * 40,
        "(" * 1000,
    ):
        assert Expression(text).fault is not None, text
    deep = "(" * (MAX_DEPTH - 2) + "glow" + ")" * (MAX_DEPTH - 2)
    assert at(deep) == 2.0
    for word in ("1", "pi", "frame", "glow", "`s`"):  # each is one level
        for count, is_fine in ((MAX_DEPTH - 1, True), (MAX_DEPTH, False)):
            assert (Expression("-" * count + word).fault is None) is is_fine
    nest = "1 or x and 1 < 1 + 2 * -("
    count = MAX_DEPTH // 7
    assert Expression(nest * count + "1" + ")" * count).fault is None
    assert Expression("1" + "+ glow" * 10**6).names == ()


def test_reading_and_computing_take_few_calls() -> None:
    """The deepest texts do with 500 calls on the stack."""
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(len(inspect.stack(0)) + 500)
    try:
        for part in ("(", "sin(", "1 or 0 and 1 < 1 + 2 * -(", "[1].x + 2 ^ -(", "-", "2 ^ ", "0 ? 2 : ", "(2 - "):
            texts = [part * count + "0" + ")" * (part.count("(") * count) for count in range(1, 80)]
            read = [text for text in texts if Expression(text).fault is None]
            assert 0 < len(read) < 79
            for text in read:
                assert part == "2 ^ " or math.isfinite(at(text))
        assert Expression("[" * 70).fault
    finally:
        sys.setrecursionlimit(limit)


def test_names_and_renaming() -> None:
    text = " sin( bloom.intensity )+glow *bloom.intensity - sin(glow)+`my node`.x + frame + `frame`"
    expression = Expression(text)
    assert expression.names == ("bloom.intensity", "glow", "my node.x", "frame")
    assert expression.rename("bloom", "haze").text == text.replace("bloom", "haze")
    assert expression.rename("glow", "my glow").text == text.replace("glow", "`my glow`")
    assert expression.rename("sin", "x") == expression
    assert expression.rename("my node", "n").text == text.replace("`my node`", "n")
    assert expression.rename("frame", "f").text == text.replace("`frame`", "f")
    assert expression.rename("glow", "time").text == text.replace("glow", "`time`")
    assert expression.rename("bloom.intensity", "a.b").text == text.replace("bloom.intensity", "a.b")
    assert Expression("blo.x + bloom.x + (1 + bloom").rename("bloom", "y").text == "blo.x + y.x + (1 + y"
    for name in ("a b", "a`b", "frame", "2d", "x.and", "日本", "pi.x", "a-b.c d"):
        assert Expression(f"1 + {write_name(name)} * 2").names == (name,)
        assert Expression("1 + old").rename("old", name).names == (name,)


def test_tokens_cover_the_text() -> None:
    text = "not sin(frame) + 1.5e3 * [pi, glow.x] ? 1 : $ 2"
    kinds = [(token.kind, token.text) for token in Expression(text).tokens]
    assert kinds[:8] == [
        ("word", "not"),
        ("function", "sin"),
        ("bracket", "("),
        ("variable", "frame"),
        ("bracket", ")"),
        ("operator", "+"),
        ("number", "1.5e3"),
        ("operator", "*"),
    ]
    assert ("constant", "pi") in kinds and ("name", "glow.x") in kinds and ("unknown", "$") in kinds
    rng = Random(8)
    for _ in range(500):
        text = "".join(rng.choice("ab .`1e+(日²\n$=*") for _ in range(30))
        found = Expression(text).tokens
        assert all(text[token.start : token.end] == token.text for token in found)
        assert "".join(token.text for token in found) == "".join(text.split()) or "`" in text


def test_expressions_can_be_copied_and_sent() -> None:
    for text in ("glow * 2", "1 +"):
        expression = Expression(text)
        assert expression.fault is None or expression.fault.position == 3
        assert pickle.loads(pickle.dumps(expression)) == copy.deepcopy(expression) == expression
    error = pickle.loads(pickle.dumps(fault("1 +")))
    assert (error.text, error.position, error.exit_code) == ("1 +", 3, 3)


def test_noise_and_random() -> None:
    found = np.array([at("random(frame)", frame) for frame in range(-2000, 2000)])
    assert found.min() >= 0.0 and found.max() < 1.0 and len(set(found)) == 4000
    assert abs(found.mean() - 0.5) < 0.02 and abs(found.var() - 1 / 12) < 0.005
    assert abs(np.corrcoef(found[1:], found[:-1])[0, 1]) < 0.05
    assert at("random(3.7)") == at("random(3)") != at("random(3, 1)")
    smooth = np.array([at("noise(frame / 64)", frame) for frame in range(64 * 400)])
    assert -1.0 <= smooth.min() < -0.9 and 0.9 < smooth.max() <= 1.0 and abs(smooth.mean()) < 0.05
    assert np.abs(np.diff(smooth)).max() < 2 * 1.875 / 64 * 1.01
    assert np.abs(np.diff(smooth, 2)).max() < 2 * 5.78 / 64**2 * 1.05
    assert at("noise(3)") == pytest.approx(2 * at("random(3)") - 1)
    assert (at("random(1)"), at("noise(0.5, 7)")) == (0.7012121095215252, 0.3098553873426486)


def test_the_hash_is_splitmix64() -> None:
    """The first numbers of the generator of Steele, Lea and Flood (2014) from the seed 1234567, as published."""
    step = 0x9E3779B97F4A7C15
    assert [mix_bits(1234567 + count * step) for count in (1, 2, 3)] == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
    ]


def test_functions_are_documented() -> None:
    assert all(name == item.name and item.doc and min(item.counts) >= 1 for name, item in FUNCTIONS.items())
