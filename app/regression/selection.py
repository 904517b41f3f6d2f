"""Selects cases for `-k` by words of their names with and, or, not and parentheses, as in pytest."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from ..errors import UsageError
from .cases import Case

CasePredicate = Callable[[str], bool]

_WORDS = re.compile(r"[()]|[^\s()]+")
_SIGNS = ("and", "or", "not", "(", ")")


def select_cases(cases: Iterable[Case], expression: str) -> tuple[Case, ...]:
    """The cases that an expression selects, all for "". Raises UsageError if it is invalid or selects none."""
    all_cases = tuple(cases)
    if not expression.strip():
        return all_cases
    predicate = parse_expression(expression)
    selected = tuple(case for case in all_cases if predicate(case.id))
    if not selected:
        raise UsageError(f"-k {expression}: none of {len(all_cases)} cases matches; --list shows their names")
    return selected


def parse_expression(expression: str) -> CasePredicate:
    """A predicate of case ids. A word selects the ids that contain it, in upper or lower case."""
    words = _WORDS.findall(expression)
    predicate, rest = _parse_or(words, expression)
    if rest:
        raise _make_fault(expression, f"'{rest[0]}' is not expected")
    return predicate


def _parse_or(words: list[str], whole: str) -> tuple[CasePredicate, list[str]]:
    predicate, rest = _parse_and(words, whole)
    while rest and rest[0].lower() == "or":
        operand, rest = _parse_and(rest[1:], whole)
        predicate = _combine(predicate, operand, any)
    return predicate, rest


def _parse_and(words: list[str], whole: str) -> tuple[CasePredicate, list[str]]:
    predicate, rest = _parse_not(words, whole)
    while rest and rest[0].lower() == "and":
        operand, rest = _parse_not(rest[1:], whole)
        predicate = _combine(predicate, operand, all)
    return predicate, rest


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


def _combine(first: CasePredicate, second: CasePredicate, join: Callable[[Iterable[bool]], bool]) -> CasePredicate:
    return lambda id: join(each(id) for each in (first, second))


def _make_fault(expression: str, sentence: str) -> UsageError:
    return UsageError(f"-k '{expression}': {sentence}; write words with and, or, not and parentheses")
