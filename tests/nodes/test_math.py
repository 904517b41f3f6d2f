"""Math against numpy in double precision."""

from __future__ import annotations

from typing import get_args

import numpy as np
import pytest
from halation.nodes.merge.math import Math, Operation


def safe(where, value):
    return np.where(where, value, 0.0)


def smoothstep(a, b, c):
    t = ((a - b) / (c - b)).clip(0, 1)
    return t * t * (3 - 2 * t)


with np.errstate(all="ignore"):
    REFERENCES = {
        "add": lambda a, b, c: a + b,
        "subtract": lambda a, b, c: a - b,
        "multiply": lambda a, b, c: a * b,
        "divide": lambda a, b, c: a / b,
        "multiply add": lambda a, b, c: a * b + c,
        "power": lambda a, b, c: safe(a > 0, np.abs(a) ** b),
        "minimum": lambda a, b, c: np.minimum(a, b),
        "maximum": lambda a, b, c: np.maximum(a, b),
        "modulo": lambda a, b, c: np.mod(a, b),
        "greater": lambda a, b, c: a > b,
        "less": lambda a, b, c: a < b,
        "absolute": lambda a, b, c: abs(a),
        "negate": lambda a, b, c: -a,
        "sign": lambda a, b, c: np.sign(a),
        "floor": lambda a, b, c: np.floor(a),
        "ceiling": lambda a, b, c: np.ceil(a),
        "round": lambda a, b, c: np.floor(a + 0.5),
        "fraction": lambda a, b, c: a - np.floor(a),
        "square root": lambda a, b, c: np.sqrt(a.clip(0)),
        "exponential": lambda a, b, c: np.exp(a),
        "logarithm": lambda a, b, c: safe(a > 0, np.log(np.abs(a))),
        "sine": lambda a, b, c: np.sin(a),
        "cosine": lambda a, b, c: np.cos(a),
        "arc tangent": lambda a, b, c: np.arctan2(a, b),
        "clamp": lambda a, b, c: np.clip(a, np.minimum(b, c), c),
        "remap": lambda a, b, c: (a - b) / (c - b),
        "smoothstep": smoothstep,
        "mix": lambda a, b, c: a + (b - a) * c,
    }


def operands() -> list[np.ndarray]:
    """Numbers of both signs, away from zero and from each other; b is below c, as clamp and smoothstep want it."""
    random = np.random.default_rng(0)
    a = random.uniform(-4.0, 4.0, (30, 31)).astype(np.float32)
    b = random.uniform(0.1, 2.0, (30, 31)).astype(np.float32) * random.choice([-1, 1], (30, 31)).astype(np.float32)
    return [a, b, (b + random.uniform(0.1, 2.0, (30, 31))).astype(np.float32)]


def test_every_operation_has_a_reference():
    assert set(REFERENCES) == set(get_args(Operation))


@pytest.mark.parametrize("operation", REFERENCES)
def test_operation_is_that_of_numpy(run, operation):
    a, b, c = operands()
    out = run(Math(operation=operation), {"a": a, "b": b, "c": c})[..., 0]
    expected = REFERENCES[operation](*(part.astype(np.float64) for part in (a, b, c)))
    error = np.abs(out - expected) / np.maximum(1.0, np.abs(expected))
    if operation == "modulo":  # a remainder of nothing and of the whole are the same
        error = np.minimum(error, np.abs(np.abs(out - expected) - np.abs(b)))
    assert error.max() < 1e-5


@pytest.mark.parametrize("operation", REFERENCES)
def test_what_has_no_result_is_finite(run, operation):
    """Every triple of troublesome numbers, NaN and infinity among them."""
    numbers = np.array([0.0, -0.0, 1.0, -1.0, 0.5, 1e30, -1e30, 1e-30, np.inf, -np.inf, np.nan], np.float32)
    a, b, c = (grid.reshape(11, 121).astype(np.float32) for grid in np.meshgrid(numbers, numbers, numbers))
    assert np.isfinite(run(Math(operation=operation), {"a": a, "b": b, "c": c})).all()


def test_without_a_result_is_zero(run):
    a, zero = np.array([[3.0, -3.0, 0.0]], np.float32), np.zeros((1, 3), np.float32)
    for operation in ("divide", "modulo"):
        assert np.all(run(Math(operation=operation), {"a": a, "b": zero}) == 0.0)
    assert run(Math(operation="square root"), {"a": a})[0, 1, 0] == 0.0
    assert run(Math(operation="logarithm"), {"a": a})[0, 1:, 0].tolist() == [0.0, 0.0]


@pytest.mark.parametrize(("operation", "b"), [("add", 0.0), ("subtract", 0.0), ("multiply", 1.0), ("divide", 1.0)])
def test_neutral_operand(operation, b):
    assert Math(operation=operation, b=b).identity() == "a"
    assert Math(operation=operation, b=0.5).identity() is None
