"""Pictures from formulas."""

from __future__ import annotations

import numpy as np

from .hashing import hash3, stream_of
from .noises import (
    ENDLESS,
    gradient_noise,
    lattice_density,
    lattice_inside,
    lattice_period,
    lattice_place,
    lattice_places,
    lattice_wrap,
    simplex_noise,
    simplex_slope,
    value_noise,
    white_noise,
)
from .pixels import Array, as_image, length, mix, smoothstep
from .places import grid


def constant(color: Array | tuple[float, ...], width: int, height: int) -> Array:
    """One color everywhere."""
    return np.broadcast_to(np.asarray(color, np.float64), (height, width, 4))


def checker(
    size: float, first: Array, second: Array, offset: tuple[float, float], width: int, height: int
) -> tuple[Array, Array]:
    """A checkerboard: the picture, and 0 or 1."""
    square = np.floor((grid(width, height) - np.asarray(offset)) / np.maximum(size, 1e-3))
    value = square.sum(axis=-1, keepdims=True) % 2.0
    return np.where(value == 0.0, np.asarray(first), np.asarray(second)), value


def ramp(
    shape: str,
    start: tuple[float, float],
    end: tuple[float, float],
    first: Array,
    second: Array,
    smoothness: float,
    width: int,
    height: int,
) -> tuple[Array, Array]:
    """A gradient along a line, outward from a point, or around a point like a clock hand: the picture, and 0..1."""
    position = grid(width, height) - np.asarray(start) * (width, height)
    axis = np.broadcast_to((np.asarray(end) - np.asarray(start)) * (width, height), position.shape)
    if shape == "linear":
        t = (position * axis).sum(axis=-1, keepdims=True) / np.maximum((axis * axis).sum(axis=-1, keepdims=True), 1e-12)
    elif shape == "radial":
        t = length(position) / np.maximum(length(axis), 1e-6)
    else:
        t = (np.arctan2(position[..., 1:], position[..., :1]) - np.arctan2(axis[..., 1:], axis[..., :1])) / (2 * np.pi)
        t = t - np.floor(t)
    t = np.clip(t, 0.0, 1.0)
    value = mix(t, smoothstep(0.0, 1.0, t), smoothness)
    return mix(np.asarray(first), np.asarray(second), value), value


NOISES = {"gradient": gradient_noise, "value": value_noise, "white": white_noise, "simplex": simplex_noise}


def noise_layers(
    kind: str,
    fractal: str,
    place: Array,
    tiles: Array,
    octaves: int,
    lacunarity: float,
    gain: float,
    contrast: float,
    seed: int,
) -> Array:
    """Three independent noises in layers: fBm (Mandelbrot and van Ness 1968), ridged (Musgrave 1994), turbulence."""
    folded = fractal in ("ridged", "turbulence")
    total, carried, strength, density, whole = 0.0, 1.0, 1.0, 1.0, 0.0
    for octave in range(octaves):
        period = lattice_period(tiles, density, 6 if kind == "simplex" else 1)
        p = place * lattice_density(tiles, density, period)
        layer = NOISES[kind](p, stream_of(seed, octave, 0), period)
        if folded:
            layer = np.minimum(np.abs(layer * contrast), 1.0)
        if fractal == "ridged":  # finer layers only on ridges of coarser ones
            layer = (1.0 - layer) ** 2 * carried
            carried = np.minimum(2.0 * layer, 1.0)
        total = total + strength * layer
        whole, strength, density = whole + strength, strength * gain, density * lacunarity
    total = np.asarray(total / max(whole, 1e-6))
    return total * 2.0 - 1.0 if folded else np.clip(total * contrast, -1.0, 1.0)


def noise(
    kind: str,
    size: float,
    octaves: int,
    lacunarity: float,
    gain: float,
    contrast: float,
    seed: int,
    evolution: float,
    fractal: str,
    warp: float,
    offset: tuple[float, float],
    period: tuple[float, float],
    loop: float,
    width: int,
    height: int,
) -> tuple[Array, Array, Array]:
    """Noise in layers: the picture, the same as a Field, and two more noises as a vector."""
    place, tiles = lattice_places(size, offset, period, evolution, loop, width, height)
    if fractal == "warped":  # Quilez 2002: a noise moves the places where the noise is read
        bend = noise_layers(kind, fractal, place, tiles, octaves, lacunarity, gain, 1.0, seed)
        place = place + np.concatenate([warp * bend[..., 1:], np.zeros_like(bend[..., :1])], axis=-1)
    total = noise_layers(kind, fractal, place, tiles, octaves, lacunarity, gain, contrast, seed)
    value = 0.5 + 0.5 * total[..., :1]
    return as_image(value), value, total[..., 1:]


