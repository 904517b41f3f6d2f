"""Looks for better values where slopes say nothing: the covariance matrix adaptation evolution strategy."""

from __future__ import annotations

import numpy as np

from ..media.comparison.metrics import Array
from .libraries import load_fit_library
from .search import FitSearch

_LEAST_GAIN, _LEAST_ERROR = 1e-4, 1e-3
"""The search ends where generations differ by less than this part of the first error, or of an error that nobody sees.
Chosen by judgement."""

_WORTHWHILE = 0.9
"""What the error must fall to within `_PATIENCE` generations, or the search ends: a tenth less. Chosen by judgement."""

_WIDTH = 0.2
"""The standard deviation of the first points, in ranges: Hansen advises a third to a fifth of the range."""
_SMALLEST = 0.002
"""The standard deviation, in ranges, below which points are the same."""
_MOST_SCANNED = 32
"""Steps of a scan along one number."""
_PATIENCE = 12
"""Generations in which the best error falls by less than a tenth: then it is left to a descent. Chosen by measurement
on the presets."""


def evolve(search: FitSearch, start: Array) -> None:
    """Try points around the best ones until they differ by nothing that counts; `search` keeps the best.

    First all values of each whole number, or some all over its range. Then by `cma` (Hansen and Ostermeier 2001), with
    a fixed seed; the points of a whole number stay half of a step apart at least, so that it does not get stuck. Raises
    BudgetSpent.
    """
    numbers = search.space.numbers
    search.measure(start)
    for place, item in enumerate(numbers):
        if item.is_whole or len(numbers) == 1:
            _scan(search, place)
    if len(numbers) == 1:  # the library wants two
        return
    steps = [0.5 / (item.high - item.low) if item.is_whole else _SMALLEST for item in numbers]
    options = {
        "bounds": [0.0, 1.0],
        "seed": 1,
        "verbose": -9,
        "minstd": steps,
        "tolfun": _LEAST_GAIN * max(search.best_error, _LEAST_ERROR),
        "tolx": _SMALLEST,
    }
    strategy = load_fit_library("cma").CMAEvolutionStrategy(search.best_point, _WIDTH, options)
    errors = [search.best_error]
    while not strategy.stop() and (len(errors) <= _PATIENCE or errors[-1] < _WORTHWHILE * errors[-_PATIENCE]):
        points = strategy.ask()
        strategy.tell(points, [float(np.linalg.norm(search.measure(np.asarray(point)))) for point in points])
        errors.append(search.best_error)


def _scan(search: FitSearch, place: int) -> None:
    """Try values of one number all over its range, while the others are at their best."""
    item, point = search.space.numbers[place], np.array(search.best_point)
    count = min(round(item.high - item.low), _MOST_SCANNED) if item.is_whole else _MOST_SCANNED
    for fraction in np.linspace(0.0, 1.0, count + 1):
        point[place] = fraction
        search.measure(np.array(point))
