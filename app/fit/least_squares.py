"""Looks for better values where the picture changes smoothly: damped least squares, by scipy."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from ..errors import UsageError
from ..media.comparison.metrics import Array
from .search import FitSearch

HOW_TO_INSTALL = "fitting needs scipy and cma: run pip install 'halation[fit]'"

_INSIDE = 0.02
"""How far inside of the ranges the first point lies: the method moves a number slowly away from an end."""


def load_fit_library(name: str) -> Any:
    """A library of the extra `fit`. Raises UsageError where it is not installed."""
    try:
        if name == "cma":
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # it says that it cannot draw diagrams
                import cma

            return cma
        from scipy import optimize
    except ImportError:
        raise UsageError(HOW_TO_INSTALL) from None
    return optimize


def check_fit_libraries() -> None:
    """Raise UsageError where a library of the extra `fit` is not installed."""
    load_fit_library("scipy")
    load_fit_library("cma")


def descend(search: FitSearch, start: Array, tolerance: float) -> None:
    """Follow the slopes of the picture down from a point, until nothing improves; `search` keeps the best.

    By the trust region reflective method of Branch, Coleman and Li (1999), which never leaves the ranges. Whole numbers
    stay as they are. It ends where a step improves the squared error by less than the `tolerance`, as a share. Raises
    BudgetSpent.
    """
    free = ~search.space.whole
    if not free.any():
        return

    def fill(part: Array) -> Array:
        point = np.array(start)
        point[free] = part
        return point

    load_fit_library("scipy").least_squares(
        lambda part: search.measure(fill(part)),
        np.clip(start[free], _INSIDE, 1.0 - _INSIDE),
        lambda part: search.measure_slopes(fill(part), free),
        (0.0, 1.0),
        ftol=tolerance,
        xtol=1e-5,
        gtol=1e-12,
    )
