"""The tokens of expressions."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Literal

from msgspec import Struct

TokenKind = Literal[
    "number", "name", "function", "constant", "variable", "word", "operator", "bracket", "unknown", "end"
]

VARIABLES = frozenset({"frame", "time", "rate"})
"""Names that every expression can read."""

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
    """A token of the text from `start` to `end`. `name` is the dotted name without backquotes."""

    kind: TokenKind
    start: int
    end: int
    text: str
    name: str = ""


def tokenize(text: str) -> Iterator[Token]:
    """The tokens of a text without spaces. It never fails: other characters have the kind `unknown`."""
    for match in _PARTS.finditer(text):
        kind, word = match.lastgroup, match.group()
        if kind == "name":
            yield _classify_name(word, match.start(), match.end(), text)
        elif kind == "number" or kind == "operator" or kind == "bracket" or kind == "unknown":
            yield Token(kind, match.start(), match.end(), word)


def write_name(name: str) -> str:
    """A dotted name as an expression writes it: parts that are not identifiers in backquotes."""
    parts = name.split(".")
    return ".".join(
        part if part.isidentifier() and (place or part not in _RESERVED) else f"`{part.replace('`', '``')}`"
        for place, part in enumerate(parts)
    )


def split_name(word: str) -> list[str]:
    """The parts of a dotted name, without backquotes."""
    return [quoted.replace("``", "`") or plain for quoted, plain in _SEGMENTS.findall(word)]


def _classify_name(word: str, start: int, end: int, text: str) -> Token:
    parts = split_name(word)
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
