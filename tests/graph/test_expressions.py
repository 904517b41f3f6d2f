"""Expressions: against Python's own arithmetic, and what they refuse, at which character."""

from __future__ import annotations

import copy
import inspect
import math
import pickle
import sys
import time
from random import Random

import numpy as np
import pytest
from halation.errors import GraphError
from halation.graph.expressions import Expression, ExpressionError
from halation.graph.expressions.functions import FUNCTIONS
from halation.graph.expressions.noise import mixed
from halation.graph.expressions.parser import MAX_DEPTH, MAX_LENGTH
from halation.graph.expressions.tokens import written

VALUES = {
    "glow": 2.0,
    "count": 3,
    "on": True,
    "bloom.intensity": 0.25,
    "move.offset": (1.0, 2.0, 3.0),
    "my node.x": 7.0,
    "frame": 99.0,
    "move.offset.x": 1.0,
    "name": "text",
    "bad": math.inf,
    "huge": 10**400,
}


def value(name: str):
    if name not in VALUES:
        raise GraphError(f"there is no control '{name}'")
    return VALUES[name]


def at(text: str, frame: float = 5.0):
    return Expression(text).at(frame, (frame - 1.0) / 24.0, 24.0, value)


def fault(text: str) -> ExpressionError:
    with pytest.raises(ExpressionError) as found:
        at(text)
    return found.value


REFERENCE = {
    **{
        name: getattr(math, name)
        for name in (
            "sin",
            "cos",
            "tan",
            "asin",
            "acos",
            "atan",
            "atan2",
            "degrees",
            "radians",
            "sqrt",
            "exp",
            "log",
            "log2",
            "pow",
        )
    },
    "abs": abs,
    "floor": math.floor,
    "ceil": math.ceil,
    "min": min,
    "max": max,
    "mod": lambda x, y: x % y,
    "sign": lambda x: float(np.sign(float(x))),
    "round": lambda x: math.copysign(math.floor(abs(x) + 0.5), x),
    "fract": lambda x: x - math.floor(x),
    "mix": lambda a, b, t: a * (1 - t) + b * t,
    "clamp": lambda x, low=0.0, high=1.0: min(max(x, low), high),
    "step": lambda edge, x: float(x >= edge),
    "fit": lambda x, low, high, a, b: float(np.interp(x, [low, high], [a, b])),
    "glow": 2.0,
    "count": 3.0,
    "frame": 5.0,
    "time": 4.0 / 24.0,
    "rate": 24.0,
    "pi": math.pi,
    "tau": math.tau,
}
ARITY = {"atan2": 2, "pow": 2, "mod": 2, "step": 2, "mix": 3}
LEVELS = (
    {"||": "or", "or": "or"},
    {"&&": "and", "and": "and"},
    {c: c for c in ("<", "<=", ">", ">=", "==", "!=")},
    {"+": "+", "-": "-"},
    {"*": "*", "/": "/", "%": "%"},
)


def made(rng: Random, level: int, depth: int) -> tuple[str, str]:
    """An expression of at least that level as ours, with few parentheses, and as Python, with all of them."""
    if depth <= 0 or level > 7:
        return leaf(rng) if depth <= 0 or rng.random() < 0.3 else bracketed(rng, depth)
    here = rng.randint(level, 8)
    space = rng.choice(("", " ", "  "))
    if here == 0:
        (c, python_c), (a, python_a), (b, python_b) = (made(rng, level, depth - 1) for level in (1, 0, 0))
        return f"{c} ? {a} :{space}{b}", f"({python_a} if {python_c} else {python_b})"
    if here <= 5:
        ours, theirs = rng.choice(list(LEVELS[here - 1].items()))
        a, python_a = made(rng, here + (here == 3), depth - 1)
        b, python_b = made(rng, here + 1, depth - 1)
        space = space or (" " if ours.isalpha() else "")
        python = f"({python_a} {theirs} {python_b})"
        return f"{a}{space}{ours}{space}{b}", f"bool{python}" if here <= 2 else python
    a, python_a = made(rng, 6, depth - 1)
    if here == 6:
        sign = rng.choice("-+!")
        return f"{sign}{space}{a}", f"(not {python_a})" if sign == "!" else f"({sign}float({python_a}))"
    if here == 7:
        b, python_b = bracketed(rng, depth) if rng.random() < 0.5 else leaf(rng)
        return f"{b}{space}{rng.choice(('^', '**'))} {a}", f"pow({python_b}, {python_a})"
    return bracketed(rng, depth)


def leaf(rng: Random) -> tuple[str, str]:
    if rng.random() < 0.4:
        return (rng.choice(("glow", "count", "frame", "time", "rate", "pi", "tau")),) * 2
    number = rng.choice((rng.randint(0, 4), round(rng.uniform(0, 9), 2), 1e-3, 0.5))
    return rng.choice((".5", "0.5", "5e-1")) if number == 0.5 else str(number), repr(float(number))


def bracketed(rng: Random, depth: int) -> tuple[str, str]:
    name = rng.choice(("", *REFERENCE)[: len(REFERENCE) - 6])
    if name in ("glow", "fit", ""):
        ours, theirs = made(rng, 0, depth - 1)
        return f"({ours})", f"({theirs})"
    count = {"clamp": rng.choice((1, 3)), "min": rng.randint(2, 4), "max": rng.randint(2, 4), **ARITY}.get(name, 1)
    parts = [made(rng, 0, depth - 1) for _ in range(count)]
    return f"{name}({', '.join(a for a, _ in parts)})", f"{name}({', '.join(b for _, b in parts)})"


