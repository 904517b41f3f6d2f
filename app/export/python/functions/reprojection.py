"""Nodes that find each surface in the frame before, by its velocity, and take a mean with what they remember there."""

from __future__ import annotations

import numpy as np

from .pixels import Array, dot, join, length, luminance_of, mix
from .places import grid, kernel_weight, pixels_at, shift_picture
from .render_layers import nearness, unit_normals
from .time import Clip

AROUND = tuple((right, down) for down in (-1, 0, 1) for right in (-1, 0, 1))
"""A pixel and its eight neighbors."""

# RGB to YCoCg: luma, orange-blue and green-magenta (Malvar and Sullivan 2003).
YCOCG = np.array([[0.25, 0.5, 0.25], [0.5, 0.0, -0.5], [-0.25, 0.5, -0.25]])
YCOCG_TO_RGB = np.array([[1.0, 1.0, -1.0], [1.0, 0.0, 1.0], [1.0, -1.0, -1.0]])


def deviation_around(image: Array) -> tuple[Array, Array, Array]:
    """The mean of 3 x 3 pixels, their standard deviation, and the mean of their squares."""
    around = np.stack([shift_picture(image, right, down) for right, down in AROUND])
    mean, squares = around.mean(axis=0), (around**2).mean(axis=0)
    return mean, np.sqrt(np.maximum(squares - mean**2, 0.0)), squares


def is_inside(places: Array, width: int, height: int) -> Array:
    """Where places, which are whole numbers, lie in the picture."""
    return np.all((places >= 0) & (places < (width, height)), axis=-1, keepdims=True)


def temporal_accumulation(
    image: Array,
    velocity: Array,
    memory: tuple[Array, Array] | None,
    frame: int,
    frames: int,
    gamma: float,
    tolerance: float,
    angle: float,
    depth: Clip | None = None,
    normal: Clip | None = None,
) -> tuple[Array, Array, tuple[Array, Array]]:
    """The mean over frames, along the motion of surfaces (Schied et al. 2017), and of how many frames it is.

    What was hidden in the frame before begins anew. What is remembered is limited to the colors around (Salvi 2016).
    """
    height, width = image.shape[:2]
    newest, first = np.clip(image, -65504.0, 65504.0), np.ones((height, width, 1))
    if memory is None:
        return newest, first, (newest, first)
    before, ages = memory
    places = grid(width, height) - 0.5 - np.clip(velocity[..., :2], -1e6, 1e6)
    corner = np.floor(places).astype(int)
    part = places - corner
    total, age, past = np.zeros_like(first), np.zeros_like(first), np.zeros_like(newest)
    for offset in ((0, 0), (1, 0), (0, 1), (1, 1)):
        at = corner + offset
        share = np.where(np.array(offset) == 1, part, 1.0 - part).prod(axis=-1, keepdims=True)
        same = is_inside(at, width, height)
        if depth is not None:
            near, then = nearness(depth(frame)), pixels_at(nearness(depth(frame - 1)), at[..., 0], at[..., 1])
            same = same & (np.abs(then - near) <= tolerance * np.maximum(then, near))
        if normal is not None:
            now, then = unit_normals(normal(frame)), pixels_at(unit_normals(normal(frame - 1)), at[..., 0], at[..., 1])
            is_background = (now == 0.0).all(axis=-1, keepdims=True) & (then == 0.0).all(axis=-1, keepdims=True)
            same = same & (is_background | (dot(now, then) >= np.cos(angle)))
        weight = np.where(same, share, 0.0)
        past = past + weight * pixels_at(before, at[..., 0], at[..., 1])
        age = age + weight * pixels_at(ages, at[..., 0], at[..., 1])
        total = total + weight
    known = total >= 0.01  # less of four pixels is no memory
    past, age = past / np.where(known, total, 1.0), age / np.where(known, total, 1.0)
    if gamma > 0.0:
        mean, deviation, _ = deviation_around(newest)
        past = np.clip(past, mean - gamma * deviation, mean + gamma * deviation)
    count = np.where(known, np.minimum(age + 1.0, frames), 1.0)
    mean = np.where(known, mix(past, newest, 1.0 / count), newest)
    return mean, count, (mean, count)


