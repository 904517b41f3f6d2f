"""Vector math against NumPy in 64 bits."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from halation.nodes.merge.vector_math import VectorMath

B, C = np.array([0.5, -1.5, 2.0]), np.array([0.1, 0.2, -0.3])
Formula = Callable[[np.ndarray], np.ndarray]


def project(a: np.ndarray) -> np.ndarray:
    return (a @ B / (B @ B))[..., None] * B


FORMULAS: dict[str, Formula] = {
    "add": lambda a: a + B,
    "subtract": lambda a: a - B,
    "multiply": lambda a: a * B,
    "divide": lambda a: a / B,
    "multiply add": lambda a: a * B + C,
    "cross": lambda a: np.cross(a, B),
    "project": project,
    "reflect": lambda a: a - 2.0 * project(a),
    "scale": lambda a: a * -2.5,
    "normalize": lambda a: a / np.linalg.norm(a, axis=-1, keepdims=True),
    "absolute": np.abs,
    "minimum": lambda a: np.minimum(a, B),
    "maximum": lambda a: np.maximum(a, B),
    "floor": np.floor,
    "fraction": lambda a: a - np.floor(a),
}


@pytest.mark.parametrize("operation", VectorMath.values["operation"].choices)
def test_operations(run, operation):
    a = np.random.default_rng(9).normal(size=(7, 11, 3)).astype(np.float32)
    node = VectorMath(operation=operation, b=tuple(B), c=tuple(C), factor=-2.5)
    expected = FORMULAS[operation](a.astype(np.float64))
    np.testing.assert_allclose(run(node, {"a": a}), expected, rtol=1e-5, atol=2e-6)
    np.testing.assert_allclose(run(node, {"a": a}, output="dot")[..., 0], a @ B, rtol=1e-5, atol=2e-6)
    length = run(node, {"a": a}, output="length")[..., 0]
    np.testing.assert_allclose(length, np.linalg.norm(expected, axis=-1), rtol=1e-5, atol=2e-6)


@pytest.mark.parametrize("operation", ["divide", "project", "reflect", "normalize"])
def test_what_is_undefined_is_zero(run, operation):
    out = run(VectorMath(operation=operation), {"a": np.zeros((2, 2, 3), np.float32)})
    np.testing.assert_array_equal(out, 0.0)
