"""Numbers about pixels: statistics, ranges, and how they are written."""

from __future__ import annotations

import colorsys
from dataclasses import dataclass

import numpy as np

Array = np.ndarray

FAR = 1e8
"""Renderers write larger depths where there is nothing."""

HALF_MAX = 65504.0
"""What infinity becomes in files and nodes."""


@dataclass(frozen=True)
class Statistics:
    """Per channel, of finite numbers; `wrong` counts the pixels that hold others."""

    low: tuple[float, ...]
    mean: tuple[float, ...]
    high: tuple[float, ...]
    wrong: int
    count: int


def statistics(pixels: Array) -> Statistics:
    """Of pixels [h, w, channels]."""
    flat = pixels.reshape(-1, pixels.shape[2]).astype(np.float64)
    finite = np.isfinite(flat)
    low, mean, high = [], [], []
    for index in range(flat.shape[1]):
        kept = flat[finite[:, index], index]
        low.append(float(kept.min()) if kept.size else 0.0)
        mean.append(float(kept.mean()) if kept.size else 0.0)
        high.append(float(kept.max()) if kept.size else 0.0)
    wrong = int((~finite.all(axis=1)).sum())
    return Statistics(tuple(low), tuple(mean), tuple(high), wrong, len(flat))


def data_range(pixels: Array) -> tuple[float, float]:
    """From where to where data [h, w, channels] is worth showing: without stray extremes, and what stands for far."""
    finite = pixels[np.isfinite(pixels)]
    near = finite[(np.abs(finite) < FAR) & (np.abs(finite) != HALF_MAX)]
    finite = near if near.size else finite
    if not finite.size:
        return 0.0, 1.0
    low, high = (float(part) for part in np.percentile(finite, (0.5, 99.5)))
    if high <= low:
        low, high = float(finite.min()), float(finite.max())
    if high <= low:
        return (low, low + 1.0) if low else (0.0, 1.0)
    return low, high


def balanced(low: float, high: float) -> tuple[float, float]:
    """The same range with zero in its middle, where both signs occur: directions, motion."""
    reach = max(abs(low), abs(high))
    return (-reach, reach) if low < 0.0 < high else (low, high)


def are_normals(pixels: Array) -> bool:
    """True if vectors [h, w, 3 or 4] are unit length wherever there is anything."""
    if pixels.shape[2] < 3:
        return False
    length = np.linalg.norm(pixels[..., :3].reshape(-1, 3).astype(np.float64), axis=1)
    there = length[np.isfinite(length) & (length > 1e-4)]
    return bool(there.size) and float((np.abs(there - 1.0) < 0.05).mean()) > 0.95


def written(number: float) -> str:
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


def copied(name: str, pixel: tuple[int, int], values: tuple[float, ...]) -> str:
    """One line for the clipboard: where, and the numbers with all their digits."""
    return f"{name} {pixel[0]} {pixel[1]}: " + " ".join(repr(float(np.float32(one))) for one in values)


def picked_color(values: tuple[float, ...]) -> tuple[float, float, float, float]:
    """A pixel as an opaque, straight, scene-linear color."""
    alpha = values[3] if len(values) == 4 and values[3] > 0.0 else 1.0
    red, green, blue = (values[index if len(values) > 2 else 0] / alpha for index in range(3))
    return red, green, blue, 1.0
