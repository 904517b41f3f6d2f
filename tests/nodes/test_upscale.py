"""Upscale against the procedure of FSR 1 as published, in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.distort.resize import Resize
from halation.nodes.distort.upscale import Upscale

Array = np.ndarray
TAPS = ((0, -1), (1, -1), (-1, 1), (0, 1), (0, 0), (-1, 0), (1, 1), (2, 1), (2, 0), (1, 0), (1, 2), (0, 2))
"""b c i j f e k l h g o n: where ffx_fsr1.h reads, from the pixel f."""


def luma(color: Array) -> Array:
    return 0.5 * color[..., 2] + (0.5 * color[..., 0] + color[..., 1])


def easu(picture: Array, width: int, height: int) -> Array:
    """FsrEasuF of AMD's ffx_fsr1.h (v1.20210629) with exact reciprocals; more channels are weighed as color is."""
    rows, columns = picture.shape[:2]
    x = (np.arange(width) + 0.5) * columns / width - 0.5
    y = (np.arange(height) + 0.5) * rows / height - 0.5
    across, down = np.meshgrid(np.floor(x).astype(int), np.floor(y).astype(int))
    px, py = np.meshgrid(x - np.floor(x), y - np.floor(y))

    def tap(right: int, below: int) -> Array:
        return picture[np.clip(down + below, 0, rows - 1), np.clip(across + right, 0, columns - 1)]

    direction, length = np.zeros((2, height, width)), np.zeros((height, width))
    for right, below, weight in (
        (0, 0, (1 - px) * (1 - py)),
        (1, 0, px * (1 - py)),
        (0, 1, (1 - px) * py),
        (1, 1, px * py),
    ):
        a, b, c, d, e = (
            luma(tap(right + i, below + j)) for i, j in ((0, -1), (-1, 0), (0, 0), (1, 0), (0, 1))
        )  # fmt: skip
        for axis, (before, after) in enumerate(((b, d), (a, e))):
            steepest = np.maximum(np.maximum(np.abs(after - c), np.abs(c - before)), 1e-30)
            direction[axis] += (after - before) * weight
            length += np.clip(np.abs(after - before) / steepest, 0, 1) ** 2 * weight
    steep = (direction**2).sum(0)
    flat = steep < 1 / 32768
    scale = np.where(flat, 1.0, 1 / np.sqrt(np.where(flat, 1.0, steep)))
    dx, dy = np.where(flat, 1.0, direction[0]) * scale, direction[1] * scale
    length = (0.5 * length) ** 2
    stretch = (dx * dx + dy * dy) / np.maximum(np.abs(dx), np.abs(dy))
    len_x, len_y = 1 + (stretch - 1) * length, 1 - 0.5 * length
    lobe = 0.5 + (1 / 4 - 0.04 - 0.5) * length
    total, whole = np.zeros((height, width, picture.shape[2])), np.zeros((height, width))
    for i, j in TAPS:
        vx, vy = ((i - px) * dx + (j - py) * dy) * len_x, ((i - px) * -dy + (j - py) * dx) * len_y
        square = np.minimum(vx * vx + vy * vy, 1 / lobe)
        weight = (25 / 16 * (2 / 5 * square - 1) ** 2 - (25 / 16 - 1)) * (lobe * square - 1) ** 2
        total += weight[..., None] * tap(i, j)
        whole += weight
    near = np.stack([tap(i, j) for i, j in ((0, 0), (1, 0), (0, 1), (1, 1))])
    return np.clip(total / whole[..., None], near.min(0), near.max(0))


def rcas(picture: Array, sharpness: float) -> Array:
    """FsrRcasF of the same file; alpha passes. `sharpness` is linear: 2^-stops."""
    padded = np.pad(picture[..., :3], ((1, 1), (1, 1), (0, 0)), mode="edge")
    b, d, e, f, h = padded[:-2, 1:-1], padded[1:-1, :-2], picture[..., :3], padded[1:-1, 2:], padded[2:, 1:-1]
    mn4, mx4 = np.minimum.reduce([b, d, f, h]), np.maximum.reduce([b, d, f, h])
    hit_min, hit_max = mn4 / (4 * mx4), (1 - mx4) / (4 * mn4 - 4)
    lobe = np.maximum(-hit_min, hit_max).max(-1, keepdims=True)
    lobe = np.maximum(-(0.25 - 1 / 16), np.minimum(lobe, 0)) * sharpness
    return np.concatenate([(lobe * (b + d + h + f) + e) / (4 * lobe + 1), picture[..., 3:]], -1)


