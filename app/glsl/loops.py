"""Loops that might not end, found in the text of a shader and given an end: a loop that goes on for ever hangs the GPU.

A loop is left as it is where its text says how often it runs. All others count their rounds together in one variable,
and are left when there are too many: loops inside loops end too, and so do those of functions that loops call.
"""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType

from msgspec import Struct

from .text import blank_comments

COUNTER = "halation_rounds"
"""The variable that counts: `lib/rounds.glsl` declares it."""

MOST_ROUNDS = 60_000
"""Rounds that all counted loops may make for a pixel, together. Mesa's rasterizer leaves any loop after 65535."""

MOST_STATED = 1 << 20
"""Rounds up to which a loop, with the loops around it, is believed that says how many it makes. A choice: a pixel with
a million rounds takes milliseconds."""

_LOOP = re.compile(r"\b(for|while|do)\b")
_DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)
_NAMED = re.compile(
    r"^[ \t]*#[ \t]*define[ \t]+(\w+)[ \t]+([^\n]+)$|\bconst\s+(?:int|uint|float)\s+(\w+)\s*=\s*([^;,]+);", re.MULTILINE
)
_VARIABLE = re.compile(r"(?<!const )\b(?:int|uint|float)\s+(\w+)")
_BEGIN = re.compile(r"\s*(int|uint|float)\s+(\w+)\s*=\s*([^,;]+)")
_TEST = re.compile(r"\s*(\w+)\s*(<=|>=|<|>|!=)\s*([^|?]+)")
_STEP = re.compile(r"\s*(?:(\+\+|--)\s*(\w+)|(\w+)\s*(\+\+|--)|(\w+)\s*(\+=|-=)\s*([^,]+))\s*")
_NUMBER = re.compile(r"(?<![\w.])((?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)[uUfF]?(?![\w.])")
_OPERATORS: Mapping[type[ast.operator], Callable[[float, float], float]] = MappingProxyType(
    {
        ast.Add: operator.add,
        ast.Sub: operator.sub,
        ast.Mult: operator.mul,
        ast.Div: lambda a, b: int(a / b) if isinstance(a, int) and isinstance(b, int) else a / b,
    }
)
_STILL = 1e-6
"""Of a float, a part that adding may leave as it is."""


class _Loop(Struct, frozen=True):
    """Where a loop's body is: from `start` to `end`, without its braces if it has some; how often it runs, if known."""

    start: int
    end: int
    braced: bool
    rounds: float | None


class _Broken(Exception):
    """The braces or brackets do not close: what is to be done with it is up to the driver."""


def guard_loops(source: str, most: int = MOST_ROUNDS) -> str:
    """The text with loops that might not end leaving when they have made more than `most` rounds.

    Lines stay where they are, comments go. The same text without comments if all loops surely end.
    """
    code = blank_comments(source)
    plain = _DIRECTIVE.sub(_mask, code)
    try:
        loops = tuple(_loops(plain, _constants(code), 0, len(plain), 1.0))
    except (_Broken, RecursionError):
        return code
    check = f"if (++{COUNTER} > {most}) break; "
    marks: dict[int, str] = {}
    for loop in loops:
        if loop.rounds is None:
            marks[loop.start] = marks.get(loop.start, "") + (" " if loop.braced else "{ ") + check
            if not loop.braced:
                marks[loop.end] = " }" + marks.get(loop.end, "")
    parts, at = list[str](), 0
    for place in sorted(marks):
        parts += [code[at:place], marks[place]]
        at = place
    return "".join([*parts, code[at:]])


def _loops(code: str, constants: Mapping[str, float], start: int, end: int, outer: float) -> Iterator[_Loop]:
    """The loops between two places, those inside of others after them. `outer` rounds are made around them.

    A loop is read without its grammar: a header in brackets, then a block or a statement. Its stated number of rounds
    only counts if it is small, by itself and with the loops around it: a loop of 2000 rounds in another of 2000 is
    counted.
    """
    at = start
    while match := _LOOP.search(code, at, end):
        header = ""
        after = match.end()
        if match[1] != "do":
            opened = code.find("(", after)
            if opened < 0 or code[after:opened].strip():
                raise _Broken
            after = _find_closing(code, opened)
            header = code[opened + 1 : after - 1]
        first = _skip(code, after)
        braced = code[first : first + 1] == "{"
        last = _statement(code, first)
        inner = (first + 1, last - 1) if braced else (first, last)
        rounds = _rounds(header, code[first:last], constants, code) if match[1] == "for" else None
        rounds = None if rounds is None or max(rounds / MOST_ROUNDS, rounds * outer / MOST_STATED) > 1 else rounds
        yield _Loop(*inner, braced, rounds)
        yield from _loops(code, constants, *inner, outer * (rounds or 1.0))
        at = last
        if match[1] == "do":
            ended = re.compile(r"\s*while\s*\(").match(code, last)
            if not ended:
                raise _Broken
            at = _find_closing(code, ended.end() - 1)


