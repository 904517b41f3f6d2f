"""Formulas for pixels against NumPy, and against the same expressions as values of a graph."""

from __future__ import annotations

import numpy as np
import pytest
from halation.errors import GraphError
from halation.graph.expressions import Expression
from halation.graph.expressions.functions import FUNCTIONS
from halation.nodes.merge.pixel_formula import PixelFormula

WIDTH, HEIGHT = 31, 22


def make_inputs(count: int = 2) -> dict[str, np.ndarray]:
    random = np.random.default_rng(11)
    return {name: random.uniform(0.05, 2.0, (HEIGHT, WIDTH, 4)).astype(np.float32) for name in "abcd"[:count]}


Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5


def opaque(red: np.ndarray, green: np.ndarray, blue: np.ndarray) -> np.ndarray:
    return np.dstack([red, green, blue, np.ones_like(red)])


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("a", lambda a, b: a),
        ("a * (1 - b.a) + b", lambda a, b: a * (1.0 - b[..., 3:]) + b),
        ("a.r > b.g ? a : 0.5 * b", lambda a, b: np.where((a[..., 0] > b[..., 1])[..., None], a, 0.5 * b)),
        ("[a.r, b.g, p]", lambda a, b: opaque(a[..., 0], b[..., 1], np.full_like(a[..., 0], 0.25))),
        ("[a.r ^ 2, sqrt(a.g), -q]", lambda a, b: opaque(a[..., 0] ** 2, np.sqrt(a[..., 1]), 0.0 * X - 3.0)),
        ("[u, v, x / width + y / height]", lambda a, b: opaque(X / WIDTH, Y / HEIGHT, X / WIDTH + Y / HEIGHT)),
        ("max(a, b, 0.3) / (a + b)", lambda a, b: np.maximum(np.maximum(a, b), 0.3) / (a + b)),
        ("clamp(a, 0.2, 0.7)", lambda a, b: a.clip(0.2, 0.7)),
        ("a.r < 0.5 or not (b.g < 1) and true", lambda a, b: gray((a[..., 0] < 0.5) | (b[..., 1] >= 1.0))),
        ("a.g % 0.3", lambda a, b: gray(a[..., 1] % 0.3)),
    ],
)  # fmt: skip
def test_formulas_are_those_of_numpy(run, formula, expected):
    inputs = make_inputs()
    out = run(PixelFormula(formula=formula, p=0.25, q=3.0), inputs)
    wide = [inputs[name].astype(np.float64) for name in "ab"]
    np.testing.assert_allclose(out, expected(*wide), atol=2e-5, rtol=2e-5)
    value = run(PixelFormula(formula=formula, p=0.25, q=3.0), inputs, output="value")
    np.testing.assert_array_equal(value[..., 0], out[..., 0])


def gray(values: np.ndarray) -> np.ndarray:
    return opaque(*[values.astype(np.float64)] * 3)


@pytest.mark.parametrize("name", [name for name in FUNCTIONS if name not in ("noise", "random")])
def test_functions_give_what_they_give_in_expressions(run, name):
    """Also for whole numbers, 0 and negative numbers, where that is defined; without a value it is 0."""
    count = max(item for item in FUNCTIONS[name].counts if item < 10)
    formula = f"{name}({', '.join('pqrs'[:count] if count <= 4 else ['p', 'q', 'r', 's', '0.75'])})"
    random = np.random.default_rng(5)
    for row in (*random.uniform(-2.0, 2.0, (4, 4)), (0.0, 0.0, 0.0, 0.0), (-1.0, 2.0, 1.0, 3.0), (0.5, 0.2, 0.9, 1.0)):
        numbers = dict(zip("pqrs", np.float32(row).tolist(), strict=True))
        try:
            expected = Expression(formula).evaluate(1.0, 0.0, 24.0, lambda key, numbers=numbers: numbers[key])
        except GraphError:
            expected = 0.0
        out = run(PixelFormula(formula=formula, **numbers), size=(2, 2), output="value")[0, 0, 0]
        if name == "atan2" and not any(row):
            continue  # it has a value there for signed zeros alone
        assert out == pytest.approx(expected, rel=2e-4, abs=2e-5), numbers


