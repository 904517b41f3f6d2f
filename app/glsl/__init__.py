"""GLSL as text: what can be known of shader code without a driver."""

from __future__ import annotations

from .loops import COUNTER, MOST_ROUNDS, guarded
from .text import COMMENT, Function, Text, blanked, parse, unified, words

__all__ = [
    "COMMENT", "COUNTER", "MOST_ROUNDS", "Function", "Text", "blanked", "guarded", "parse", "unified", "words",
]