def _rounds(header: str, body: str, constants: Mapping[str, float], code: str) -> float | None:
    """How often a `for` runs at most, if its text says so."""
    parts = header.split(";")
    if len(parts) != 3:
        return None
    begin, step = _BEGIN.fullmatch(parts[0].rstrip()), _STEP.fullmatch(parts[2])
    if not begin or not step or (name := begin[2]) not in (step[2], step[3], step[5]):
        return None
    low, by = _value(begin[3], constants), 1 if step[7] is None else _value(step[7], constants)
    if low is None or not by or _changes(name, parts[1] + body, code):
        return None
    by = -by if "-" in (step[1] or step[4] or step[6]) else by
    if begin[1] == "uint" and by < 0:
        return None  # less than nothing is the largest of all
    tests = (test for part in parts[1].split("&&") if (test := _TEST.fullmatch(part)) and test[1] == name)
    return next((rounds for test in tests if (rounds := _until(low, test[2], _value(test[3], constants), by))), None)


def _until(low: float, way: str, high: float | None, by: float) -> float | None:
    """The rounds from one number to another; None if it is never reached."""
    if high is None or abs(by) <= _STILL * max(abs(low), abs(high)):
        return None
    upward = way in ("<", "<=") or (way == "!=" and high >= low)
    if upward != (by > 0) or (way == "!=" and (high - low) % by):
        return None
    return max((high - low) / by, 0.0) + 1.0


def _changes(name: str, body: str, code: str) -> bool:
    """True if the body may set the variable."""
    if re.search(rf"\b{name}\s*(?:=(?!=)|[-+*/%&|^]=|<<=|>>=|\+\+|--)|(?:\+\+|--)\s*{name}\b", body):
        return True
    passed = re.search(rf"[(,]\s*{name}\s*[,)]", body)
    return passed is not None and re.search(r"\b(out|inout|modf|frexp)\b", code) is not None


def _constants(code: str) -> dict[str, float]:
    """What the text gives a name to: constants and macros that are numbers, unless the name is used for more."""
    constants: dict[str, float] = {}
    defined: set[str] = set()
    variables = frozenset(_VARIABLE.findall(code))
    for match in _NAMED.finditer(code):
        name, value = match[1] or match[3], _value(match[2] or match[4], constants)
        again = name in defined or name in variables
        defined.add(name)
        if value is None or again:
            constants.pop(name, None)
        else:
            constants[name] = value
    return constants


def _value(text: str, constants: Mapping[str, float]) -> float | None:
    """What an expression of numbers and constants is worth."""
    plain = re.sub(r"\bfloat\s*(?=\()", "", text).strip()
    try:
        return _evaluate(ast.parse(_NUMBER.sub(r"\1", plain), mode="eval").body, constants)
    except (SyntaxError, ValueError, LookupError, ArithmeticError, RecursionError, MemoryError):
        return None


def _evaluate(node: ast.expr, constants: Mapping[str, float]) -> float:
    match node:
        case ast.Constant(value=int() | float() as number):
            return number
        case ast.Name(id=name):
            return constants[name]
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -_evaluate(inner, constants)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_evaluate(left, constants), _evaluate(right, constants))
        case _:
            raise ValueError


def _statement(code: str, at: int) -> int:
    """The end of the statement that begins at a place."""
    at = _skip(code, at)
    if code[at : at + 1] == "{":
        return _find_closing(code, at)
    word = re.compile(r"\w*").match(code, at)
    assert word is not None
    match word[0]:
        case "for" | "while" | "if" | "switch":
            opened = code.find("(", at)
            if opened < 0:
                raise _Broken
            end = _statement(code, _find_closing(code, opened))
            rest = re.compile(r"\s*else\b").match(code, end) if word[0] == "if" else None
            return _statement(code, rest.end()) if rest else end
        case "do":
            ended = code.find(";", _statement(code, word.end()))
        case _:
            ended = code.find(";", at)
    if ended < 0:
        raise _Broken
    return ended + 1


def _find_closing(code: str, opened: int) -> int:
    """The place after the bracket that closes the one at a place."""
    opening, depth = code[opened], 0
    closing = {"(": ")", "{": "}"}[opening]
    for at in range(opened, len(code)):
        depth += (code[at] == opening) - (code[at] == closing)
        if not depth:
            return at + 1
    raise _Broken


def _skip(code: str, at: int) -> int:
    """The next place that is no space."""
    while at < len(code) and code[at].isspace():
        at += 1
    return at


def _mask(match: re.Match[str]) -> str:
    """As many spaces, lines as they were."""
    return re.sub(r"[^\n]", " ", match[0])
