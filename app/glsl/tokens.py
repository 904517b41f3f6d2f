"""The tokens of GLSL: words, numbers and signs, each with its place in the text."""

from __future__ import annotations

import re
from collections.abc import Sequence

from msgspec import Struct

_TOKEN = re.compile(
    r"[A-Za-z_]\w*"
    r"|0[xX]\w*"
    r"|\.?\d(?:[eE][-+](?=\d)|[\w.])*"
    r"|<<=|>>=|\+\+|--|<=|>=|==|!=|&&|\|\||\^\^|<<|>>|##|[-+*/%&|^]="
    r"|\S"
)
_DIRECTIVE = re.compile(r"^[ \t]*#[^\n]*", re.MULTILINE)
OPENING = {"(": ")", "[": "]", "{": "}"}
CLOSING = frozenset(OPENING.values())


class GlslToken(Struct, frozen=True):
    """A word, a number or a sign, and where it begins."""

    text: str
    start: int

    @property
    def end(self) -> int:
        """The place after its last letter."""
        return self.start + len(self.text)

    @property
    def is_word(self) -> bool:
        """True for names and keywords."""
        return self.text[0].isalpha() or self.text[0] == "_"

    @property
    def is_number(self) -> bool:
        """True for numbers."""
        return self.text[0].isdigit() or (self.text[0] == "." and len(self.text) > 1)


class GlslFault(Exception):
    """GLSL that cannot be used: why, and in which line."""

    def __init__(self, line: int, sentence: str) -> None:
        self.line, self.sentence = line, sentence
        super().__init__(f"line {line}: {sentence}")


def mask_directives(code: str) -> str:
    """The code with blanks in place of lines such as `#include`: every place stays."""
    return _DIRECTIVE.sub(lambda match: " " * len(match[0]), code)


def read_tokens(code: str) -> list[GlslToken]:
    """The tokens of code without comments."""
    return [GlslToken(match[0], match.start()) for match in _TOKEN.finditer(code)]


def split_tokens(code: str) -> list[str]:
    """The tokens of code without comments, as texts."""
    return _TOKEN.findall(code)


def count_line(code: str, place: int) -> int:
    """The number of the line that holds a place."""
    return code.count("\n", 0, place) + 1


def match_brackets(tokens: Sequence[GlslToken], code: str, deepest: int) -> dict[int, int]:
    """Where each bracket closes and where each closing one opens, as indices of tokens.

    Raises GlslFault where brackets do not match, or lie deeper inside each other than `deepest`.
    """
    partners: dict[int, int] = {}
    opened: list[int] = []
    for index, token in enumerate(tokens):
        if token.text in OPENING:
            opened.append(index)
            if len(opened) > deepest:
                raise GlslFault(count_line(code, token.start), f"more than {deepest} brackets lie inside each other")
        elif token.text in CLOSING:
            if not opened or OPENING[tokens[opened[-1]].text] != token.text:
                raise GlslFault(count_line(code, token.start), f"the bracket '{token.text}' closes nothing")
            partners[index] = opened.pop()
            partners[partners[index]] = index
    if opened:
        token = tokens[opened[-1]]
        raise GlslFault(count_line(code, token.start), f"the bracket '{token.text}' is never closed")
    return partners
