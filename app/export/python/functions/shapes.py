"""Shapes by their distance, and outlines."""

from __future__ import annotations

from typing import Literal

import numpy as np

from .matte import contour_distance
from .pixels import Array, join, length
from .places import grid


def polygon_distance(p: Array, count: int, is_star: bool, inner: float, half: Array) -> Array:
    """The distance to a polygon, or to a star whose odd corners lie further in; below 0 inside (Quilez 2019)."""
    corners = []
    for number in range(count):
        angle = 2.0 * np.pi * number / count
        radius = inner if is_star and number % 2 else 1.0
        corners.append(radius * half * np.array([np.sin(angle), -np.cos(angle)]))
    nearest, outside = np.full(p.shape[:-1], np.inf), np.ones(p.shape[:-1])
    for before, corner in zip([corners[-1], *corners[:-1]], corners, strict=True):
        edge, to = before - corner, p - corner
        t = np.clip((to * edge).sum(axis=-1) / max((edge * edge).sum(), 1e-12), 0.0, 1.0)
        nearest = np.minimum(nearest, ((to - edge * t[..., None]) ** 2).sum(axis=-1))
        crossed = [p[..., 1] >= corner[1], p[..., 1] < before[1], edge[0] * to[..., 1] > edge[1] * to[..., 0]]
        outside = np.where(np.all(crossed, axis=0) | ~np.any(crossed, axis=0), -outside, outside)
    return (outside * np.sqrt(nearest))[..., None]


def shape_distance(
    p: Array, shape: str, size: tuple[float, float], roundness: float, points: int, inner: float
) -> Array:
    """The signed distance of places from a shape around the origin, in pixels."""
    half = 0.5 * np.asarray(size)
    if shape == "ellipse":  # to first order near its edge: the implicit function over its slope
        r = np.maximum(half, 1e-3)
        k, slope = length(p / r), length(p / (r * r))
        return np.where(k < 1e-6, -r.min(), k * (k - 1.0) / np.where(slope > 0.0, slope, 1.0))
    if shape in ("polygon", "star"):
        is_star = shape == "star"
        return polygon_distance(p, 2 * points if is_star else points, is_star, inner, half)
    if shape == "line":
        return np.hypot(np.maximum(np.abs(p[..., :1]) - half[0], 0.0), p[..., 1:]) - half[1]
    corner = roundness * half.min()
    q = np.abs(p) - half + corner
    return length(np.maximum(q, 0.0)) + np.minimum(q.max(axis=-1, keepdims=True), 0.0) - corner


def shape(
    shape: Literal["rectangle", "ellipse", "polygon", "star", "line"],
    center: tuple[float, float],
    size: tuple[float, float],
    rotation: float,
    roundness: float,
    points: int,
    inner: float,
    softness: float,
    invert: bool,
    color: tuple[float, ...],
    width: int,
    height: int,
) -> tuple[Array, Array]:
    """A rectangle, an ellipse, a polygon, a star or a line: filled with a color, and as a mask.

    Coverage is the mean over a grid inside of each pixel that an edge crosses.
    """
    place = grid(width, height) - np.asarray(center) * (width, height)
    cos, sin = np.cos(rotation), np.sin(rotation)
    rotated = np.array([[cos, -sin], [sin, cos]])

    def distance(at: Array) -> Array:
        return shape_distance(at @ rotated, shape, size, roundness, points, inner)

    def cover_at(away: Array) -> Array:
        t = np.clip(0.5 - away / max(softness, 1.0 / 24.0), 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t) if softness > 1.0 / 24.0 else t

    away = distance(place)
    cover = cover_at(away)
    crossed = np.abs(away) < 1.0 + 0.5 * softness
    if min(size) < 4.0 and shape == "ellipse":  # a thin ellipse: its distance is not exact enough
        crossed = np.ones_like(crossed)
    here = crossed[..., 0]
    if here.any():
        side = 24 if softness < 4.0 else 4
        inside = [(np.array([x, y]) + 0.5) / side - 0.5 for y in range(side) for x in range(side)]
        cover[here] = sum(cover_at(distance(place[here] + offset)) for offset in inside) / side**2
    mask = 1.0 - cover if invert else cover
    return np.asarray(color) * mask, mask


def outline(
    image: Array, position: str, width: float, softness: float, color: tuple[float, ...], mask: Array | None = None
) -> tuple[Array, Array]:
    """A line around a mask, or around the picture's own alpha: the picture with it, and the line."""
    contour = contour_distance(image[..., 3:] if mask is None else mask, np.ceil(width + 0.5 * softness) + 2)
    first, last = {
        "outside": (0.0, width),
        "inside": (-width, 0.0),
        "center": (-width / 2.0, width / 2.0),
    }[position]

    def band(first: float, last: float) -> Array:
        fade = 1.0 + softness
        inner, outer = (np.clip((contour - end) / fade + 0.5, 0.0, 1.0) for end in (first, last))
        return inner - outer

    line = band(first, last)
    behind = position == "outside" and mask is None  # then the picture hides what lies under it
    ink = np.array([color[0] * color[3], color[1] * color[3], color[2] * color[3], color[3]])
    ink = ink * (band(-1e6, last) if behind else line)
    shown = image + ink * (1.0 - image[..., 3:]) if behind else ink + image * (1.0 - ink[..., 3:])
    return join(shown[..., :3], shown[..., 3:]), line
