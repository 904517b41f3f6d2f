"""Measurements of a whole picture."""

from __future__ import annotations

import numpy as np

from .pixels import Array, join, luminance_of, straight
from .places import grid
from .tone import natural_key


def luminance_statistics(image: Array, delta: float, alpha_weighted: bool) -> tuple[Array, Array, Array, Array]:
    """Average, logarithmic average (Reinhard et al. 2002), maximum and minimum of the luminance, as Numbers."""
    color, alpha = straight(image)
    light = luminance_of(color if alpha_weighted else image)
    weight = np.where(alpha > 1e-6, alpha, 0.0) if alpha_weighted else np.ones_like(alpha)
    whole = weight.sum()
    if whole <= 0.0:
        none = np.zeros((1, 1, 1))
        return none, none, none, none
    average = (weight * light).sum() / whole
    log_average = np.exp((weight * np.log(np.maximum(light, 0.0) + delta)).sum() / whole)
    counted = light[weight > 0.0]
    numbers = [np.reshape(number, (1, 1, 1)) for number in (average, log_average, counted.max(), counted.min())]
    return numbers[0], numbers[1], numbers[2], numbers[3]


def histogram(
    image: Array, channel: str, low_percentile: float, middle_percentile: float, high_percentile: float
) -> tuple[Array, Array, Array, Array, Array]:
    """Three percentiles, the mean and the standard deviation of a channel, as Numbers.

    A percentile is the least value that so many percent of the pixels do not exceed.
    """
    at = {"red": 0, "green": 1, "blue": 2, "alpha": 3}
    light = luminance_of(image) if channel == "luminance" else image[..., at[channel]]
    shares = (low_percentile, middle_percentile, high_percentile)
    statistics = [*np.percentile(light, shares, method="inverted_cdf"), light.mean(), light.std()]
    numbers = [np.reshape(number, (1, 1, 1)) for number in statistics]
    return numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]


def histogram_average(light: Array, weight: Array, low: float, high: float) -> float:
    """The geometric mean of the light between two percentiles, from 128 bins of a quarter stop.

    A pixel counts for its two nearest bins by distance.
    """
    place = np.clip((np.log2(np.maximum(light, 1e-9)) + 16.0) / 0.25, 0.0, 127.0)
    first = np.minimum(np.floor(place).astype(int), 126)
    part = place - first
    bins = np.bincount(first, weight * (1.0 - part), 128) + np.bincount(first + 1, weight * part, 128)
    if bins.sum() <= 0.0:
        return 0.0
    sums = np.concatenate([[0.0], np.cumsum(bins / bins.sum())])
    inside = np.diff(np.clip(sums, low, high))
    return float(np.exp2(-16.0 + 0.25 * (inside * np.arange(128)).sum() / max(inside.sum(), 1e-9)))


def auto_exposure(
    image: Array,
    mask: Array | float,
    metering: str,
    low: float,
    high: float,
    key: float,
    auto_key: bool,
    nits: float,
    compensation: float,
    minimum: float,
    maximum: float,
    center_weight: float,
    center: tuple[float, float],
    radius: float,
) -> tuple[Array, Array, Array]:
    """Meter the picture, so that the metered light becomes middle gray: the picture, the stops, and the light."""
    color, alpha = straight(image)
    height, width = image.shape[:2]
    off = (grid(width, height) - np.asarray(center) * (width, height)) / max(radius, 1e-3)
    spot = 1.0 - center_weight * (1.0 - np.exp(-0.5 * (off * off).sum(axis=-1, keepdims=True)))
    weight = (np.where(alpha > 1e-6, alpha, 0.0) * np.maximum(mask, 0.0) * spot).ravel()
    light = luminance_of(np.maximum(color, 0.0)).ravel()
    if metering == "maximum":
        average = float(light[weight > 0.0].max(initial=0.0))
    elif metering == "histogram":
        first = min(low, high, 1.0 - 1e-3)
        average = histogram_average(light, weight, first, max(high, first + 1e-3))
    elif weight.sum() <= 0.0:
        average = 0.0
    elif metering == "average":
        average = float((weight * light).sum() / weight.sum())
    else:
        average = float(np.exp((weight * np.log(light + 1e-5)).sum() / weight.sum()))
    stops = compensation
    if average > 0.0:
        target = 1.0 if metering == "maximum" else float(natural_key(average * nits)) if auto_key else key
        stops += min(max(np.log2(target / average), min(minimum, maximum)), maximum)
    shown = join(image[..., :3] * np.exp2(stops), image[..., 3:])
    return shown, np.full((1, 1, 1), stops), np.full((1, 1, 1), average)
