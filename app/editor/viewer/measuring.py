"""Statistics of pixels, and numbers as text."""

from __future__ import annotations

import colorsys

import numpy as np
from msgspec import Struct

Array = np.ndarray


class Statistics(Struct, frozen=True):
    """Statistics per channel, of finite numbers; `wrong` counts pixels with other numbers."""

    low: tuple[float, ...]
    mean: tuple[float, ...]
    high: tuple[float, ...]
    wrong: int
    count: int


def statistics(pixels: Array) -> Statistics:
    """The statistics of pixels [h, w, channels]."""
    flat = pixels.reshape(-1, pixels.shape[2]).astype(np.float64)
    finite = np.isfinite(flat)
    low, mean, high = [], [], []
    for index in range(flat.shape[1]):
        finite_numbers = flat[finite[:, index], index]
        low.append(float(finite_numbers.min()) if finite_numbers.size else 0.0)
        mean.append(float(finite_numbers.mean()) if finite_numbers.size else 0.0)
        high.append(float(finite_numbers.max()) if finite_numbers.size else 0.0)
    wrong = int((~finite.all(axis=1)).sum())
    return Statistics(tuple(low), tuple(mean), tuple(high), wrong, len(flat))


def format_pixel_number(number: float) -> str:
    """A number in at most nine characters."""
    if number != number:
        return "NaN"
    if number in (float("inf"), float("-inf")):
        return "inf" if number > 0 else "-inf"
    size = abs(number)
    if size and (size < 0.0005 or size >= 100000):
        return f"{number:.2e}"
    return f"{number:.{5 if size < 1 else 4 if size < 100 else 2}f}"


def hsv(rgb: tuple[float, ...]) -> tuple[float, float, float]:
    """Hue in degrees, saturation and value of an encoded color."""
    hue, saturation, value = colorsys.rgb_to_hsv(*rgb[:3])
    return hue * 360.0, saturation, value


def format_pixel(name: str, pixel: tuple[int, int], values: tuple[float, ...]) -> str:
    """One line for the clipboard: where, and the numbers with all their digits."""
    return f"{name} {pixel[0]} {pixel[1]}: " + " ".join(repr(float(np.float32(number))) for number in values)


def make_opaque_color(values: tuple[float, ...]) -> tuple[float, float, float, float]:
    """A pixel as an opaque, straight, scene-linear color."""
    alpha = values[3] if len(values) == 4 and values[3] > 0.0 else 1.0
    red, green, blue = (values[index if len(values) > 2 else 0] / alpha for index in range(3))
    return red, green, blue, 1.0