def draw_edges(width: int = 22, height: int = 17) -> Array:
    """Slanted edges, a ring and some texture, within 0..1."""
    y, x = np.mgrid[:height, :width]
    edge = 1 / (1 + np.exp(-(0.8 * x - 1.3 * y + 4)))
    ring = np.exp(-((np.hypot(x - 12, y - 9) - 5) ** 2))
    texture = np.random.default_rng(4).random((height, width, 4))
    return (0.05 + 0.4 * edge[..., None] + 0.3 * ring[..., None] + 0.2 * texture).astype(np.float32)


@pytest.mark.parametrize("scale", [1.3, 2.0])
@pytest.mark.parametrize("sharpness", [0.0, 0.5, 1.0])
def test_it_is_the_published_procedure(run, scale, sharpness):
    picture = draw_edges()
    out = run(Upscale(scale=scale, sharpness=sharpness, light="display"), {"image": picture})
    codes = easu(np.sqrt(picture.astype(np.float64)), round(22 * scale), round(17 * scale))
    np.testing.assert_allclose(out, np.clip(rcas(codes, sharpness), 0, 1) ** 2, atol=2e-5)


def test_without_a_scale_it_is_rcas(run):
    picture = draw_edges()
    out = run(Upscale(scale=1.0, sharpness=0.7, light="display"), {"image": picture})
    np.testing.assert_allclose(out, np.clip(rcas(np.sqrt(picture.astype(np.float64)), 0.7), 0, 1) ** 2, atol=1e-5)
    assert Upscale(scale=1.0, sharpness=0.0).identity() == "image" and Upscale(sharpness=0.0).identity() is None


def test_light_of_a_scene_goes_through_the_reversible_tone_mapper(run, hdr):
    """FsrSrtmF and FsrSrtmInvF of the same file, around EASU alone."""
    picture = hdr(19, 13, opaque=True)
    light = picture.astype(np.float64)
    light[..., :3] /= 1 + light[..., :3].max(-1, keepdims=True)
    codes = easu(np.sqrt(light), 38, 26) ** 2
    codes[..., :3] /= 1 - codes[..., :3].max(-1, keepdims=True)
    out = run(Upscale(sharpness=0.0), {"image": picture})
    np.testing.assert_allclose(out, codes, rtol=2e-3, atol=1e-4)


def test_even_light_stays_and_nothing_becomes_a_firefly(run):
    for level in (0.0, 0.18, 60.0):
        even = np.full((6, 7, 4), (level, 0.5 * level, level, 1.0), np.float32)
        out = run(Upscale(sharpness=1.0), {"image": even})
        assert out.shape == (12, 14, 4)
        np.testing.assert_allclose(out, np.broadcast_to(even[0, 0], out.shape), rtol=1e-4)
    lamp = np.full((9, 9, 4), 0.2, np.float32)
    lamp[4, 4, :3] = 400.0
    out = run(Upscale(sharpness=1.0), {"image": lamp})
    assert out.min() > 0.19 and out.max() < 402.0


def test_edges_are_steeper_than_those_of_bicubic_and_do_not_ring(run):
    """A slanted edge between 0.1 and 0.9, against the edge at full size and against Catmull-Rom."""
    y, x = np.mgrid[:128, :128] + 0.5
    fine = np.where(0.9 * x - 0.5 * y > 28.0, 0.9, 0.1)
    small = np.repeat(fine.reshape(32, 4, 32, 4).mean((1, 3))[..., None], 4, -1).astype(np.float32)
    truth = fine.reshape(64, 2, 64, 2).mean((1, 3))
    ours = run(Upscale(sharpness=1.0, light="display"), {"image": small})[..., 0]
    cubic = run(Resize(scale=(2.0, 2.0), kernel="catmull-rom"), {"image": small})[..., 0]
    inside = (slice(4, -4), slice(4, -4))
    error, cubic_error = (np.sqrt(((found - truth)[inside] ** 2).mean()) for found in (ours, cubic))
    assert error < 0.8 * cubic_error
