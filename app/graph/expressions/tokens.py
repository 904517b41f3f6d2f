"""The words of an expression."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Literal

from msgspec import Struct

TokenKind = Literal[
    "number", "name", "function", "constant", "variable", "word", "operator", "bracket", "unknown", "end"
]

VARIABLES = frozenset({"frame", "time", "rate"})
"""What every expression can read."""

CONSTANTS = frozenset({"pi", "tau", "e", "true", "false"})

WORDS = frozenset({"and", "or", "not", "if", "else"})

_RESERVED = VARIABLES | CONSTANTS | WORDS

_PARTS = re.compile(
    r"(?P<space>\s+)"
    r"|(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>(?:[^\W\d]\w*|`(?:[^`]|``)+`)(?:\.(?:[^\W\d]\w*|`(?:[^`]|``)+`))*)"
    r"|(?P<operator>\*\*|&&|\|\||[<>=!]=|[-+*/%^<>!?:.])"
    r"|(?P<bracket>[()\[\],])"
    r"|(?P<unknown>.)",
    re.DOTALL,
)
_CALLED = re.compile(r"\s*\(")
_SEGMENTS = re.compile(r"`((?:[^`]|``)+)`|([^.`]+)")


class Token(Struct, frozen=True):
    """A word of the text from `start` to `end`. `name` is the dotted name without its quotes."""

    kind: TokenKind
    start: int
    end: int
    text: str
    name: str = ""


def tokens(text: str) -> Iterator[Token]:
    """Every word of a text, spaces left out; what is none is `unknown`. It never fails."""
    for found in _PARTS.finditer(text):
        kind, word = found.lastgroup, found.group()
        if kind == "name":
            yield _named(word, found.start(), found.end(), text)
        elif kind == "number" or kind == "operator" or kind == "bracket" or kind == "unknown":
            yield Token(kind, found.start(), found.end(), word)


def write_name(name: str) -> str:
    """A dotted name as an expression has to write it: odd parts in backquotes."""
    parts = name.split(".")
    return ".".join(
        part if part.isidentifier() and (place or part not in _RESERVED) else f"`{part.replace('`', '``')}`"
        for place, part in enumerate(parts)
    )


def segments(word: str) -> list[str]:
    """The parts of a dotted name as it is written."""
    return [quoted.replace("``", "`") or plain for quoted, plain in _SEGMENTS.findall(word)]


def _named(word: str, start: int, end: int, text: str) -> Token:
    parts = segments(word)
    if "`" not in word and not all(part.isidentifier() for part in parts):
        return Token("unknown", start, end, word)
    if any(not part or "." in part for part in parts):
        return Token("unknown", start, end, word)
    if word in WORDS:
        return Token("word", start, end, word)
    if word in CONSTANTS:
        return Token("constant", start, end, word)
    if word in VARIABLES:
        return Token("variable", start, end, word)
    if _CALLED.match(text, end) and word.isidentifier():
        return Token("function", start, end, word)
    return Token("name", start, end, word, ".".join(parts))
