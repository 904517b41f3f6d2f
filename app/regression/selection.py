"""`-k`: which cases are meant, by words of their names with and, or, not and parentheses, as pytest has it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from ..errors import UsageError
from .cases import Case

CasePredicate = Callable[[str], bool]

_WORDS = re.compile(r"[()]|[^\s()]+")
_SIGNS = ("and", "or", "not", "(", ")")


def select_cases(cases: Iterable[Case], expression: str) -> tuple[Case, ...]:
    """The cases that an expression means, all for "". Raises UsageError for one that makes no sense or means none."""
    found = tuple(cases)
    if not expression.strip():
        return found
    chooses = parse_expression(expression)
    kept = tuple(case for case in found if chooses(case.id))
    if not kept:
        raise UsageError(f"-k {expression}: none of {len(found)} cases is meant; --list shows their names")
    return kept


def parse_expression(expression: str) -> CasePredicate:
    """What tells by a case's id whether it is meant. Words are looked for in it, upper case or lower."""
    words = _WORDS.findall(expression)
    made, rest = _parse_or(words, expression)
    if rest:
        raise _make_fault(expression, f"'{rest[0]}' is not expected")
    return made


def _parse_or(words: list[str], whole: str) -> tuple[CasePredicate, list[str]]:
    made, rest = _parse_and(words, whole)
    while rest and rest[0].lower() == "or":
        other, rest = _parse_and(rest[1:], whole)
        made = _combine(made, other, any)
    return made, rest


def _parse_and(words: list[str], whole: str) -> tuple[CasePredicate, list[str]]:
    made, rest = _parse_not(words, whole)
    while rest and rest[0].lower() == "and":
        other, rest = _parse_not(rest[1:], whole)
        made = _combine(made, other, all)
    return made, rest


def _parse_not(words: list[str], whole: str) -> tuple[CasePredicate, list[str]]:
    if not words:
        raise _make_fault(whole, "it ends too early")
    word, rest = words[0].lower(), words[1:]
    if word == "not":
        inner, rest = _parse_not(rest, whole)
        return (lambda id: not inner(id)), rest
    if word == "(":
        inner, rest = _parse_or(rest, whole)
        if not rest or rest[0] != ")":
            raise _make_fault(whole, "a parenthesis is not closed")
        return inner, rest[1:]
    if word in _SIGNS:
        raise _make_fault(whole, f"'{words[0]}' is not expected")
    return (lambda id: word in id.lower()), rest


def _combine(one: CasePredicate, other: CasePredicate, how: Callable[[Iterable[bool]], bool]) -> CasePredicate:
    return lambda id: how(each(id) for each in (one, other))


def _make_fault(expression: str, said: str) -> UsageError:
    return UsageError(f"-k '{expression}': {said}; write words with and, or, not and parentheses")