def temporal_aa(
    image: Array,
    velocity: Array,
    memory: Array | None,
    frame: int,
    share: float,
    gamma: float,
    weigh_light: bool,
    kernel: str,
    tolerance: float,
    depth: Clip | None = None,
) -> tuple[Array, Array]:
    """Mix each surface with what it was in the result before, limited to the colors around (Karis 2014, Salvi 2016).

    Samples are mixed as c / (1 + luminance), in YCoCg.
    """
    color = np.clip(image[..., :3], -65504.0, 65504.0)
    if weigh_light:
        color = color / (1.0 + np.maximum(luminance_of(color), 0.0))
    now = join(color @ YCOCG.T, image[..., 3:])
    blended = now
    if memory is not None:
        blended = blend_with_past(now, memory, velocity, frame, share, gamma, kernel, tolerance, depth)
    color = blended[..., :3] @ YCOCG_TO_RGB.T
    if weigh_light:
        color = color / np.maximum(1.0 - luminance_of(color), 1.0 / 65505.0)
    return join(color, blended[..., 3:]), blended


def blend_with_past(
    now: Array,
    memory: Array,
    velocity: Array,
    frame: int,
    share: float,
    gamma: float,
    kernel: str,
    tolerance: float,
    depth: Clip | None,
) -> Array:
    """This frame and the one before, as temporal antialiasing mixes them."""
    height, width = now.shape[:2]
    if depth is not None:
        velocity = motion_of_nearest(velocity, nearness(depth(frame)))
    motion = np.clip(velocity[..., :2], -1e6, 1e6)
    places = grid(width, height) - motion
    whole = np.floor(places).astype(int)
    known = is_inside(whole, width, height)
    if depth is not None:
        near, then = nearness(depth(frame)), nearness(depth(frame - 1))
        before = [pixels_at(then, whole[..., 0] + right, whole[..., 1] + down) for right, down in AROUND]
        known = known & np.any([abs(each - near) <= tolerance * np.maximum(each, near) for each in before], axis=0)
    around = np.stack([shift_picture(now, right, down)[..., :3] @ YCOCG_TO_RGB.T for right, down in AROUND])
    darkest = np.minimum(around.min(axis=0), 0.0)
    brightest = np.maximum(np.max([luminance_of(each) for each in around], axis=0), 0.0)
    mean, deviation, squares = deviation_around(now)
    reach = np.maximum(gamma * deviation, 1e-3 * np.maximum(np.abs(mean[..., :1]), 1.0))
    past, brightest = sample_past(memory, places, kernel, brightest)
    # The past moves toward the mean until all channels are within reach, all by the same part.
    farthest = (np.abs(past - mean) / reach).max(axis=-1, keepdims=True)
    limited = mean + (past - mean) / np.maximum(farthest, 1.0)
    part = mix(share, max(share, 0.25), np.minimum(2.0 * length(motion), 1.0))  # reads between pixels blur
    mixed = mix(limited, now, part)
    # The result is never brighter than the brightest sample that was read, and never negative.
    color = np.maximum(mixed[..., :3] @ YCOCG_TO_RGB.T, darkest)
    color = color * np.minimum(1.0, brightest / np.maximum(luminance_of(color), 1e-6))
    cover = np.where(squares[..., 3:] == 0.0, 0.0, np.clip(mixed[..., 3:], 0.0, 1.0))
    return np.where(known, join(color @ YCOCG.T, cover), now)


def motion_of_nearest(velocity: Array, near: Array) -> Array:
    """The motion of the nearest of 3 x 3 pixels, so that the edge moves with the object in front."""
    nearest, motion = near, velocity
    for right, down in AROUND:
        other = shift_picture(near, right, down)
        motion = np.where(other > nearest, shift_picture(velocity, right, down), motion)
        nearest = np.maximum(nearest, other)
    return motion


def sample_past(memory: Array, places: Array, kernel: str, brightest: Array) -> tuple[Array, Array]:
    """What is remembered at places between pixels, and the brightest of what was read."""
    reach = 3 if kernel == "lanczos" else 2
    corner = np.floor(places - 0.5).astype(int)
    total, weights = np.zeros((*places.shape[:2], 4)), np.zeros((*places.shape[:2], 1))
    for down in range(1 - reach, reach + 1):
        y = corner[..., 1:] + down
        row = kernel_weight(y + 0.5 - places[..., 1:], kernel)
        for right in range(1 - reach, reach + 1):
            x = corner[..., :1] + right
            weight = row * kernel_weight(x + 0.5 - places[..., :1], kernel)
            light = pixels_at(memory, x[..., 0], y[..., 0])
            total, weights = total + weight * light, weights + weight
            bright = luminance_of(light[..., :3] @ YCOCG_TO_RGB.T)
            brightest = np.where(weight > 0.0, np.maximum(brightest, bright), brightest)
    return total / weights, brightest
