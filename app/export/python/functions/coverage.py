"""Pixels that two surfaces share: how much each covers, and which pixels nearby lie wholly in them.

Renders filter normals over a pixel: at an edge a normal is the mean of two, N = c F + (1 - c) B, with the coverage c of
the front surface F. Pixels nearby tell F and B, each as far as its surface turns up to here; N and their length say the
rest.
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


def turning(normal: Array) -> Array:
    """The square of the step of an evenly turning normal, from one pixel to the next: its variance is 1 - |N|^2."""
    return 12.0 * np.maximum(1.0 - dot(normal, normal), 0.0)


def known_normals(normal: Array, near: Array, at: Array) -> tuple[Array, Array]:
    """What pixels nearby say of the normals of their surfaces in these ones, where they go on turning; its variance."""
    y, x = np.mgrid[: normal.shape[0], : normal.shape[1]]
    flat = np.where(near > 0.0, unit_normals(normal), 0.0)
    away = at - np.stack([x, y], axis=-1)
    far = at + np.sign(away)
    there, after = pixels_of(flat, at), pixels_of(flat, far)
    size, long = length(there - after), pixels_of(turning(normal), at)
    most = np.where(size < 0.4, np.minimum(np.sqrt(long) / np.maximum(size, 1e-9), 1.0), 0.0)
    inside = ((far >= 0) & (far < (normal.shape[1], normal.shape[0]))).all(axis=-1, keepdims=True)
    inside &= (pixels_of(near, at) > 0.0) & (pixels_of(near, far) > 0.0)
    ahead = unit_normals(there + np.abs(away).max(axis=-1, keepdims=True) * most * (there - after))
    unsure = np.where(pixels_of(near, at) > 0.0, 1e-4 + long * (away**2).sum(axis=-1, keepdims=True), 0.0)
    return np.where(inside, ahead, there), unsure


def share_of_front(mean: Array, back: Array) -> Array:
    """How much the front surface covers, from mean normals and those of the back surface."""
    alone, away = (back == 0.0).all(axis=-1, keepdims=True), mean - back
    toward = np.where(alone, 0.0, -2.0 * dot(away, back))
    return np.clip(np.where(alone, length(mean), dot(away, away) / np.maximum(toward, 1e-6)), 0.0, 1.0)


def left_by_both(mean: Array, first: Array, second: Array) -> Array:
    """The square of what two normals leave of a mean normal, as the best mix of them."""
    apart, off = second - first, mean - first
    left = off - np.clip(dot(off, apart) / np.maximum(dot(apart, apart), 1e-6), 0.0, 1.0) * apart
    return dot(left, left)[..., 0]


def turns_alone(normal: Array, near: Array) -> Array:
    """True where a normal is shorter because one surface turns within the pixel, as the normals beside it do."""
    y, x = np.mgrid[: normal.shape[0], : normal.shape[1]]
    flat, unit, steps = np.where(near > 0.0, unit_normals(normal), 0.0), unit_normals(normal), 0.0
    for right, down in ((1, 0), (0, 1)):
        after, before = (pixels_at(flat, x + way * right, y + way * down) - unit for way in (1, -1))
        least = np.minimum(dot(after, after), dot(before, before))
        steps = steps + np.where(least < 0.5, least, 0.0)
    return ((near > 0.0) & (turning(normal) < 5.0 * steps) & (length(normal) < 0.998))[..., 0]


def stand_ins(normal: Array, near: Array) -> tuple[Array, Array, Array]:
    """x and y of the pixels that stand for the front surface and the one behind it, and where both were found."""
    y, x = np.mgrid[: normal.shape[0], : normal.shape[1]]
    flat = np.where(near > 0.0, unit_normals(normal), 0.0)
    ways = np.array(near_ways())
    costs = np.array([cost_of_standing_in(normal, near, x, y, way) for way in near_ways()])
    best = costs.argmin(axis=0)
    first = np.stack([x, y], axis=-1) + ways[best]
    unit, close = pixels_of(flat, first), pixels_of(near, first)
    for number, way in enumerate(near_ways()):  # the other surface is unlike the first one
        other, there = pixels_at(near, x + way[0], y + way[1]), pixels_at(flat, x + way[0], y + way[1])
        deep = 8.0 * np.abs(close - other) / np.maximum(np.maximum(close, other), 1e-30)
        apart = (dot(unit - there, unit - there) + np.minimum(deep * deep, 1.0))[..., 0]
        cost = costs[number] - np.float32(10.0) * np.minimum(apart, 1.0).astype(np.float32)
        cost = cost + np.float32(100.0) * left_by_both(normal, unit, there).astype(np.float32)
        costs[number] = np.where(apart > 0.02, cost, np.float32(1e9))
    second = np.stack([x, y], axis=-1) + ways[costs.argmin(axis=0)]
    swapped = pixels_of(near, second) > close
    both = (costs.min(axis=0) < 1e8) & ~np.all(ways[best] == 0, axis=-1)
    return np.where(swapped, second, first), np.where(swapped, first, second), both


def surfaces_of_pixels(normal: Array, near: Array) -> tuple[Array, Array, Array]:
    """How much the front surface covers, and x and y of pixels that stand for the front surface and the one behind it.

    Both are the pixel itself where there is only one surface; the share is 1 there, or the length of a normal that
    turns. `near` is 1 / depth.
    """
    y, x = np.mgrid[: normal.shape[0], : normal.shape[1]]
    size, bent = length(normal)[..., 0], turns_alone(normal, near)
    front, back, mixed = stand_ins(normal, near)
    mixed &= (size > 0.004) & ((near[..., 0] <= 0.0) | (size < 0.998)) & ~bent
    here = np.stack([x, y], axis=-1)
    front, back = (np.where(mixed[..., None], at, here) for at in (front, back))
    share = share_by_normals(normal, near, front, back)
    return np.where(mixed[..., None], share, np.where(bent, size, 1.0)[..., None]), front, back


def limits_of_share(normal: Array, near: Array, front: Array, back: Array) -> tuple[Array, Array]:
    """How much the front surface covers, by the normal of the back surface and by that of the front one."""
    by_back = share_of_front(normal, known_normals(normal, near, back)[0])
    return by_back, 1.0 - share_of_front(normal, known_normals(normal, near, front)[0])


def share_by_normals(normal: Array, near: Array, front: Array, back: Array) -> Array:
    """The mean of both, by how well each normal is known."""
    by_back, by_front = limits_of_share(normal, near, front, back)
    ours, theirs = known_normals(normal, near, front)[1], known_normals(normal, near, back)[1]
    both = ours + theirs
    return np.where(both > 0.0, (ours * by_back + theirs * by_front) / np.where(both > 0.0, both, 1.0), by_back)


def normals_of_both(normal: Array, near: Array, share: Array, front: Array, back: Array) -> tuple[Array, Array]:
    """The normals of both surfaces, whose mean is that of the pixel: each is moved as far as it is unsure."""
    (first, ours), (second, theirs) = (known_normals(normal, near, at) for at in (front, back))
    left = normal - share * first - (1.0 - share) * second
    ours, theirs = share * ours, (1.0 - share) * theirs
    left = left / (share * ours + (1.0 - share) * theirs + 1e-3)
    return unit_normals(first + ours * left), unit_normals(second + theirs * left)


def pixels_of(image: Array, at: Array) -> Array:
    """The pixels at x and y."""
    return pixels_at(image, at[..., 0], at[..., 1])


def share_by_color(share: Array, limits: tuple[Array, Array], color: Array, front: Array, back: Array) -> Array:
    """The share of the front surface, where the color of the pixel is a mix of those of both: color knows it better.

    Beyond the limits that normals set it is no mix, such as that of a metal, which shows what it mirrors.
    """
    apart = front - back
    span = dot(apart, apart)
    contrast = span / np.maximum(dot(front, front) + dot(back, back), 1e-12)
    mixed = np.clip(dot(color - back, apart) / np.maximum(span, 1e-12), 0.0, 1.0)
    off = color - back - mixed * apart
    doubt = np.sqrt(dot(off, off) / np.maximum(span, 1e-12))
    trust = np.clip(contrast / 0.005 - 1.0, 0.0, 1.0) * np.clip(2.0 - doubt / 0.05, 0.0, 1.0)
    beyond = mixed - np.clip(mixed, np.minimum(*limits), np.maximum(*limits))
    return mix(share, mixed, trust * np.clip(2.0 - np.abs(beyond) / 0.03, 0.0, 1.0))


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
    found, front, back = surfaces_of_pixels(normal, near)
    mixed = (front != back).any(axis=-1, keepdims=True)
    of_front, of_back = pixels_of(color, front), pixels_of(color, back)
    by_color = share_by_color(found, limits_of_share(normal, near, front, back), color, of_front, of_back)
    share = np.where(mixed, by_color, 1.0)
    ours = np.where(mixed, color_of_front(color, of_front, of_back, share), color)
    facing, behind = normals_of_both(normal, near, share, front, back)
    alone = normal - (1.0 - share) * behind
    turned = np.where(mixed, np.clip(length(alone) / np.maximum(share, 0.02), 0.0, 1.0), found)
    parts = []
    for number, at in enumerate((front, back)):
        unit, there = unit_normals(pixels_of(normal, at)), pixels_of(place, at)
        if camera is not None:
            there = np.where(mixed, place_on_ray(there, unit, camera), there)
        if number == 0:
            parts.append((at, ours, there, np.where(mixed, facing, unit), turned))
        else:
            facing = np.where(mixed, behind, unit)
            parts.append((at, np.where(mixed, color - ours, 0.0), there, facing, np.ones_like(share)))
    return parts
