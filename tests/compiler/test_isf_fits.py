"""Numbers that follow knobs: a fit of samples, its formula, and lengths as fractions of a picture's."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import pytest
from halation.compiler.isf import affine
from halation.compiler.isf.affine import Anatomy, FittedKnob, LinearModel, are_close, find_length_formula, fit_slopes

A = FittedKnob("a", "knob_a", 1.0, 2.0, 0.5)
B = FittedKnob("b", "knob_b", 0.0, -3.0, 0.25)
NO_PROGRAM: Any = None


def evaluate(formula: str, a: float, b: float) -> float:
    """What Python makes of a formula: its operators are those of GLSL."""
    return float(eval(formula, {"knob_a": a, "knob_b": b}))


def make_model(numbers: list[float]) -> LinearModel:
    """A model of some numbers at the base, of two knobs; slopes and products come later."""
    return LinearModel(Anatomy(NO_PROGRAM, "same", numbers), {"a": A, "b": B})


def test_a_formula_and_a_prediction_are_the_same_bilinear_number() -> None:
    """f = 7 + 5 a - 4 b + 3 a b, from its value and its slopes at the base (2, -3)."""

    def f(a: float, b: float) -> float:
        return 7.0 + 5.0 * a - 4.0 * b + 3.0 * a * b

    model = make_model([f(2.0, -3.0)])
    model.slopes = {"a": [5.0 + 3.0 * -3.0], "b": [-4.0 + 3.0 * 2.0]}
    model.products = {("a", "b"): [3.0]}
    for a, b in product((-1.0, 0.0, 2.0, 10.0), (-3.0, 0.0, 0.5)):
        assert evaluate(model.write_formula(0), a, b) == pytest.approx(f(a, b), rel=1e-8)
        assert model.predict({"a": a, "b": b}) == pytest.approx([f(a, b)], rel=1e-12)
    assert model.predict({}) == [f(2.0, -3.0)]


@pytest.mark.parametrize(
    ("number", "slopes", "formula"),
    [
        (4.0, (0.0, 0.0), "4.0"),
        (4.0, (2.0, 0.0), "(2.0 * knob_a)"),  # 4 at a = 2 is twice a: nothing is left
        (5.0, (2.0, 0.0), "(2.0 * knob_a + 1.0)"),
        (5.0, (1e-7, 0.0), "5.0"),  # below what is rounding
        (0.0, (0.0, 0.0), "0.0"),
        (9.0, (0.0, -3.0), "(-3.0 * knob_b)"),
        (1e6, (1.0, 0.0), "1000000.0"),
        (1e4, (1.0, 0.0), "(1.0 * knob_a + 9998.0)"),
        (1e5, (0.75, 0.0), "(0.75 * knob_a + 99998.5)"),  # at a = 2 it is more than the rounding of 100000
    ],
)
def test_a_formula_leaves_out_what_is_rounding(number: float, slopes: tuple[float, float], formula: str) -> None:
    model = make_model([-1.0, number])
    model.slopes = {"a": [0.0, slopes[0]], "b": [0.0, slopes[1]]}
    assert model.write_formula(1) == formula


def take(function: Any, structure: str = "same", sizes: Any = None) -> Any:
    """Samples of a graph whose numbers a function says."""
    return lambda point: Anatomy(NO_PROGRAM, structure, [function(point["a"])], sizes or [])


def test_slopes_are_those_of_straight_lines() -> None:
    base = Anatomy(NO_PROGRAM, "same", [5.0 * A.base])
    assert fit_slopes(take(lambda a: 5.0 * a), base, A) == pytest.approx([5.0])
    assert fit_slopes(take(lambda a: 2.5 * a * a), base, A) is None
    assert fit_slopes(take(lambda a: 5.0 * a, "other"), base, A) is None
    assert fit_slopes(lambda point: None, base, A) is None
    switch = FittedKnob("a", "knob_a", 0.0, 2.0, 1.0, samples=1)
    assert fit_slopes(take(lambda a: 5.0 * a + (a - 2.0) * 3.0), base, switch) == pytest.approx([8.0])


def test_sizes_may_change_with_knobs_that_resize() -> None:
    base = Anatomy(NO_PROGRAM, "same", [10.0], [(8, 8)])
    sample = take(lambda a: 5.0 * a, sizes=[(9, 8)])
    assert fit_slopes(sample, base, A) is None
    assert fit_slopes(sample, base, FittedKnob("a", "w", 1.0, 2.0, 0.5, resizes=True)) == pytest.approx([5.0])


def test_a_fit_is_checked_far_off() -> None:
    assert A.far == 4.5 and FittedKnob("s", "s", 0.0, 0.0, 1.0, samples=1).far == 1.0


def test_what_is_close() -> None:
    assert are_close([1.0, 0.0], [1.0 + 0.9e-5, 0.9e-8]) and not are_close([1.0], [1.0 + 1.2e-5])
    assert not are_close([0.0], [1.2e-8]) and are_close([-1000.0], [-1000.009]) and not are_close([1.0], [-1.0])


CANVAS = (192, 193, 384, 577, 1080, 1921)


@pytest.mark.parametrize("factor", [2, 3, 4, 8, 13, 64, 100])
@pytest.mark.parametrize("added", ["down", "nearest", "up"])
def test_lengths_are_fractions_rounded_as_they_are(factor: int, added: str) -> None:
    more = {"down": 0, "nearest": factor // 2, "up": factor - 1}[added]
    lengths = [(side + more) // factor for side in CANVAS]
    formula = find_length_formula(CANVAS, lengths)
    assert formula is not None
    for side, length in zip(CANVAS, lengths, strict=True):
        assert eval(formula.format(f"{side}.0"), {"floor": math.floor}) == length
    if added != "nearest" and factor < 64:
        assert formula == f"floor(({{}} + {more}.0) / {factor}.0)"


def test_lengths_that_are_no_fraction() -> None:
    assert find_length_formula(CANVAS, CANVAS) == "{}" and find_length_formula(CANVAS, [7] * 6) == "7.0"
    assert find_length_formula((192, 384), (4, 2)) is None
    assert find_length_formula(CANVAS, [round(side**0.5) for side in CANVAS]) is None


@pytest.mark.parametrize(
    ("number", "text"),
    [(2.0, "2.0"), (-0.5, "-0.5"), (1e20, "1e+20"), (1 / 3, "0.333333333"), (1e9, "1e+09"), (0, "0.0")],
)
def test_literals_are_floats(number: float, text: str) -> None:
    assert affine.write_literal(number) == text
