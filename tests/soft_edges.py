"""Soft edges of outlines in 64 bits: means of many places of each pixel, of polygons with a width at each corner."""

from __future__ import annotations

import numpy as np
from polygons import Corners, measure_distance

_CORNER = 0.5**0.5 + 1e-6


def measure_soft_coverage(
    corners: Corners, widths: np.ndarray, size: tuple[int, int], samples: int = 16, hard: int = 96
) -> np.ndarray:
    """How much of each pixel lies inside of a soft edge: the mean at `samples` by `samples` places.

    The edge at a place is as wide as at the corner or side whose distance is the least part of its width, or of a pixel
    if that is more. Where it is narrower than a pixel, there are `hard` by `hard` places.
    """
    height = size[1]
    away = measure_distance(corners, size)
    coverage = (away > 0.0).astype(float)
    following, after = np.roll(corners, -1, axis=0), np.roll(widths, -1)
    sides = corners, following - corners, widths, after
    reach = 0.5 * max(widths.max(), 1.0) + 2.0 * _CORNER
    for row in range(height):
        level = ((corners[:, 1] < row + 1) != (following[:, 1] < row + 1)) | (
            (corners[:, 1] < row) != (following[:, 1] < row)
        )
        level |= (corners[:, 1] >= row) & (corners[:, 1] < row + 1)
        crossing = corners[level], following[level]
        for column in np.nonzero(np.abs(away[row]) < reach)[0]:
            middle = np.array([column + 0.5, row + 0.5])
            near, narrowest = _list_near(sides, middle)
            places = middle + _list_offsets(hard if narrowest < 1.0 else samples)
            inside = _find_inside(crossing, places) if abs(away[row, column]) < _CORNER else away[row, column] > 0.0
            coverage[row, column] = _soften(tuple(side[near] for side in sides), places, inside).mean()
    return coverage


def _list_offsets(samples: int) -> np.ndarray:
    steps = (np.arange(samples) + 0.5) / samples - 0.5
    return np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)


def _list_near(sides: tuple[np.ndarray, ...], middle: np.ndarray) -> tuple[np.ndarray, float]:
    """The sides that can be nearest to a place in a pixel, and the least width of them."""
    start, way, width, after = sides
    rest = middle - start
    t = np.clip((rest * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), 1e-30), 0.0, 1.0)
    away = np.hypot(*(rest - t[:, None] * way).T)
    narrow, wide = np.maximum(np.minimum(width, after), 1.0), np.maximum(np.maximum(width, after), 1.0)
    is_near = (away - _CORNER) / wide <= ((away + _CORNER) / narrow).min()
    return np.nonzero(is_near)[0], np.minimum(width, after)[is_near].min()


def _find_inside(crossing: tuple[np.ndarray, np.ndarray], places: np.ndarray) -> np.ndarray:
    (ax, ay), (bx, by) = (ends.T for ends in crossing)
    x, y = places[:, :1], places[:, 1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossed = ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    return crossed.sum(axis=1) % 2 == 1


def _soften(sides: tuple[np.ndarray, ...], places: np.ndarray, inside: np.ndarray) -> np.ndarray:
    start, way, width, after = sides
    wide = np.maximum(width, 1.0)
    growth = np.maximum(after, 1.0) - wide
    (x, y), (along, down) = (places[:, None] - start).transpose(2, 0, 1), way.T
    run, length = x * along + y * down, np.maximum((way * way).sum(axis=1), 1e-30)
    if growth.any():
        slope = length * wide + growth * run
        least = np.clip((growth * (x * x + y * y) + run * wide) / np.maximum(slope, 1e-30), 0.0, 1.0)
        t = np.where(slope > 0.0, least, growth > 0.0)
    else:
        t = np.clip(run / length, 0.0, 1.0)
    away = np.hypot(x - t * along, y - t * down)
    nearest = np.argmin(away / (wide + t * growth), axis=1)
    at = np.arange(len(places)), nearest
    feather = width[nearest] + (after - width)[nearest] * t[at]
    place = np.clip(0.5 + np.where(inside, away[at], -away[at]) / np.maximum(feather, 1e-9), 0.0, 1.0)
    return place * place * (3.0 - 2.0 * place)
