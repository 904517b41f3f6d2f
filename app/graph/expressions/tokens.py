"""The tokens of expressions."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

from msgspec import Struct

TokenKind = Literal[
    "number", "name", "function", "constant", "variable", "word", "operator", "bracket", "unknown", "end"
]

VARIABLES = frozenset({"frame", "time", "rate"})
"""Names that every expression can read."""

CONSTANTS = frozenset({"pi", "tau", "e", "true", "false"})

WORDS = frozenset({"and", "or", "not", "if", "else"})

_RESERVED: Mapping[str, TokenKind] = MappingProxyType(
    {
        **dict.fromkeys(VARIABLES, "variable"),
        **dict.fromkeys(CONSTANTS, "constant"),
        **dict.fromkeys(WORDS, "word"),
    }
)

MAX_LENGTH = 1000
"""The longest expression, in characters: a choice, longer than any that a user types."""

_PARTS = re.compile(
    r"\s*+(?:(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>(?:[^\W\d]\w*|`(?:[^`]|``)+`)(?:\.(?:[^\W\d]\w*|`(?:[^`]|``)+`))*)"
    r"|(?P<operator>\*\*|&&|\|\||[<>=!]=|[-+*/%^<>!?:.])"
    r"|(?P<bracket>[()\[\],])"
    r"|(?P<unknown>.))",
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


def tokenize(text: str) -> list[Token]:
    """The tokens of a text without spaces; none if it is too long. It never fails: other characters are `unknown`."""
    tokens: list[Token] = []
    for match in _PARTS.finditer(text) if len(text) <= MAX_LENGTH else ():
        kind, end = match.lastgroup, match.end()
        if kind == "name":
            tokens.append(_classify_name(match[kind], end, text))
        elif kind == "number" or kind == "operator" or kind == "bracket" or kind == "unknown":
            word = match[kind]
            tokens.append(Token(kind, end - len(word), end, word))
    return tokens


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


def _classify_name(word: str, end: int, text: str) -> Token:
    start, name = end - len(word), word
    if kind := _RESERVED.get(word):
        return Token(kind, start, end, word)
    if "`" in word or not word.isascii():  # else every part is an identifier
        parts = split_name(word)
        if "`" not in word and not all(part.isidentifier() for part in parts):
            return Token("unknown", start, end, word)
        if any(not part or "." in part for part in parts):
            return Token("unknown", start, end, word)
        name = ".".join(parts)
    if word.isidentifier() and _CALLED.match(text, end):
        return Token("function", start, end, word)
    return Token("name", start, end, word, name)
