"""Pixels that two surfaces share: how much each covers, and which pixels nearby lie wholly in them.

Renders filter normals over a pixel: at an edge a normal is the mean of two, N = c F + (1 - c) B, with the coverage c of
the front surface F. B is that of a pixel nearby, and F has length 1: both give c and F.
"""

from __future__ import annotations

import numpy as np

from .cameras import camera_back, camera_rays
from .pixels import Array, dot, length, mix
from .places import pixels_at
from .render_layers import unit_normals


def near_ways() -> list[tuple[int, int]]:
    """The ways to all pixels that are up to two away."""
    return [(x, y) for y in range(-2, 3) for x in range(-2, 3)]


def cost_of_standing_in(normal: Array, near: Array, x: Array, y: Array, way: tuple[int, int]) -> Array:
    """How unsuitable pixels are to stand for a surface: their squared distance, and how mixed their normals are.

    Of pixels that are equally good rounding decides, so lengths have 32 bits and are summed from z to x, as by drivers.
    """
    if way == (0, 0):
        return np.full(normal.shape[:2], 1e9, np.float32)
    right, down = x + way[0], y + way[1]
    size = pixels_at(length(normal[..., ::-1].astype(np.float32)), right, down)[..., 0]
    lack = np.where(pixels_at(near, right, down)[..., 0] > 0.0, np.abs(1.0 - size), size)
    inside = (right >= 0) & (right < normal.shape[1]) & (down >= 0) & (down < normal.shape[0])
    cost = np.float32(way[0] ** 2 + way[1] ** 2) + np.float32(100.0) * lack.astype(np.float32)
    return np.where(inside, cost, np.float32(1e9))


def surfaces_of_pixels(normal: Array, near: Array) -> tuple[Array, Array, Array]:
    """How much the front surface covers, and x and y of pixels that stand for the front surface and the one behind it.

    Both are the pixel itself, and the share is 1, where there is only one surface. `near` is 1 / depth.
    """
    y, x = np.mgrid[: normal.shape[0], : normal.shape[1]]
    flat = np.where(near > 0.0, unit_normals(normal), 0.0)
    ways = np.array(near_ways())
    costs = np.array([cost_of_standing_in(normal, near, x, y, way) for way in near_ways()])
    best = costs.argmin(axis=0)
    first = np.stack([x, y], axis=-1) + ways[best]
    unit, close = pixels_at(flat, *np.moveaxis(first, -1, 0)), pixels_at(near, *np.moveaxis(first, -1, 0))
    for number, way in enumerate(near_ways()):  # the other surface is unlike the first one
        other = pixels_at(near, x + way[0], y + way[1])
        turned = unit - pixels_at(flat, x + way[0], y + way[1])
        deep = 8.0 * np.abs(close - other) / np.maximum(np.maximum(close, other), 1e-30)
        apart = (dot(turned, turned) + np.minimum(deep * deep, 1.0))[..., 0]
        cost = costs[number] - np.float32(10.0) * np.minimum(apart, 1.0).astype(np.float32)
        costs[number] = np.where(apart > 0.02, cost, np.float32(1e9))
    second = np.stack([x, y], axis=-1) + ways[costs.argmin(axis=0)]
    size = length(normal)[..., 0]
    mixed = (size > 0.004) & ((near[..., 0] <= 0.0) | (size < 0.998)) & (costs.min(axis=0) < 1e8)
    mixed &= ~np.all(ways[best] == 0, axis=-1)
    swapped = pixels_at(near, *np.moveaxis(second, -1, 0)) > close
    here = np.stack([x, y], axis=-1)
    front = np.where(mixed[..., None], np.where(swapped, second, first), here)
    back = np.where(mixed[..., None], np.where(swapped, first, second), here)
    behind = pixels_at(flat, *np.moveaxis(back, -1, 0))
    away = normal - behind
    toward = np.where((behind == 0.0).all(axis=-1, keepdims=True), 0.0, -2.0 * dot(away, behind))
    alone = (behind == 0.0).all(axis=-1, keepdims=True)
    share = np.where(alone, length(normal), dot(away, away) / np.maximum(toward, 1e-6))
    return np.where(mixed[..., None], np.clip(share, 0.0, 1.0), 1.0), front, back


