"""Small safe formulas of time and of other values, read and computed by ourselves."""

from __future__ import annotations

from .expression import Expression
from .fault import ExpressionError
from .functions import FUNCTIONS, Function
from .parser import MAX_DEPTH, MAX_LENGTH
from .tokens import CONSTANTS, VARIABLES, Token, TokenKind, written

__all__ = [
    "CONSTANTS", "FUNCTIONS", "MAX_DEPTH", "MAX_LENGTH", "VARIABLES", "Expression", "ExpressionError", "Function",
    "Token", "TokenKind", "written",
]
