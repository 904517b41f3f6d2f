"""A search over numbers whose picture is a formula: errors, slopes and budgets that are known in closed form."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.fit import evolution, search
from halation.fit.evolution import evolve
from halation.fit.least_squares import descend
from halation.fit.results import measure_curvatures
from halation.fit.search import BudgetSpent, FitMeter, FitSearch
from halation.fit.search_space import FittedNumber

Array = np.ndarray


def make_number(low: float, high: float, *, start: float = 0.0, is_whole: bool = False) -> FittedNumber:
    return FittedNumber("n", "a.n", (), start, low, high, is_whole)


def open_search(
    formula: Callable[[Array], Any], start: list[float], *numbers: FittedNumber, share: float = 1.0, **budget: Any
) -> tuple[FitSearch, FitMeter, list[Array]]:
    """A search whose picture at a point is a formula, and whose differences are that picture."""
    rendered = list[Array]()

    def render(point: Array, scale: float) -> Array:
        assert scale == 0.5
        rendered.append(point)
        return np.atleast_1d(np.asarray(formula(point), float))

    numbers = numbers or tuple(make_number(0.0, 1.0) for _ in start)
    space: Any = SimpleNamespace(
        numbers=numbers, start=np.array(start), graph_at=np.array, whole=np.array([item.is_whole for item in numbers])
    )
    output: Any = SimpleNamespace(render=render)
    likeness: Any = SimpleNamespace(measure=lambda light: light)
    meter = FitMeter(**{"seconds": 600.0, "renders": 1000, **budget})
    first = np.atleast_1d(np.asarray(formula(space.start), float))
    return FitSearch(space, output, likeness, 0.5, meter, share, first), meter, rendered


def test_the_best_point_is_kept_and_the_last_pictures_are_not_rendered_again() -> None:
    told = list[tuple[int, float]]()
    found, meter, rendered = open_search(
        lambda point: [3.0 * point[0], 4.0 * point[0]],
        [0.8],
        report=lambda meter: told.append((meter.count, meter.error)),
    )
    assert found.best_error == pytest.approx(4.0) and found.rate(np.array([3.0, 4.0])) == 5.0
    found.measure(np.array([0.8]))
    assert not rendered, "its differences are given"
    for part, count, best in (
        (0.4, 1, 0.4),
        (0.6, 2, 0.4),
        (0.4, 2, 0.4),
        (0.6, 2, 0.4),
        (0.2, 3, 0.2),
        (0.6, 3, 0.2),
        (0.4, 4, 0.2),
    ):
        np.testing.assert_allclose(found.measure(np.array([part])), [3.0 * part, 4.0 * part])
        assert (meter.count, float(found.best_point[0])) == (count, best) and found.best_error == pytest.approx(
            5.0 * best
        )
    assert len(rendered) == 4 and [count for count, _ in told] == [1, 2, 3, 4]
    np.testing.assert_allclose([error for _, error in told], [2.0, 2.0, 1.0, 1.0])
    assert meter.best is not None and float(meter.best[0]) == 0.2


def test_an_equal_error_is_no_better_point() -> None:
    found, *_ = open_search(lambda point: 1.0, [0.5])
    found.measure(np.array([0.1]))
    assert float(found.best_point[0]) == 0.5


@pytest.mark.parametrize(("renders", "share", "count"), [(4, 1.0, 4), (4, 0.5, 2), (5, 0.5, 3)])
def test_a_share_of_the_renders_may_be_used_up(renders: int, share: float, count: int) -> None:
    found, meter, rendered = open_search(lambda point: point, [0.5], renders=renders, share=share)
    with pytest.raises(BudgetSpent):
        for part in np.linspace(0.6, 0.9, 20):
            found.measure(np.array([part]))
    assert len(rendered) == meter.count == count
    assert meter.ended_by == (f"after {renders} renders" if share == 1.0 else "")
    found.measure(np.array([0.95]), is_last=True)
    assert meter.count == count + 1, "the last one is rendered in any case"


def test_time_and_the_user_end_a_search(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = SimpleNamespace(now=100.0)
    monkeypatch.setattr(search.time, "monotonic", lambda: clock.now)
    stops = [False]
    meter = FitMeter(10.0, 5, lambda: stops[0], started=100.0)
    clock.now = 104.9
    assert meter.elapsed == pytest.approx(4.9)
    meter.spend(0.5)
    clock.now = 105.0
    with pytest.raises(BudgetSpent):
        meter.spend(0.5)
    meter.spend(1.0)
    assert meter.count == 2 and not meter.is_spent
    clock.now = 110.0
    with pytest.raises(BudgetSpent):
        meter.spend(1.0)
    assert meter.ended_by == "after 10 s" and meter.is_spent
    clock.now, stops[0] = 0.0, True
    with pytest.raises(BudgetSpent):
        meter.spend(1.0)
    assert meter.ended_by == "interrupted" and meter.count == 2


def test_slopes_are_those_of_the_formula_and_stay_inside_the_ranges() -> None:
    def formula(point: Array) -> list[float]:
        return [point[0] * point[1], np.sin(point[2]), point[0] + 2.0 * point[2]]

    for point in ([0.0, 0.3, 1.0], [1.0, 0.6, 0.5], [0.4, 0.0, 0.7]):
        x, y, z = point
        exact = np.array([[y, x, 0.0], [0.0, 0.0, np.cos(z)], [1.0, 0.0, 2.0]])
        found, _, rendered = open_search(formula, point)
        free = np.array([True, False, True])
        np.testing.assert_allclose(found.measure_slopes(np.array(point), free), exact[:, free], atol=2e-3)
        assert found.slopes is not None and found.slopes.shape == (3, 3) and not found.slopes[:, 1].any()
        np.testing.assert_allclose(found.measure_central_slopes(np.array(point)), exact, atol=1e-4)
        assert all(0.0 <= part <= 1.0 for moved in rendered for part in moved)


def test_the_slope_of_a_whole_number_is_taken_over_a_whole_step() -> None:
    found, _, rendered = open_search(lambda point: point**2, [0.5], make_number(2.0, 10.0, is_whole=True))
    np.testing.assert_allclose(found.measure_central_slopes(np.array([0.5])), [[1.0]])
    np.testing.assert_allclose(rendered, [[0.375], [0.625]])


def test_a_descent_finds_the_least_squares_of_numpy_and_leaves_whole_numbers() -> None:
    random = np.random.default_rng(5)
    matrix, wanted = random.normal(size=(6, 3)), np.array([0.3, 0.5, 0.7])
    numbers = make_number(0.0, 1.0), make_number(0.0, 4.0, is_whole=True), make_number(0.0, 1.0)
    noise = 0.01 * random.normal(size=6)
    found, *_ = open_search(lambda point: matrix @ (point - wanted) - noise, [0.0, 0.5, 1.0], *numbers)
    descend(found, found.best_point, 1e-9)
    free = np.array([0, 2])
    exact = np.linalg.lstsq(matrix[:, free], matrix[:, free] @ wanted[free] + noise, rcond=None)[0]
    np.testing.assert_allclose(found.best_point[free], exact, atol=1e-4)
    assert found.best_point[1] == 0.5
    whole, _, rendered = open_search(lambda point: point, [0.5], make_number(0.0, 4.0, is_whole=True))
    descend(whole, whole.best_point, 1e-9)
    assert not rendered


@pytest.mark.parametrize(("high", "is_whole", "count"), [(6.0, True, 7), (900.0, True, 33), (6.0, False, 33)])
def test_one_number_is_tried_all_over_its_range(high: float, is_whole: bool, count: int) -> None:
    found, _, rendered = open_search(lambda point: point - 2.0 / 3.0, [0.11], make_number(0.0, high, is_whole=is_whole))
    evolve(found, np.array([0.11]))
    np.testing.assert_allclose(np.ravel(rendered), np.linspace(0.0, 1.0, count))
    assert abs(float(found.best_point[0]) - 2.0 / 3.0) <= 0.5 / (count - 1)


def test_of_several_numbers_whole_ones_are_tried_first_and_all_are_evolved() -> None:
    """The valley is where the whole number is 3; elsewhere all is flat, so that no slope leads there."""

    def formula(point: Array) -> list[float]:
        return [*(point[[0, 2]] - [0.3, 0.8]), 0.0] if round(5.0 * point[1]) == 3 else [2.0, 2.0, 2.0]

    numbers = make_number(0.0, 1.0), make_number(0.0, 5.0, is_whole=True), make_number(0.0, 1.0)
    found, _, rendered = open_search(formula, [0.9, 0.0, 0.1], *numbers)
    evolve(found, np.array([0.9, 0.0, 0.1]))
    np.testing.assert_allclose(np.array(rendered)[:5], [[0.9, part, 0.1] for part in (0.2, 0.4, 0.6, 0.8, 1.0)])
    np.testing.assert_allclose(found.best_point[[0, 2]], [0.3, 0.8], atol=0.03)
    assert all(0.0 <= part <= 1.0 for point in rendered for part in point)


def test_an_evolution_without_progress_is_left_to_a_descent(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twelve generations that gain less than a tenth, each of the points that the library asks for."""
    generations = list[int]()

    class Strategy:
        def __init__(self, point: Array, width: float, options: dict[str, Any]) -> None:
            assert options["tolfun"] == pytest.approx(1e-4 * 0.5) and options["minstd"] == [0.002, 0.125]
            assert options["bounds"] == [0.0, 1.0] and (width, options["seed"], options["tolx"]) == (0.2, 1, 0.002)

        def stop(self) -> bool:
            return False

        def ask(self) -> list[Array]:
            return [np.array([0.1, part]) for part in (0.2, 0.3)]

        def tell(self, points: list[Array], errors: list[float]) -> None:
            generations.append(len(points))
            assert errors == [0.5, 0.5]

    monkeypatch.setattr(evolution, "load_fit_library", lambda name: SimpleNamespace(CMAEvolutionStrategy=Strategy))
    numbers = make_number(0.0, 1.0), make_number(0.0, 4.0, is_whole=True)
    found, *_ = open_search(lambda point: 0.5, [0.5, 0.5], *numbers)
    evolve(found, np.array([0.5, 0.5]))
    assert generations == [2] * 12


