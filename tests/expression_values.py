"""Values that tests of expressions refer to, and what an expression is with them."""

from __future__ import annotations

import math

import pytest
from halation.errors import GraphError
from halation.graph.expressions import Expression, ExpressionError

VALUES = {
    "glow": 2.0,
    "count": 3,
    "on": True,
    "bloom.intensity": 0.25,
    "move.offset": (1.0, 2.0, 3.0),
    "my node.x": 7.0,
    "frame": 99.0,
    "move.offset.x": 1.0,
    "name": "text",
    "bad": math.inf,
    "huge": 10**400,
}


def value(name: str):
    if name not in VALUES:
        raise GraphError(f"there is no control '{name}'")
    return VALUES[name]


def at(text: str, frame: float = 5.0):
    return Expression(text).evaluate(frame, (frame - 1.0) / 24.0, 24.0, value)


def fault(text: str) -> ExpressionError:
    with pytest.raises(ExpressionError) as found:
        at(text)
    return found.value
