"""Gaussian blur at a cost that hardly depends on sigma.

Small sigmas are convolved as they are. Large ones are decimated with a Gaussian of 0.8 times the step (a box would
move small highlights by up to half a block), convolved exactly at the small size, and enlarged with a cubic B-spline,
whose own variance of a third of a small pixel squared is taken off first (Unser 1999). Relative error below 3e-4.
"""

from __future__ import annotations

import math

from halation.nodes import Edge
from msgspec import Struct

DIRECT_BELOW = 7.0
"""Up to this sigma the direct convolution is both exact and no slower."""

_DECIMATION_SIGMA = 0.8
"""Sigma of a decimation, in steps."""

_MIN_SMOOTH_REACH = 36
"""How many pixels of the small size other weights must reach: the error is then below 1e-3 of what a pixel becomes."""

_MIN_REST = 1.8
"""Sigma that must be left for the small size, in its pixels: less of it shows the grid."""


class BlurAxis(Struct, frozen=True):
    """How to blur along one axis: decimate by each step, convolve with weights, enlarge by `factor`."""

    steps: tuple[int, ...]
    factor: int
    weights: tuple[float, ...]


def plan_axis(sigma: float) -> BlurAxis:
    """Split `sigma`, in pixels, into decimations and an exact rest."""
    if sigma < DIRECT_BELOW:
        return BlurAxis((), 1, gaussian_weights(sigma) if sigma > 0.0 else ())
    steps: list[int] = []
    factor, variance = 1, 0.0
    while True:
        for step in (4, 2):
            next_factor = factor * step
            next_variance = variance + (_DECIMATION_SIGMA * next_factor) ** 2
            rest = sigma * sigma - next_variance - next_factor**2 / 3.0
            if rest > 0.0 and math.sqrt(rest) >= _MIN_REST * next_factor:
                steps.append(step)
                factor, variance = next_factor, next_variance
                break
        else:
            break
    rest = math.sqrt(sigma * sigma - variance - factor**2 / 3.0) / factor
    return BlurAxis(tuple(steps), factor, gaussian_weights(rest))


def plan_weights(smooth: tuple[float, ...]) -> BlurAxis:
    """The same for an odd number of weights that fall off as smoothly as three boxes spread by each other do.

    Samples of them are sharpened by what decimating and enlarging blur them, but nowhere made negative.
    """
    reach = len(smooth) // 2
    steps: list[int] = []
    factor, variance = 1, 0.0
    while reach >= 2 * factor * _MIN_SMOOTH_REACH:
        steps.append(4 if reach >= 4 * factor * _MIN_SMOOTH_REACH else 2)
        factor *= steps[-1]
        variance += (_DECIMATION_SIGMA * factor) ** 2
    if factor == 1:
        return BlurAxis((), 1, smooth)
    samples = _normalize([0.0, *(smooth[i] for i in range(reach % factor, len(smooth), factor)), 0.0])
    excess = _measure_variance(samples) + (variance + factor**2 / 3.0 - _measure_variance(smooth)) / factor**2
    neighbors = [(before + after) / 2.0 for before, after in zip([0.0, *samples], [*samples[1:], 0.0], strict=False)]
    sharpened = [
        max((1.0 + excess) * sample - excess * neighbor, 0.0)
        for sample, neighbor in zip(samples, neighbors, strict=True)
    ]
    return BlurAxis(tuple(steps), factor, _normalize(sharpened))


def find_spans(axis: BlurAxis, length: int, edge: Edge) -> tuple[list[tuple[int, int]], Edge]:
    """The first pixel and the length of what each step of a row of `length` makes, in its own pixels; its edge mode.

    A small picture reaches beyond the row far enough for the edge mode to mean what it does at full size. What is
    clamped or black comes to an end there, and its last pixels stand for all that follow. What repeats in whole blocks
    does so at any size. All else goes on as far as is ever read.
    """
    spans: list[tuple[int, int]] = []
    if edge in ("clamp", "black"):
        first, end = 0, length
        for step in axis.steps:
            taps, start = decimation_weights(step)
            first = (first - start - len(taps) + 1) // step
            end = -((start + 1 - end) // step) + 1
            spans.append((first, end - first))
        return spans, edge
    for step in axis.steps if edge in ("reflect", "wrap") else ():
        if length % step:
            break
        length //= step
        spans.append((0, length))
    remaining_steps = axis.steps[len(spans) :]
    if not remaining_steps:
        return spans, edge
    apron, total = math.prod(remaining_steps) * (len(axis.weights) // 2 + 2), 1
    for step in remaining_steps:
        total *= step
        spans.append((-apron // total, -(-(length + 2 * apron) // total)))
    return spans, "clamp"


def gaussian_weights(sigma: float) -> tuple[float, ...]:
    """Normalized weights out to 4 sigma, as scipy's gaussian_filter has them.

    Below one pixel the Gaussian is integrated over each pixel: samples of it would be too narrow.
    """
    radius = int(4.0 * sigma + 0.5) if sigma >= 1.0 else math.ceil(4.0 * sigma)
    if sigma < 1.0:
        half = sigma * math.sqrt(2.0)
        weights = [math.erf((i + 0.5) / half) - math.erf((i - 0.5) / half) for i in range(-radius, radius + 1)]
    else:
        weights = [math.exp(-0.5 * (i / sigma) ** 2) for i in range(-radius, radius + 1)]
    return _normalize(weights)


def decimation_weights(step: int) -> tuple[tuple[float, ...], int]:
    """Weights of a decimation by `step`, and where they start relative to the first pixel of each block."""
    sigma, middle = _DECIMATION_SIGMA * step, (step - 1) / 2
    reach = math.ceil(4.0 * sigma - middle)
    weights = [math.exp(-0.5 * ((i - middle) / sigma) ** 2) for i in range(-reach, step + reach)]
    return _normalize(weights), -reach


def _normalize(weights: list[float]) -> tuple[float, ...]:
    total = math.fsum(weights)
    return tuple(weight / total for weight in weights)


def _measure_variance(weights: tuple[float, ...]) -> float:
    """Of normalized weights around their middle."""
    return math.fsum(weight * (i - len(weights) // 2) ** 2 for i, weight in enumerate(weights))
