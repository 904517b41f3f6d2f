"""Random expressions: those that are right against Python's own arithmetic, and damaged ones."""

from __future__ import annotations

import math
import time
from random import Random

import numpy as np
import pytest
from expression_values import at
from halation.graph.expressions import Expression, ExpressionError
from halation.graph.expressions.tokens import MAX_LENGTH

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
        start = time.thread_time()
        try:
            found = at(text, rng.choice((0.0, -3.5, 1e15, 1e300)))
            good += 1
            assert all(math.isfinite(part) for part in (found if isinstance(found, tuple) else (found,)))
        except ExpressionError as error:
            assert 0 <= error.position <= len(text) and error.sentence
        Expression(text).rename("glow", "x y")
        slowest = max(slowest, time.thread_time() - start)
    assert good > 500 and slowest < 1.0
