"""Small safe formulas of time and of other values, read and computed by ourselves.

What reads and computes them is loaded with the first formula: most graphs have none.
"""

from __future__ import annotations

from .expression import Expression
from .fault import ExpressionError

__all__ = ["Expression", "ExpressionError"]
