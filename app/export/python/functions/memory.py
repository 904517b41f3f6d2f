"""Nodes that remember the frame before: their last result is what they want to be given in the next frame.

In the first frame there is no `memory`.
"""

from __future__ import annotations

from math import exp

import numpy as np

from .merge import screen
from .pixels import Array, join, luminance_of, mix, smoothstep, straight
from .places import Edge, cubic_weight, grid, pixels_at
from .tone import hue_of, natural_key, with_hue


def part_left(time: float, rate: float) -> float:
    """What is left after one frame of what falls to 1 / e in a time in seconds."""
    return exp(-1.0 / (rate * time)) if time > 0.0 else 0.0


def frame_blend(
    image: Array, memory: Array | None, rate: float, mode: str, time: float, persistence: float
) -> tuple[Array, Array]:
    """`y = (1 - a) x + a y'`, where y' is the result of the frame before."""
    kept = persistence if mode == "persistence" else part_left(time, rate)
    shown = image if memory is None else mix(image, memory, kept)
    return shown, shown


def light_trails(
    image: Array,
    memory: Array | None,
    rate: float,
    fade: str,
    time: float,
    threshold: float,
    knee: float,
    intensity: float,
) -> tuple[Array, Array, Array]:
    """`trail = max(bright, a trail')`, where trail' is that of the frame before: the picture, and the trails alone."""
    light = np.maximum(image[..., :3], 0.0)
    if threshold > 0.0:
        low, high = threshold * (1.0 - knee), threshold * (1.0 + knee) + 1e-6
        light = light * smoothstep(low, high, luminance_of(light))
    trail = np.minimum(light, 65504.0)
    if memory is not None:
        trail = np.maximum(trail, (1.0 if fade == "never" else part_left(time, rate)) * memory)
    shown = join(np.maximum(image[..., :3], intensity * trail), image[..., 3:])
    return shown, join(intensity * trail, np.zeros((1, 1, 1))), trail


def feedback(
    image: Array,
    memory: Array | None,
    position: tuple[float, float],
    rotation: float,
    scale: float,
    pivot: tuple[float, float],
    hue: float,
    decay: float,
    mode: str,
    ceiling: float,
    edge: Edge,
) -> tuple[Array, Array]:
    """The picture on the result of the frame before, which is turned, scaled, moved, faded and turned in hue."""
    height, width = image.shape[:2]
    before = limit_light(image, ceiling) if memory is None else memory
    center, cos, sin = np.multiply(pivot, (width, height)), np.cos(rotation), np.sin(rotation)
    turn = np.array([[cos, sin], [-sin, cos]]) / max(scale, 1e-3)
    places = (grid(width, height) - center - position) @ turn.T + center
    past = decay * sample_catmull_rom(before, places, min(max(1.0 / max(scale, 1e-3), 1.0), 8.0), edge)
    if hue != 0.0:
        past = join(with_hue(past[..., :3], hue_of(past) + hue / (2.0 * np.pi)), past[..., 3:])
    color, alpha, light, cover = image[..., :3], image[..., 3:], past[..., :3], past[..., 3:]
    if mode == "brightest":
        shown = np.maximum(image, past)
    elif mode == "add":
        shown = join(color + light, np.minimum(alpha + cover, 1.0))
    elif mode == "screen":
        shown = join(screen(np.maximum(color, 0.0), light), alpha + cover * (1.0 - alpha))
    elif mode == "over":
        shown = image + (1.0 - alpha) * past
    else:
        shown = (1.0 - decay) * image + past  # the past has faded already
    return shown, limit_light(shown, ceiling)


def limit_light(image: Array, ceiling: float) -> Array:
    """Light between 0 and a ceiling."""
    return join(np.clip(image[..., :3], 0.0, ceiling), np.clip(image[..., 3:], 0.0, 1.0))


def sample_catmull_rom(image: Array, places: Array, stretch: float, edge: str) -> Array:
    """The picture at places between its pixels, by Catmull-Rom interpolation, within the range of the four around."""
    reach = int(np.ceil(2.0 * stretch)) + 1
    corner = np.floor(places - 0.5).astype(int)
    total, weights = 0.0, 0.0
    low, high = np.inf, -np.inf
    for down in range(1 - reach, reach + 1):
        y = corner[..., 1:] + down
        row = cubic_weight((y + 0.5 - places[..., 1:]) / stretch, 0.0, 0.5)
        for right in range(1 - reach, reach + 1):
            x = corner[..., :1] + right
            weight = row * cubic_weight((x + 0.5 - places[..., :1]) / stretch, 0.0, 0.5)
            pixels = pixels_at(image, x[..., 0], y[..., 0], edge)
            total, weights = total + weight * pixels, weights + weight
            if down in (0, 1) and right in (0, 1):
                low, high = np.minimum(low, pixels), np.maximum(high, pixels)
    return np.clip(total / weights, low, high)


def eye_adaptation(
    image: Array,
    memory: Array | None,
    rate: float,
    model: str,
    to_bright: float,
    to_dark: float,
    scale: str,
    key: float,
    nits: float,
    minimum: float,
    maximum: float,
    compensation: float,
    luminance: Array | None = None,
) -> tuple[Array, Array, Array, Array]:
    """Expose by a luminance that follows that of the picture: the picture, the stops, and the luminance.

    Natural eyes: time constants and key of Krawczyk et al. (2005).
    """
    if luminance is None:
        color, alpha = straight(image)
        weight = np.where(alpha > 1e-6, alpha, 0.0)
        logarithms = np.log(luminance_of(np.maximum(color, 0.0)) + 1e-5)
        seen = np.exp((weight * logarithms).sum() / weight.sum()) if weight.sum() > 0.0 else 1e-5
    else:
        seen = np.clip(luminance, 1e-5, 1e9)
    before = seen if memory is None else memory
    if model == "custom":
        time = np.where(seen > before, to_bright, to_dark)
    else:
        time = mix(0.1, 0.4, 0.04 / (0.04 + seen * nits))  # of cones and rods, in seconds
    kept = np.where(time > 0.0, np.exp(-1.0 / rate / np.where(time > 0.0, time, 1.0)), 0.0)
    adapted = seen * (before / seen) ** kept if scale == "stops" else mix(seen, before, kept)
    adapted = np.reshape(adapted, (1, 1, 1))
    wanted = natural_key(adapted * nits) if model == "natural" else key
    stops = np.clip(np.log2(wanted / adapted), min(minimum, maximum), maximum) + compensation
    return join(image[..., :3] * np.exp2(stops), image[..., 3:]), stops, adapted, adapted