def python(text: str):
    """What Python makes of a text, or None where it has no finite value."""
    try:
        found = float(eval(text, dict(REFERENCE)))
    except (ArithmeticError, ValueError, TypeError):
        return None
    return found if math.isfinite(found) else None


def test_random_expressions_against_python() -> None:
    rng, none = Random(1), 0
    for _ in range(6000):
        ours, theirs = made(rng, 0, rng.randint(1, 5))
        if len(ours) > MAX_LENGTH:
            continue
        expected = python(theirs)
        try:
            assert float(at(ours)) == pytest.approx(expected, rel=1e-12, abs=1e-300), ours
        except ExpressionError as error:
            none += 1
            assert expected is None or "too large" in error.sentence, f"{ours}\n{theirs}\n{error}"
    assert 100 < none < 3000


def test_precedence_of_arithmetic_is_that_of_python() -> None:
    rng = Random(2)
    for _ in range(3000):
        words = [rng.choice(("", "-", "+", "- -")) + f"{rng.randint(1, 5)}.0"]
        for _ in range(rng.randint(1, 7)):
            words += [rng.choice(("+", "-", "*", "/", "%", "**")), rng.choice(("", "-")) + f"{rng.randint(1, 3)}.0"]
        text = " ".join(words)
        expected = python(text)
        if expected is not None and abs(expected) < 1e200:
            assert at(text) == pytest.approx(expected, rel=1e-12), text


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
        ("1)", 1, "closes nothing"),
        ("[1, 2", 0, "'[' is never closed"),
        ("(1]", 2, "closes nothing"),
        ("[]", 0, "at least one"),
        ("1 = 2", 2, "=="),
        ("[1, [2]]", 0, "a list holds numbers"),
        ("'a'", 0, "no text"),
        ("1 if 2 else 3", 2, "? yes : no"),
        ("1 ? 2", 5, "':' is missing"),
        ("1 < 2 < 3", 6, "only two numbers"),
        ("1e999", 0, "too large"),
        ("1 , 2", 2, "','"),
        ("`a", 0, "no end"),
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
        ("[1, 2] + [1, 2, 3]", 7, "do not go together"),
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
        Expression("2 + glow").at(1, 0, 24, other)
    assert found.value.text == "1/0"
    assert isinstance(found.value, GraphError)
    blamed = Expression("2 + glow").blamed("glow", "no")
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
    assert expression.renamed("bloom", "haze").text == text.replace("bloom", "haze")
    assert expression.renamed("glow", "my glow").text == text.replace("glow", "`my glow`")
    assert expression.renamed("sin", "x") == expression
    assert expression.renamed("my node", "n").text == text.replace("`my node`", "n")
    assert expression.renamed("frame", "f").text == text.replace("`frame`", "f")
    assert expression.renamed("glow", "time").text == text.replace("glow", "`time`")
    assert expression.renamed("bloom.intensity", "a.b").text == text.replace("bloom.intensity", "a.b")
    assert Expression("blo.x + bloom.x + (1 + bloom").renamed("bloom", "y").text == "blo.x + y.x + (1 + y"
    for name in ("a b", "a`b", "frame", "2d", "x.and", "日本", "pi.x", "a-b.c d"):
        assert Expression(f"1 + {written(name)} * 2").names == (name,)
        assert Expression("1 + old").renamed("old", name).names == (name,)


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
    assert [mixed(1234567 + count * step) for count in (1, 2, 3)] == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
    ]


def test_functions_are_documented() -> None:
    assert all(name == item.name and item.doc and min(item.counts) >= 1 for name, item in FUNCTIONS.items())


PIECES = (
    *"0123456789.eE+-*/%^<>=!?:()[],`'\"\\ \n\t_&|#@;{}~$",
    "**",
    "&&",
    "||",
    "==",
    "1e308",
    "1e-308",
    "frame",
    "glow",
    "and ",
    " or ",
    "not ",
    "if ",
    "else ",
    "move.offset",
    ".x",
    "sin(",
    "pow(",
    "noise(",
    "random(",
    "log(",
    "floor(",
    "__import__",
    "lambda ",
    "\x00",
    "\ud800",
    "\u202e",
    "²",
    "٣",
    "日",
    "e\u0301",
    "😀",
    "9" * 30,
    "clamp(",
    "mix(",
    "min(",
    "exp(",
)


SEEDS = (
    "clamp(sin(time * tau) * glow, 0, 1) ? move.offset : [1, 2, 3]",
    "mix(1, 2, fract(noise(frame) ^ 2)) % 3",
    "frame < 10 and not on ? 1 / count : -bloom.intensity ** 2",
    "2 + 3 * 4",
)


def mutated(rng: Random, text: str) -> str:
    letters = list(text)
    for _ in range(rng.randint(1, 3)):
        place = rng.randrange(len(letters))
        letters[place : place + rng.randint(0, 2)] = rng.choice(PIECES)
    return "".join(letters)


def test_nothing_else_is_ever_raised() -> None:
    rng, good, slowest = Random(3), 0, 0.0
    for _ in range(20_000):
        if rng.random() < 0.5:
            text = mutated(rng, rng.choice(SEEDS))
        else:
            text = "".join(rng.choice(PIECES) for _ in range(rng.randint(0, rng.choice((4, 12, 300)))))
        start = time.perf_counter()
        try:
            found = at(text, rng.choice((0.0, -3.5, 1e15, 1e300)))
            good += 1
            assert all(math.isfinite(part) for part in (found if isinstance(found, tuple) else (found,)))
        except ExpressionError as error:
            assert 0 <= error.position <= len(text) and error.sentence
        Expression(text).renamed("glow", "x y")
        slowest = max(slowest, time.perf_counter() - start)
    assert good > 500 and slowest < 1.0
