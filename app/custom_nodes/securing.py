"""What becomes of a user's GLSL before a driver sees it: macros are expanded, sizes checked, divisions guarded."""

from __future__ import annotations

from collections.abc import Mapping

from ..glsl import blank_comments
from ..glsl.bounds import check_size
from ..glsl.divisions import guard_divisions
from ..glsl.macros import expand_macros
from ..glsl.tokens import GlslFault
from .code import CodeFault

MOST_LETTERS = 1_000_000
MOST_LINES = 50_000
"""Of one text: several times those of the largest public shaders that we know."""


def check_length(text: str) -> None:
    """Raise CodeFault for a text that is too long to be read in the time of a keystroke."""
    if len(text) > MOST_LETTERS or text.count("\n") > MOST_LINES:
        raise CodeFault(1, f"the code has more than {MOST_LETTERS} letters or {MOST_LINES} lines")


def expand_code(
    source: str,
    macros: Mapping[str, str] | None = None,
    types: Mapping[str, str] | None = None,
    *,
    may_include: bool = False,
) -> str:
    """The text without comments, macros and conditions, line by line. Raises CodeFault for what is too large.

    `macros` are defined from the start; `types` are those of names that the text does not declare. Only with
    `may_include` it includes shaders of Halation.
    """
    try:
        expanded = expand_macros(blank_comments(source), macros, may_include=may_include)
        check_size(expanded, types)
    except GlslFault as fault:
        raise CodeFault(fault.line, fault.sentence) from None
    return expanded


def guard_code(expanded: str, types: Mapping[str, str] | None = None) -> str:
    """The text with divisions of whole numbers that cannot stop the process. Raises CodeFault."""
    try:
        return guard_divisions(expanded, types)
    except GlslFault as fault:
        raise CodeFault(fault.line, fault.sentence) from None