@pytest.mark.parametrize(("formula", "sentence"), [
    ("a * ", "the expression ends too early"),
    ("a + gain", "'gain' is not known in a formula for pixels"),
    ("a > b", "lists cannot be compared"),
    ("a ? 1 : 2", "a list is neither true nor false"),
    ("[a.r, b.g] + a", "a list of 2 and a list of 4 numbers cannot be combined"),
    ("p.r", "a number has no channel 'r'"),
    ("a.q", "there is no channel 'q'"),
    ("noise(x)", "link a noise node"),
    ("__import__('os')", "there is no function '__import__'"),
    ("vec4(1)", "there is no function 'vec4'"),
    ("a; discard", "';' cannot be part of an expression"),
    ("", "the expression is empty"),
])  # fmt: skip
def test_faults_point_at_the_character(run, formula, sentence):
    with pytest.raises(GraphError, match="node 'node'") as caught:
        run(PixelFormula(formula=formula), make_inputs())
    assert sentence in str(caught.value)


def test_what_has_no_value_is_zero(run):
    inputs = make_inputs(1)
    for formula in ("1 / 0", "sqrt(-1)", "log(0)", "(-2) ^ 0.5", "asin(2)", "5 % 0", "exp(1000) - exp(1000)"):
        np.testing.assert_array_equal(run(PixelFormula(formula=formula), inputs, output="value"), 0.0)


def test_powers_have_a_value_for_each_sign(run):
    """As numpy's, but 0 where there is none: roots of negative numbers, and powers of 0 below 0."""
    bases, exponents = (
        np.array([-2.0, -1.0, -0.5, 0.0, 0.25, 0.5, 1.0, 3.0]),
        np.array([-3, -2, -1, -0.5, 0, 0.5, 1, 2, 3, 4, 5]),
    )
    base, exponent = (part.ravel() for part in np.meshgrid(bases, exponents))
    picture = np.zeros((1, len(base), 4), np.float32)
    picture[0, :, 0], picture[0, :, 1] = base, exponent
    with np.errstate(all="ignore"):
        expected = np.where(exponent == 0.0, 1.0, np.where(base == 0.0, 0.0, np.nan_to_num(base**exponent)))
    found = run(PixelFormula(formula="a.r ^ a.g"), {"a": picture}, output="value")
    np.testing.assert_allclose(found[0, :, 0], expected, rtol=1e-5)


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("a.r % a.g", lambda x, y: np.where(y == 0.0, 0.0, x - y * np.floor(x / np.where(y == 0.0, 1.0, y)))),
        ("a.r / a.g", lambda x, y: np.where(y == 0.0, 0.0, x / np.where(y == 0.0, 1.0, y))),
        ("atan2(a.r, a.g)", np.arctan2),
    ],
)
def test_what_is_divided_by_round_numbers(run, formula, expected):
    """Also by 1, and where both are 0."""
    x, y = (
        part.ravel() for part in np.meshgrid(*[np.array([-1.5, -1.0, -0.75, -0.25, 0.0, 0.25, 0.75, 1.0, 2.0])] * 2)
    )
    picture = np.zeros((1, len(x), 4), np.float32)
    picture[0, :, 0], picture[0, :, 1] = x, y
    found = run(PixelFormula(formula=formula), {"a": picture}, output="value")
    np.testing.assert_allclose(found[0, :, 0], expected(x, y), rtol=1e-5, atol=1e-6)


def test_a_list_of_two_is_opaque_without_blue(run):
    inputs = make_inputs(1)
    found = run(PixelFormula(formula="[a.g, a.r * 0.5]"), inputs)
    np.testing.assert_allclose(found, opaque(inputs["a"][..., 1], inputs["a"][..., 0] * 0.5, 0.0 * X), rtol=1e-6)
