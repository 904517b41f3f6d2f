"""What a fit has found: values before and after, how well the picture determines them, errors and pictures."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from halation.nodes import Plain
from msgspec import Struct

from ..graph import Graph
from ..media.comparison.color_difference import delta_e_2000, to_lab
from ..media.comparison.metrics import Array
from .search import FitMeter
from .search_space import SearchSpace

_DEPENDENT = 1e-9
"""Columns whose singular values are below this part of the largest are mixtures of others: slopes are differences of
pictures in floats of 32 bits, so that no digit of them is left there."""

_DETERMINED = 0.02
"""The share of its range to which a number is to be known."""

_VISIBLE = 0.1
"""The error that such a change must make: a tenth of what can be seen. Rounding a picture to 8 bits makes twice as
much."""


class FittedValue(Struct, frozen=True):
    """A number before and after, with its range.

    `curvature` is how much the error grows per range if the number moves away while all others make up for it as well
    as they can. `is_determined` is False where the picture hardly depends on it, or others can stand in for it.
    """

    name: str
    before: float
    after: float
    low: float
    high: float
    curvature: float
    is_determined: bool


class FitResult(Struct, frozen=True):
    """The fitted graph, its settings by path, its numbers, and the pictures before, after and wanted.

    Pictures are light, [h, w, 3].

    Errors are root mean squares of CIE94 differences for pixels, and of several measures for a look. `delta_e` are
    means of CIEDE2000 before and after, None for a look. `stopped` says what ended the search early, or "".
    """

    graph: Graph
    settings: Mapping[str, Plain]
    values: tuple[FittedValue, ...]
    errors: tuple[float, float]
    delta_e: tuple[float, float] | None
    before: Array
    after: Array
    reference: Array
    renders: int
    seconds: float
    stopped: str


def describe_result(
    space: SearchSpace,
    point: Array,
    slopes: Array | None,
    pictures: tuple[Array, Array, Array],
    errors: tuple[float, float],
    is_paired: bool,
    meter: FitMeter,
) -> FitResult:
    """The result at a point of the search space. `pictures` are those before and after, and the reference."""
    before, after, reference = pictures
    delta_e = (_mean_delta_e(before, reference), _mean_delta_e(after, reference)) if is_paired else None
    settings = {} if np.array_equal(point, space.start) else space.settings_at(point)
    graph = space.graph_at(point) if settings else space.graph
    values = _describe_values(space, point, slopes)
    return FitResult(
        graph, settings, values, errors, delta_e, before, after, reference, meter.count, meter.elapsed, meter.ended_by
    )


def measure_curvatures(slopes: Array) -> Array:
    """The length of the part of each column of slopes [differences, numbers] that no mixture of the others makes.

    Its square is the curvature of the squared error along the number where all others follow: one over the diagonal of
    the inverse of the Gauss-Newton matrix.
    """
    triangle = np.asarray(np.linalg.qr(slopes, mode="r"))
    lengths = np.zeros(slopes.shape[1])
    for place, column in enumerate(triangle.T):
        others = np.delete(triangle, place, axis=1)
        rest = column - others @ np.linalg.lstsq(others, column, rcond=_DEPENDENT)[0] if others.size else column
        lengths[place] = float(np.linalg.norm(rest))
    return lengths


def _describe_values(space: SearchSpace, point: Array, slopes: Array | None) -> tuple[FittedValue, ...]:
    curvatures = np.zeros(len(space.numbers)) if slopes is None else measure_curvatures(slopes)
    return tuple(
        FittedValue(
            item.name,
            item.start,
            item.at(float(fraction)) if fraction != start else item.start,
            item.low,
            item.high,
            float(curvature),
            bool(curvature * _DETERMINED >= _VISIBLE),
        )
        for item, fraction, start, curvature in zip(space.numbers, point, space.start, curvatures, strict=True)
    )


def _mean_delta_e(light: Array, reference: Array) -> float:
    return float(np.mean(delta_e_2000(to_lab(light), to_lab(reference))))
