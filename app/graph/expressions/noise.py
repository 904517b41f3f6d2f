"""Numbers that look random and are the same on every machine: whole-number arithmetic and exact divisions only."""

from __future__ import annotations

import math

_BITS = (1 << 64) - 1
_GOLDEN = 0x9E3779B97F4A7C15


def hash_numbers(number: int, seed: int = 0) -> int:
    """64 bits of a whole number: SplitMix64 (Steele, Lea and Flood 2014)."""
    return mix_bits(mix_bits((seed + 1) * _GOLDEN) + (number + 1) * _GOLDEN)


def random(number: float, seed: float = 0.0) -> float:
    """0 to 1, 1 left out: another one for every whole number; fractions are dropped."""
    return (hash_numbers(math.floor(number), math.floor(seed)) >> 11) / (1 << 53)


def noise(x: float, seed: float = 0.0) -> float:
    """-1 to 1: random at whole numbers, smooth between them with the quintic of Perlin (2002)."""
    place = math.floor(x)
    u = x - place
    left, right = (2.0 * random(place + side, seed) - 1.0 for side in (0, 1))
    return left + (right - left) * u * u * u * (u * (6.0 * u - 15.0) + 10.0)


def mix_bits(bits: int) -> int:
    """The finalizer of SplitMix64: every bit of the result depends on every bit."""
    bits &= _BITS
    bits = ((bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9) & _BITS
    bits = ((bits ^ (bits >> 27)) * 0x94D049BB133111EB) & _BITS
    return bits ^ (bits >> 31)
