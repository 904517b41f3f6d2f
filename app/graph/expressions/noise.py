"""Pseudo-random numbers that are the same on every machine: integer arithmetic and exact divisions only."""

from __future__ import annotations

import math

_BITS = (1 << 64) - 1
_GOLDEN = 0x9E3779B97F4A7C15
"""64 bits, and the odd number next to 2^64 divided by the golden ratio, by which SplitMix64 counts."""


def hash_numbers(number: int, seed: int = 0) -> int:
    """A 64-bit hash of an integer: SplitMix64 (Steele, Lea and Flood 2014)."""
    return mix_bits(mix_bits((seed + 1) * _GOLDEN) + (number + 1) * _GOLDEN)


def random(number: float, seed: float = 0.0) -> float:
    """A random number from 0 to below 1 for each integer; the fraction of `number` is ignored.

    It has 53 bits, as many as a double.
    """
    return (hash_numbers(math.floor(number), math.floor(seed)) >> 11) / (1 << 53)


def noise(x: float, seed: float = 0.0) -> float:
    """Value noise from -1 to 1: random at integers, with the quintic of Perlin (2002) between them."""
    place = math.floor(x)
    u = x - place
    value_left, value_right = (2.0 * random(place + side, seed) - 1.0 for side in (0, 1))
    return value_left + (value_right - value_left) * u * u * u * (u * (6.0 * u - 15.0) + 10.0)


def mix_bits(bits: int) -> int:
    """The finalizer of SplitMix64, with its constants: every bit of the result depends on every bit of the argument."""
    bits &= _BITS
    bits = ((bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9) & _BITS
    bits = ((bits ^ (bits >> 27)) * 0x94D049BB133111EB) & _BITS
    return bits ^ (bits >> 31)
