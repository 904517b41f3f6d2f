"""Formulas for pixels. What has no value is 0."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .pixels import Array
from .places import grid


def formula_divide(a: Array | float, b: Array | float) -> Array:
    """a / b."""
    return np.where(np.not_equal(b, 0.0), a / np.where(np.not_equal(b, 0.0), b, 1.0), 0.0)


def formula_mod(a: Array | float, b: Array | float) -> Array:
    """The remainder of a / b, with the sign of b."""
    return np.where(np.not_equal(b, 0.0), a % np.where(np.not_equal(b, 0.0), b, 1.0), 0.0)


def formula_pow(a: Array | float, b: Array | float) -> Array:
    """a to the power of b; negative numbers have one for whole exponents."""
    a, b = np.broadcast_arrays(np.asarray(a, float), np.asarray(b, float))
    has_value = (a > 0.0) | ((a < 0.0) & (b == np.floor(b)))
    power = np.where(has_value, a, 1.0) ** b
    return np.where(b == 0.0, 1.0, np.where(has_value, power, 0.0))


def formula_asin(x: Array | float) -> Array:
    """The angle in radians with that sine."""
    return np.where(np.abs(x) <= 1.0, np.arcsin(np.clip(x, -1.0, 1.0)), 0.0)


def formula_acos(x: Array | float) -> Array:
    """The angle in radians with that cosine."""
    return np.where(np.abs(x) <= 1.0, np.arccos(np.clip(x, -1.0, 1.0)), 0.0)


def formula_atan2(y: Array | float, x: Array | float) -> Array:
    """The angle in radians from the x axis to the point x, y."""
    return np.where(np.abs(x) + np.abs(y) > 0.0, np.arctan2(y, x), 0.0)


def formula_sqrt(x: Array | float) -> Array:
    """The square root."""
    return np.sqrt(np.maximum(x, 0.0))


def formula_log(x: Array | float) -> Array:
    """The natural logarithm."""
    return np.where(np.greater(x, 0.0), np.log(np.maximum(x, 1e-38)), 0.0)


def formula_log2(x: Array | float) -> Array:
    """The logarithm to base 2."""
    return formula_log(x) / np.log(2.0)


def formula_round(x: Array | float) -> Array:
    """The nearest whole number, halves away from zero."""
    return np.sign(x) * np.floor(np.abs(x) + 0.5)


def formula_fract(x: Array | float) -> Array:
    """x without its whole part."""
    return np.asarray(x - np.floor(x))


def formula_step(edge: Array | float, x: Array | float) -> Array:
    """0 below the edge, else 1."""
    return np.greater_equal(x, edge) * 1.0


def formula_part(low: Array | float, high: Array | float, x: Array | float) -> Array:
    """Where x lies between low and high: from 0 to 1."""
    is_wide = np.not_equal(low, high)
    part = np.clip((x - low) / np.where(is_wide, np.subtract(high, low), 1.0), 0.0, 1.0)
    return np.where(is_wide, part, formula_step(low, x))


def formula_smoothstep(low: Array | float, high: Array | float, x: Array | float) -> Array:
    """0 below low, 1 above high, smooth between."""
    t = formula_part(low, high, x)
    return t * t * (3.0 - 2.0 * t)


def formula_fit(x: Array | float, low: Array | float, high: Array | float, a: Array | float, b: Array | float) -> Array:
    """From a where x is low to b where it is high, level outside."""
    t = formula_part(low, high, x)
    return a * (1.0 - t) + b * t


def formula_pulse(x: Array | float, start: Array | float, end: Array | float) -> Array:
    """1 from start until before end, else 0."""
    return (np.greater_equal(x, start) & np.less(x, end)) * 1.0


def formula_list(*numbers: Array | float) -> Array:
    """A list of numbers, each of which may vary from pixel to pixel."""
    whole = np.broadcast_arrays(
        *(np.reshape(number, (1, 1, 1)) if np.ndim(number) == 0 else number for number in numbers)
    )
    return np.concatenate(whole, axis=-1)


def pixel_formula(
    a: Array,
    b: Array,
    c: Array,
    d: Array,
    formula: Callable[..., Array | float],
    p: Array | float,
    q: Array | float,
    r: Array | float,
    s: Array | float,
    width: int,
    height: int,
) -> tuple[Array, Array]:
    """Compute every pixel by a formula: a number gives an opaque gray, three an opaque color. And its first channel."""
    x, y = grid(width, height)[..., :1], grid(width, height)[..., 1:]
    places = {"x": x, "y": y, "u": x / width, "v": y / height, "width": float(width), "height": float(height)}
    made = np.asarray(formula(a=a, b=b, c=c, d=d, p=p, q=q, r=r, s=s, **places), float)
    channels = made.shape[-1] if made.ndim else 1
    made = np.broadcast_to(np.nan_to_num(made, nan=0.0, posinf=65504.0, neginf=-65504.0), (height, width, channels))
    if channels < 3:
        made = np.repeat(made, 3, axis=-1) if channels == 1 else np.concatenate([made, 0.0 * made[..., :1]], axis=-1)
    out = made if channels == 4 else np.concatenate([made, np.ones_like(made[..., :1])], axis=-1)
    return out, out[..., :1]
