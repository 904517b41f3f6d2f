"""Lengths and stages of the fast Fourier transform that convolves two pictures. See primitive/fourier.glsl."""

from __future__ import annotations

from dataclasses import dataclass

_PRIMES = (2, 3, 5)
_JOINED = {2: (8, 4, 2), 3: (9, 3), 5: (5,)}
"""A stage reads as many pixels as its radix and takes a pass: these powers cost the least."""


@dataclass(frozen=True)
class Stage:
    """One pass: every pixel is made of `radix` pixels of transforms of length `span`."""

    radix: int
    span: int


def padded_length(picture: int, kernel: int) -> int:
    """Pixels to transform so that nothing that a kernel spreads comes round to the picture again."""
    length = max(kernel, picture + kernel // 2)
    while _rest(length) != 1:
        length += 1
    return length


def stages(length: int) -> tuple[Stage, ...]:
    """The passes that transform a length that has no prime factors but 2, 3 and 5."""
    found: list[Stage] = []
    span = 1
    for radix in _radices(length):
        found.append(Stage(radix, span))
        span *= radix
    return tuple(found)


def _rest(length: int) -> int:
    for prime in _PRIMES:
        while length % prime == 0:
            length //= prime
    return length


def _radices(length: int) -> list[int]:
    found: list[int] = []
    for prime in _PRIMES:
        while length % prime == 0:
            radix = next(one for one in _JOINED[prime] if length % one == 0)
            if radix == 8 and length % 16 == 0 and length % 32 != 0:
                radix = 4  # 4 x 4 reads less than 8 x 2
            found.append(radix)
            length //= radix
    return found or [1]
