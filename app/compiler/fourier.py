"""Lengths and stages of the fast Fourier transform that convolves two pictures. See primitive/fourier.glsl."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

_PRIMES = (2, 3, 5)

_PASS = 14
"""What a stage costs besides its reads, in reads: measured on the software rasterizer."""

_MOST = 20
"""Reads of a stage at most: the driver unrolls them."""


@dataclass(frozen=True)
class Stage:
    """One pass: `radix` transforms of length `span` become one; every pixel of it is made of `terms` pixels.

    Of the first stage, `terms` may be less than `radix`: what is not read is black.
    """

    radix: int
    span: int
    terms: int


def padded_length(picture: int, kernel: int) -> int:
    """Pixels to transform so that nothing that a kernel spreads comes round to the picture again."""
    length = max(kernel, picture + kernel // 2)
    while _rest(length) != 1:
        length += 1
    return length


def stages(length: int, filled: int) -> tuple[Stage, ...]:
    """The passes that transform a length with no prime factors but 2, 3 and 5; pixels from `filled` on are black."""
    terms = {
        radix: math.ceil(filled * radix / length) for radix in range(1, length + 1) if length % radix == 0
    }
    first = min(
        (radix for radix in terms if terms[radix] <= _MOST),
        key=lambda radix: _PASS + terms[radix] + _cost(_radices(length // radix)),
    )
    found = [Stage(first, 1, terms[first])]
    span = first
    for radix in _radices(length // first):
        found.append(Stage(radix, span, radix))
        span *= radix
    return tuple(found)


@cache
def _radices(length: int) -> tuple[int, ...]:
    """The factors of a length that cost the least."""
    if length == 1:
        return ()
    tried = ((radix, *_radices(length // radix)) for radix in range(2, _MOST + 1) if length % radix == 0)
    return min(tried, key=_cost)


def _cost(radices: tuple[int, ...]) -> int:
    return sum(_PASS + radix for radix in radices)


def _rest(length: int) -> int:
    for prime in _PRIMES:
        while length % prime == 0:
            length //= prime
    return length
