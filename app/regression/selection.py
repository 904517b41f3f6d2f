"""`-k`: which cases are meant, by words of their names with and, or, not and parentheses, as pytest has it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from ..errors import UsageError
from .cases import Case

Chooses = Callable[[str], bool]

_WORDS = re.compile(r"[()]|[^\s()]+")
_SIGNS = ("and", "or", "not", "(", ")")


def chosen(cases: Iterable[Case], expression: str) -> tuple[Case, ...]:
    """The cases that an expression means, all for "". Raises UsageError for one that makes no sense or means none."""
    found = tuple(cases)
    if not expression.strip():
        return found
    chooses = parse(expression)
    kept = tuple(case for case in found if chooses(case.id))
    if not kept:
        raise UsageError(f"-k {expression}: none of {len(found)} cases is meant; --list shows their names")
    return kept


def parse(expression: str) -> Chooses:
    """What tells by a case's id whether it is meant. Words are looked for in it, upper case or lower."""
    words = _WORDS.findall(expression)
    made, rest = _either(words, expression)
    if rest:
        raise _fault(expression, f"'{rest[0]}' is not expected")
    return made


def _either(words: list[str], whole: str) -> tuple[Chooses, list[str]]:
    made, rest = _both(words, whole)
    while rest and rest[0].lower() == "or":
        other, rest = _both(rest[1:], whole)
        made = _joined(made, other, any)
    return made, rest


def _both(words: list[str], whole: str) -> tuple[Chooses, list[str]]:
    made, rest = _one(words, whole)
    while rest and rest[0].lower() == "and":
        other, rest = _one(rest[1:], whole)
        made = _joined(made, other, all)
    return made, rest


def _one(words: list[str], whole: str) -> tuple[Chooses, list[str]]:
    if not words:
        raise _fault(whole, "it ends too early")
    word, rest = words[0].lower(), words[1:]
    if word == "not":
        inner, rest = _one(rest, whole)
        return (lambda id: not inner(id)), rest
    if word == "(":
        inner, rest = _either(rest, whole)
        if not rest or rest[0] != ")":
            raise _fault(whole, "a parenthesis is not closed")
        return inner, rest[1:]
    if word in _SIGNS:
        raise _fault(whole, f"'{words[0]}' is not expected")
    return (lambda id: word in id.lower()), rest


def _joined(one: Chooses, other: Chooses, how: Callable[[Iterable[bool]], bool]) -> Chooses:
    return lambda id: how(each(id) for each in (one, other))


def _fault(expression: str, said: str) -> UsageError:
    return UsageError(f"-k '{expression}': {said}; write words with and, or, not and parentheses")
