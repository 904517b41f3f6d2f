"""What becomes of a user's GLSL before a driver sees it: macros are expanded, sizes checked, divisions guarded."""

from __future__ import annotations

from collections.abc import Mapping

from ..glsl import blank_comments
from ..glsl.bounds import check_size
from ..glsl.divisions import guard_divisions
from ..glsl.macros import expand_macros
from ..glsl.tokens import GlslFault
from .code import CodeFault


def expand_code(source: str, macros: Mapping[str, str] | None = None, types: Mapping[str, str] | None = None) -> str:
    """The text without comments, macros and conditions, line by line. Raises CodeFault for what is too large.

    `macros` are defined from the start; `types` are those of names that the text does not declare.
    """
    try:
        expanded = expand_macros(blank_comments(source), macros)
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
