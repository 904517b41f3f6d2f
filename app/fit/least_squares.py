"""Looks for better values where the picture changes smoothly: damped least squares, by scipy."""

from __future__ import annotations

import numpy as np

from ..media.comparison.metrics import Array
from .libraries import load_fit_library
from .search import FitSearch

_LEAST_STEP = 1e-5
"""A step that is shorter, as a part of the sliders, ends the descent: five digits of a range are all that is kept."""

_LEAST_SLOPE = 1e-12
"""A slope below this ends it, which is 0 but for rounding: in flat places `ftol` decides."""

_INSIDE = 0.02
"""How far inside of the ranges the first point lies: the method moves a number slowly away from an end."""


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
        xtol=_LEAST_STEP,
        gtol=_LEAST_SLOPE,
    )
