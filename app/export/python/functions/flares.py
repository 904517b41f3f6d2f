"""Reflections within a lens."""

from __future__ import annotations

import numpy as np

from .blur import blur_gaussian
from .glow import bright_light, enlarge, shrunk
from .hashing import hash3
from .noises import ENDLESS, gradient_noise
from .pixels import Array, join, length, mix, rgb, smoothstep
from .places import bilinear, grid
from .tone import with_hue

MAGNIFICATIONS = (-0.45, -1.0, 0.3, -1.8, -0.25, 0.55, -0.7, 1.4, -2.6, -0.35, 0.8, -1.3)
"""Of the ghosts: negative ones lie on the other side of the axis. Chosen by eye."""


def ghost_light(light: Array, at: Array) -> Array:
    """Light at places [..., 2], which fades out within a tenth of the height before it leaves the picture."""
    height, width = light.shape[:2]
    border = np.minimum(at, np.array([width, height]) - at).min(axis=-1, keepdims=True)
    return bilinear(light, at, "black") * smoothstep(0.0, 0.1 * height, border)


def lens_dust(at: Array, seed: int) -> Array:
    """Discs of dust out of focus, one in each cell, with random sizes and strengths; brighter at the rim."""
    cell = np.floor(at)
    flat = np.zeros_like(cell[..., :1])
    place, look = (hash3(np.concatenate([cell, flat + k], axis=-1), np.full(3, seed)) for k in (0, 1))
    size = mix(0.08, 0.35, look[..., :1] ** 2)
    far = length(at - cell - mix(size, 1.0 - size, place[..., :2])) / size
    return look[..., 1:2] ** 2 * look[..., 2:] * (1.0 - smoothstep(0.85, 1.0, far)) * mix(0.6, 1.0, far)


def lens_smudges(width: int, height: int) -> Array:
    """Wiped grease and dust of three sizes, 0..1. Chosen by eye."""
    at = grid(width, height) / height
    wiped = at @ np.array([[0.8, 0.6], [-0.6, 0.8]]) * (3.0, 9.0)
    grease = 0.0
    for factor, depth, channel, part in ((1.0, 0.5, 0, 1.0), (2.3, 1.5, 1, 0.5)):
        place = np.concatenate([factor * wiped, np.full_like(at[..., :1], depth)], axis=-1)
        noise = gradient_noise(place, np.full(3, 7), np.full(3, ENDLESS))
        grease = grease + part * noise[..., channel : channel + 1]
    dust = lens_dust(at * 6.0, 1) + lens_dust(at * 11.0, 2) + 0.7 * lens_dust(at * 23.0, 3)
    return np.clip(0.25 + 0.25 * grease + dust, 0.0, 1.0)


def ghosts(
    image: Array,
    count: int,
    spread: float,
    ghosts: float,
    halo: float,
    veil: float,
    radius: float,
    softness: float,
    chromatic: float,
    colors: float,
    tint: tuple[float, ...],
    dirt_amount: float,
    center: tuple[float, float],
    threshold: float,
    knee: float,
    limit: float,
    dirt: Array | None = None,
) -> tuple[Array, Array]:
    """A lens flare: the picture with it, and the flare alone (Chapman 2017).

    Ghosts are the bright light out of focus, magnified around the optical axis; the halo is that light, moved away from
    the axis; the veil is light scattered over the whole lens. All are made at half the size.
    """
    height, width = image.shape[:2]
    light = shrunk(bright_light(image, threshold, knee, limit), 2, "clamp")
    rows, columns = light.shape[:2]
    sharp = blur_gaussian(light, max(softness, 4.0) / 2.0, "black")
    axis = np.asarray(center) * (width / 2.0, height / 2.0)
    away = grid(columns, rows) - axis
    outward = away / np.maximum(length(away), 1e-6)
    flare = veil * blur_gaussian(light, 0.15 * rows, "black")[..., :3]
    for channel in range(3):
        larger, channel_mask = 1.0 + chromatic * (1 - channel), np.eye(3)[channel]
        for number, factor in enumerate(MAGNIFICATIONS[:count]):
            coating = mix(1.0, with_hue(np.array([0.2, 0.5, 1.0]), np.array((0.12 + 0.618034 * number) % 1.0)), colors)
            magnified = factor * spread * larger
            seen = ghost_light(sharp, axis + away / magnified)[..., :3]
            flare = flare + ghosts * coating[channel] / magnified**2 * seen * channel_mask
        ring = axis + away - 0.5 * radius * larger * outward
        flare = flare + halo * ghost_light(sharp, ring)[..., :3] * channel_mask
    flare = enlarge(join(flare, np.ones_like(flare[..., :1])), 2, width, height)[..., :3]
    smudges = lens_smudges(width, height) if dirt is None else np.clip(dirt[..., :3], 0.0, 65504.0)
    glow = join(flare * mix(1.0, smudges, dirt_amount) * rgb(tint), image[..., 3:])
    return join(image[..., :3] + glow[..., :3], image[..., 3:]), glow
