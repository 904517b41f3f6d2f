"""Plans Gaussian blurs whose cost hardly depends on sigma.

Small sigmas are convolved directly. For others the picture is decimated with a Gaussian of 0.8 times the step (a box
would move small highlights by up to half a block), convolved exactly at the small size, and enlarged with a cubic
B-spline. The variances of all steps add up, so the convolution gets what the others leave: the B-spline has a third of
a small pixel squared (Unser 1999). A B-spline is flatter than a Gaussian of its variance, so the convolution is as much
more pointed: no weights of that many pixels come closer (least squares over all positions of a block do not).

A single pixel becomes a Gaussian to 3e-4 of its peak, and to 7e-4 where a step has just become possible (sigmas of 8.3
to 10, 17 to 20, 33 to 39). The constants were compared on impulses at all positions of a block, for sigmas of 4 to 64.
"""

from __future__ import annotations

import math

from halation.nodes import Edge
from msgspec import Struct

_DECIMATION_SIGMA = 0.8
"""Sigma of a decimation, in steps. The largest error is 3e-3 with 0.6 (aliasing), 4e-4 with 0.7, 2e-4 with 0.8, and no
smaller with 1.0, which reads an eighth more."""

_REACH = 4.0
"""Sigmas to which a Gaussian is summed, scipy's `truncate`: 6e-5 of it lie beyond."""

_MIN_SMOOTH_REACH = 36
"""How many pixels of the small size other weights must reach: the error is then below 1e-3 of what a pixel becomes."""

_MIN_REST = 1.8
"""Sigma, in small pixels, that must be left for the convolution at the small size, so pictures are decimated from a
sigma of 4.1 on, where a direct convolution takes a fifth longer (twice as long from 34 reads on, which need a loop).
With less the grid of the small picture shows: the largest error of an impulse is 4e-3 of its peak with 1.0, 1.4e-3 with
1.4, 7e-4 with 1.8 and 4e-4 with 2.2."""

_PRECISE_BELOW = 7.0
"""Up to this sigma precise blurs are convolved directly. At 7 that takes 57 reads for each axis, and twice the time."""

_SPLINE_CUMULANT = -1.0 / 30.0
"""The fourth cumulant of a cubic B-spline: that of four boxes, each -1/120. A Gaussian's is 0."""


class BlurAxis(Struct, frozen=True):
    """How to blur along one axis: decimate by each step, convolve with weights, enlarge by `factor`."""

    steps: tuple[int, ...]
    factor: int
    weights: tuple[float, ...]

    @property
    def reach(self) -> int:
        """How many pixels away, at full size, a pixel can matter: that many or a few less."""
        reach, factor = 0, 1
        for step in self.steps:
            reach += factor * len(decimation_weights(step)[0])
            factor *= step
        return reach + factor * (len(self.weights) // 2 + 3)


def plan_axis(sigma: float, *, precise: bool = False) -> BlurAxis:
    """Split `sigma`, in pixels, into decimations and a convolution at the small size."""
    if precise and sigma < _PRECISE_BELOW:
        return _plan_direct(sigma)
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
    if factor == 1:
        return _plan_direct(sigma)
    rest = math.sqrt(sigma * sigma - variance - factor**2 / 3.0) / factor
    return BlurAxis(tuple(steps), factor, _pointed_weights(rest))


def _plan_direct(sigma: float) -> BlurAxis:
    return BlurAxis((), 1, gaussian_weights(sigma) if sigma > 0.0 else ())


def plan_weights(smooth: tuple[float, ...]) -> BlurAxis:
    """The same for an odd number of weights that fall off as smoothly as three boxes convolved with each other.

    The weights at the small size are samples of these. They are sharpened by as much as decimation and enlargement
    blur, but never made negative.
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
    """The first pixel and the length of the row that each decimation makes, in its own pixels; and the edge mode.

    A small picture extends beyond the row far enough that its edge mode means the same as at full size. With `clamp`
    and `black` it ends where pixels no longer change, and its last pixel stands for all that follow. A row of whole
    blocks can be reflected or repeated at any size. In all other cases it is extended as far as is ever read.
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
    """Normalized weights, those of scipy's gaussian_filter from one pixel on.

    Below one pixel the Gaussian is integrated over each pixel: samples of it would be too narrow.
    """
    radius = int(_REACH * sigma + 0.5) if sigma >= 1.0 else math.ceil(_REACH * sigma)
    if sigma < 1.0:
        half = sigma * math.sqrt(2.0)
        weights = [math.erf((i + 0.5) / half) - math.erf((i - 0.5) / half) for i in range(-radius, radius + 1)]
    else:
        weights = [math.exp(-0.5 * (i / sigma) ** 2) for i in range(-radius, radius + 1)]
    return _normalize(weights)


def _pointed_weights(sigma: float) -> tuple[float, ...]:
    """A Gaussian with the fourth cumulant that a B-spline lacks, by the series of Gram and Charlier."""
    excess = -_SPLINE_CUMULANT / (24.0 * sigma**4)
    weights = gaussian_weights(sigma)
    squares = [((i - len(weights) // 2) / sigma) ** 2 for i in range(len(weights))]
    return _normalize(
        [weight * (1.0 + excess * (u * u - 6.0 * u + 3.0)) for weight, u in zip(weights, squares, strict=True)]
    )


def decimation_weights(step: int) -> tuple[tuple[float, ...], int]:
    """Weights of a decimation by `step`, and where they start relative to the first pixel of each block."""
    sigma, middle = _DECIMATION_SIGMA * step, (step - 1) / 2
    reach = math.ceil(_REACH * sigma - middle)
    weights = [math.exp(-0.5 * ((i - middle) / sigma) ** 2) for i in range(-reach, step + reach)]
    return _normalize(weights), -reach


def _normalize(weights: list[float]) -> tuple[float, ...]:
    total = math.fsum(weights)
    return tuple(weight / total for weight in weights)


def _measure_variance(weights: tuple[float, ...]) -> float:
    """The variance of normalized weights around their middle."""
    return math.fsum(weight * (i - len(weights) // 2) ** 2 for i, weight in enumerate(weights))