@pytest.mark.parametrize("seed", range(3))
def test_curvatures_are_those_of_the_inverse_of_gauss_and_newton(seed: int) -> None:
    slopes = np.random.default_rng(seed).normal(size=(9, 4))
    exact = 1.0 / np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    np.testing.assert_allclose(measure_curvatures(slopes), exact, rtol=1e-9)
    twice = np.concatenate([slopes, slopes[:, :1] - slopes[:, 1:2]], axis=1)
    np.testing.assert_allclose(measure_curvatures(twice)[[0, 1, 4]], 0.0, atol=1e-9)
    np.testing.assert_allclose(measure_curvatures(slopes[:, :1]), np.linalg.norm(slopes[:, 0]))


def test_numbers_of_a_range_are_short_and_stay_inside() -> None:
    item = make_number(-2.0, 6.0)
    assert (
        [item.at(part) for part in (0.0, 0.25, 1.0)] == [-2.0, 0.0, 6.0]
        and item.at(1.1) == 6.0
        and item.at(-0.1) == -2.0
    )
    assert item.at(item.round(1.0 / 3.0)) == 0.66667 and item.round(2.0) == 1.0
    assert make_number(0.0, 10.0, is_whole=True).at(0.26) == 3.0
    wide = make_number(0.0, 2000.0)
    assert wide.at(wide.round(1.0 / 3.0)) == 666.67