def worley(
    feature: str,
    metric: str,
    size: float,
    jitter: float,
    seed: int,
    evolution: float,
    offset: tuple[float, float],
    period: tuple[float, float],
    loop: float,
    width: int,
    height: int,
) -> tuple[Array, Array, Array]:
    """Cells (Worley 1996): the distance from the nearest of scattered points, one in every cell of a cubic lattice."""
    place, tiles = lattice_places(size, offset, period, evolution, loop, width, height)
    cells = lattice_period(tiles, 1.0, 1)
    p = lattice_inside(place * lattice_density(tiles, 1.0, cells), cells)
    middle = np.floor(p).astype(np.int64)
    nearest, second, winner = np.full((height, width, 1), 1e9), np.full((height, width, 1), 1e9), middle
    for i in range(27):
        beside = np.array([i % 3, i // 3 % 3, i // 9]) - 1
        point = 0.5 + jitter * (hash3(lattice_wrap(middle + beside, cells), stream_of(seed, 0, 1)) - 0.5)
        away = np.abs(beside + point - (p - middle))
        if metric == "manhattan":
            far = away.sum(axis=-1, keepdims=True)
        else:
            far = away.max(axis=-1, keepdims=True) if metric == "chebyshev" else length(away)
        winner = np.where(far < nearest, middle + beside, winner)
        second = np.minimum(second, np.maximum(far, nearest))
        nearest = np.minimum(nearest, far)
    value = {"f1": nearest, "f2": second}.get(feature, second - nearest)
    return as_image(value), value, hash3(lattice_wrap(winner, cells), stream_of(seed, 0, 2))


def wave(
    pattern: str,
    profile: str,
    wavelength: float,
    angle: float,
    phase: float,
    center: tuple[float, float],
    distortion: float,
    size: float,
    seed: int,
    width: int,
    height: int,
) -> tuple[Array, Array]:
    """Waves in straight bands or in rings: as sines, triangles, saws or squares."""
    at = grid(width, height)
    away = at - np.asarray(center) * (width, height)
    along = away[..., :1] * np.cos(angle) + away[..., 1:] * np.sin(angle)
    place = np.concatenate([at / np.maximum(size, 1e-3), np.zeros_like(at[..., :1])], axis=-1)
    bend = distortion * simplex_noise(place, np.array([seed, 0, 0]), np.full(3, ENDLESS))[..., :1]
    cycles = (length(away) if pattern == "rings" else along) / np.maximum(wavelength, 1e-3) - phase + bend
    t = cycles - np.floor(cycles)
    value = {
        "sine": 0.5 - 0.5 * np.cos(2.0 * np.pi * t),
        "triangle": 1.0 - np.abs(2.0 * t - 1.0),
        "saw": t,
        "square": np.where(t < 0.5, 0.0, 1.0),
    }[profile]
    return as_image(value), value


def brick_length(at: Array, period: float, mortar: float) -> Array:
    """How much brick lies between 0 and `at`, along an axis with joints around multiples of the period."""
    whole = np.floor(at / period)
    return whole * (period - mortar) + np.clip(at - whole * period - 0.5 * mortar, 0.0, period - mortar)


def brick(
    width: float,
    height: float,
    mortar: float,
    shift: float,
    every: int,
    first: Array,
    second: Array,
    joint: Array,
    variety: float,
    seed: int,
    offset: tuple[float, float],
    columns: int,
    rows: int,
) -> tuple[Array, Array, Array]:
    """A wall with antialiased joints: the picture, how much of a pixel is brick, and a number of each brick."""
    wide, high = max(width, 1e-2), max(height, 1e-2)
    across, down = min(mortar, wide), min(mortar, high)
    at = grid(columns, rows) - np.asarray(offset)
    x, y = at[..., :1], at[..., 1:]

    def move_row(row: Array) -> Array:
        return x - np.where((row % every >= every - 1) & (every > 1), shift * wide, 0.0)

    value = np.zeros_like(x)
    low, high_row = np.floor((y - 0.5) / high), np.floor((y + 0.5) / high)
    for row, top, bottom in (  # a pixel lies in two rows at most
        (low, y - 0.5, np.where(high_row > low, high_row * high, y + 0.5)),
        (high_row, np.where(high_row > low, high_row * high, y + 0.5), y + 0.5),
    ):
        part = brick_length(bottom, high, down) - brick_length(top, high, down)
        place = move_row(row)
        value += part * (brick_length(place + 0.5, wide, across) - brick_length(place - 0.5, wide, across))
    value = np.clip(value, 0.0, 1.0)
    row = np.floor(y / high)
    cell = np.concatenate([np.floor(move_row(row) / wide), row, np.zeros_like(row)], axis=-1)
    random = hash3(cell, stream_of(seed, 0, 0))[..., :1]
    color = mix(np.asarray(first), np.asarray(second), 0.5 + (random - 0.5) * variety)
    return mix(np.asarray(joint), color, value), value, random


def curl_noise(
    size: float,
    octaves: int,
    lacunarity: float,
    gain: float,
    strength: float,
    seed: int,
    evolution: float,
    offset: tuple[float, float],
    period: tuple[float, float],
    loop: float,
    width: int,
    height: int,
) -> tuple[Array, Array]:
    """A flow without sources: the derivatives of layers of simplex noise, turned by a quarter (Bridson et al. 2007).

    The second result is the noise itself, along whose contour lines the flow runs.
    """
    place, tiles = lattice_places(size, offset, period, evolution, loop, width, height)
    flow, stream, part, density, steepest = 0.0, 0.0, 1.0, 1.0, 0.0
    for octave in range(octaves):
        cells = lattice_period(tiles, density, 6)
        dense = lattice_density(tiles, density, cells)
        random = stream_of(seed, octave, 0)
        slope = simplex_slope(place * dense, random, cells)
        flow = flow + part * np.stack([dense[1] * slope[..., 1], -dense[0] * slope[..., 0]], axis=-1)
        stream = stream + part * simplex_noise(place * dense, random, cells)[..., :1]
        steepest += part * max(density, *dense[:2])
        part, density = part * gain, density * lacunarity
    most = steepest * 3.44793  # the steepest slope of one layer in a plane of two axes
    return np.asarray(flow * strength / most), np.asarray(stream * strength / most)


def gabor_noise(
    wavelength: float,
    radius: float,
    angle: float,
    spread: float,
    waves: int,
    contrast: float,
    seed: int,
    evolution: float,
    offset: tuple[float, float],
    period: tuple[float, float],
    width: int,
    height: int,
) -> tuple[Array, Array]:
    """Waves within Gaussians at random places (Lagae et al. 2009), equally many in each cell (Tavernier et al. 2019).

    Cells are as large as a wave reaches, or a little larger, so that a whole number of them fits the period.
    """
    end = np.exp(-np.pi)  # the Gaussian at its radius, which is taken away so that waves end there
    tiles = np.array(period)
    tile = min((side for side in period if side > 0.0), default=np.inf)
    reach = radius * max(wavelength, 1e-3)
    turns, reach = radius * min(reach, tile) / reach, min(reach, tile)
    counts = np.where(tiles > 0.0, np.maximum(np.floor(tiles / reach), 1.0), 1.0)
    side = np.where(tiles > 0.0, tiles / (counts * reach), 1.0)
    cells = np.append(np.where(tiles > 0.0, counts, ENDLESS), ENDLESS).astype(np.int64)
    place = lattice_place(grid(width, height) - np.asarray(offset), reach, period, 0.0, 0.0)[..., :2] / side
    place = lattice_inside(np.concatenate([place, np.zeros_like(place[..., :1])], axis=-1), cells)
    corner = np.floor(place).astype(np.int64)
    total = 0.0
    for i in range(9):
        beside = np.array([i % 3 - 1, i // 3 - 1, 0])
        cell, away = lattice_wrap(corner + beside, cells), (place - corner - beside)[..., :2] * side
        for wave in range(waves):
            stream = stream_of(seed, wave, 3)
            start, dice = hash3(cell, stream), hash3(cell + np.array([0, 0, 1]), stream)
            p = away - start[..., :2] * side
            square = (p * p).sum(axis=-1, keepdims=True)
            direction = angle + spread * (2.0 * dice[..., :1] - 1.0)
            phase = start[..., 2:] + np.where(dice[..., 1:2] < 0.5, evolution % 1.0, -(evolution % 1.0))
            crest = np.cos(
                2.0 * np.pi * (turns * (p[..., :1] * np.cos(direction) + p[..., 1:] * np.sin(direction)) + phase)
            )
            total = total + np.where(square < 1.0, (np.exp(-np.pi * square) - end) / (1.0 - end) * crest, 0.0)
    # 0.461243: the integral of the squared window over a disc of radius 1
    deviation = np.sqrt(waves * 0.461243 / (2.0 * side[0] * side[1]))
    value = 0.5 + 0.5 * np.clip(contrast * np.asarray(total) / (3.0 * deviation), -1.0, 1.0)
    return as_image(value), value