def pixels_of(image: Array, at: Array) -> Array:
    """The pixels at x and y."""
    return pixels_at(image, at[..., 0], at[..., 1])


def share_by_color(share: Array, color: Array, front: Array, back: Array) -> Array:
    """The share of the front surface, where the color of the pixel is a mix of those of both: color knows it better."""
    apart = front - back
    span = dot(apart, apart)
    contrast = span / np.maximum(dot(front, front) + dot(back, back), 1e-12)
    mixed = np.clip(dot(color - back, apart) / np.maximum(span, 1e-12), 0.0, 1.0)
    off = color - back - mixed * apart
    doubt = np.sqrt(dot(off, off) / np.maximum(span, 1e-12))
    trust = np.clip(contrast / 0.005 - 1.0, 0.0, 1.0) * np.clip(2.0 - doubt / 0.05, 0.0, 1.0)
    return mix(share, mixed, trust)


def color_of_front(color: Array, front: Array, back: Array, share: Array) -> Array:
    """The part of a color that is that of the front surface: what both lack in light is divided in their proportion."""
    ours, theirs = np.maximum(share * front, 0.0), np.maximum((1.0 - share) * back, 0.0)
    both = ours + theirs
    return color * np.where(both > 1e-20, ours / np.maximum(both, 1e-20), share)


def place_on_ray(place: Array, normal: Array, camera: Array) -> Array:
    """The place of a surface on the ray of each pixel, if it goes on from a place nearby as a plane."""
    eye, ray = camera_back(camera)[:, 3], camera_rays(camera, place.shape[1], place.shape[0])
    away, slope = place - eye, dot(normal, ray)
    ahead = dot(ray, away) / dot(ray, ray)
    plane = dot(normal, away) / np.where(slope == 0.0, 1e-30, slope)
    return np.where((plane > 0.9 * ahead) & (plane < 1.1 * ahead), eye + plane * ray, place)


def parts_of_pixels(
    color: Array, normal: Array, near: Array, place: Array, camera: Array | None
) -> list[tuple[Array, Array, Array, Array, Array]]:
    """The one or two surfaces of each pixel, the front one first.

    Of each the pixel that stands for it, its part of the color, its place and normal, and how much less light falls on
    it as its normal turns within the pixel.
    """
    share, front, back = surfaces_of_pixels(normal, near)
    mixed = (front != back).any(axis=-1, keepdims=True)
    flat = np.where(near > 0.0, unit_normals(normal), 0.0)
    of_front, of_back = pixels_of(color, front), pixels_of(color, back)
    share = np.where(mixed, share_by_color(share, color, of_front, of_back), share)
    ours = np.where(mixed, color_of_front(color, of_front, of_back, share), color)
    alone = normal - (1.0 - share) * pixels_of(flat, back)
    turned = np.where(mixed, np.clip(length(alone) / np.maximum(share, 0.02), 0.0, 1.0), 1.0)
    alone = alone + 0.02 * pixels_of(flat, front)
    facing = np.where(length(alone) > 0.0, alone / np.maximum(length(alone), 1e-30), pixels_of(flat, front))
    parts = []
    for number, at in enumerate((front, back)):
        unit, there = unit_normals(pixels_of(normal, at)), pixels_of(place, at)
        if camera is not None:
            there = np.where(mixed, place_on_ray(there, unit, camera), there)
        if number == 0:
            parts.append((at, ours, there, np.where(mixed, facing, unit), turned))
        else:
            parts.append((at, np.where(mixed, color - ours, 0.0), there, unit, np.ones_like(share)))
    return parts
