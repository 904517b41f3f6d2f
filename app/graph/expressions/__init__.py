"""Expressions: small formulas of the time and of other values.

They are parsed and evaluated here, never by Python's `eval`, so that a graph file cannot run code. The parser is
imported with the first expression, because most graphs have none.
"""

from __future__ import annotations

from .expression import Expression
from .fault import ExpressionError

__all__ = ["Expression", "ExpressionError"]
