"""The tasks as loops compiled by numba: what one writes where no library has the effect. `--list` says which."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import numba
import numpy as np

sys.path.append(str(Path(__file__).parents[2]))

from bench.peers.harness import main
from bench.tasks import GOLDEN_ANGLE, LUMINANCE, PUSH, SIGMAS, STEPS, Lens, Occlusion, Ten, scale_length

Array = np.ndarray
compiled: Any = numba.njit(parallel=True, fastmath=True, cache=True)


@compiled
def across(a: Array, weights: Array) -> Array:
    """Rows of a picture with weights that sum to 1."""
    height, width, channels = a.shape
    reach, out = weights.size // 2, np.empty_like(a)
    for y in numba.prange(height):
        line = np.empty((width + 2 * reach, channels), np.float32)
        for x in range(width + 2 * reach):
            line[x] = a[y, min(max(x - reach, 0), width - 1)]
        flat, total = line.reshape(-1), np.zeros(width * channels, np.float32)
        for i in range(weights.size):
            weight = weights[i]
            for x in range(width * channels):
                total[x] += weight * flat[x + i * channels]
        out[y] = total.reshape(width, channels)
    return out


@compiled
def down(a: Array, weights: Array) -> Array:
    """Columns."""
    height, width, channels = a.shape
    flat = a.reshape(height, width * channels)
    reach, out = weights.size // 2, np.empty_like(flat)
    for y in numba.prange(height):
        total = np.zeros(width * channels, np.float32)
        for i in range(weights.size):
            row, weight = flat[min(max(y + i - reach, 0), height - 1)], weights[i]
            for x in range(width * channels):
                total[x] += weight * row[x]
        out[y] = total
    return out.reshape(height, width, channels)


def blur(a: Array, sigma: float) -> Array:
    """T1."""
    reach = math.ceil(4.0 * sigma)
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    weights = (weights / weights.sum()).astype(np.float32)
    return down(across(a, weights), weights)


@compiled
def grade(a, exposure, gain, lift, power, saturation, top, bend, luminance):
    """The first five nodes of T5."""
    height, width, _ = a.shape
    out, none = np.empty_like(a), np.float32(0.0)
    for y in numba.prange(height):
        for x in range(width):
            red = max(a[y, x, 0] * exposure * gain[0] + lift[0], none) ** power
            green = max(a[y, x, 1] * exposure * gain[1] + lift[1], none) ** power
            blue = max(a[y, x, 2] * exposure * gain[2] + lift[2], none) ** power
            gray = red * luminance[0] + green * luminance[1] + blue * luminance[2]
            red = max(gray + (red - gray) * saturation, none)
            green = max(gray + (green - gray) * saturation, none)
            blue = max(gray + (blue - gray) * saturation, none)
            out[y, x, 0], out[y, x, 1] = top * red / (red + bend), top * green / (green + bend)
            out[y, x, 2], out[y, x, 3] = top * blue / (blue + bend), a[y, x, 3]
    return out


@compiled
def finish(x, soft, b, mix, strength):
    """The last four nodes of T5."""
    height, width, _ = x.shape
    out = np.empty_like(x)
    for j in numba.prange(height):
        above, below = max(j - 1, 0), min(j + 1, height - 1)
        for i in range(width):
            left, right = max(i - 1, 0), min(i + 1, width - 1)
            alpha = x[j, i, 3] + (soft[j, i, 3] - x[j, i, 3]) * mix
            for c in range(3):
                rise, fall = x[below, right, c] - x[above, left, c], x[above, right, c] - x[below, left, c]
                gx = rise + fall + 2 * (x[j, right, c] - x[j, left, c])
                gy = rise - fall + 2 * (x[below, i, c] - x[above, i, c])
                light = x[j, i, c] + (soft[j, i, c] - x[j, i, c]) * mix + strength * math.sqrt(gx * gx + gy * gy)
                out[j, i, c] = light + (1 - alpha) * b[j, i, c]
            out[j, i, 3] = alpha + (1 - alpha) * b[j, i, 3]
    return out


def ten(a: Array, b: Array) -> Array:
    """T5."""
    f = np.float32
    x = grade(
        a,
        f(Ten.exposure),
        np.array(Ten.gain, f),
        np.array(Ten.lift, f),
        f(1.0 / Ten.gamma),
        f(Ten.saturation),
        f(Ten.curve[0]),
        f(Ten.curve[1]),
        np.array(LUMINANCE, f),
    )
    return finish(x, blur(x, Ten.sigma), b, f(Ten.mix), f(Ten.edges))


@compiled
def displace(a, noise, push):
    """T6."""
    height, width, channels = a.shape
    out = np.empty_like(a)
    for y in numba.prange(height):
        for x in range(width):
            u = min(max(x + push * noise[y, x, 0], 0.0), width - 1.001)
            v = min(max(y + push * noise[y, x, 1], 0.0), height - 1.001)
            i, j = int(u), int(v)
            s, t = np.float32(u - i), np.float32(v - j)
            for c in range(channels):
                top = a[j, i, c] * (1 - s) + a[j, i + 1, c] * s
                out[y, x, c] = top * (1 - t) + (a[j + 1, i, c] * (1 - s) + a[j + 1, i + 1, c] * s) * t
    return out


@compiled
def occlusion(depth, normal, samples, radius, reach, bias, focal, golden):
    """T7."""
    height, width = depth.shape[:2]
    out, wide = np.empty((height, width, 1), np.float32), width / height / focal
    for y in numba.prange(height):
        for x in range(width):
            far = depth[y, x, 0]
            px, py = ((x + 0.5) / width * 2 - 1) * wide * far, (1 - (y + 0.5) / height * 2) / focal * far
            turn, hidden = ((x * 73 ^ y * 151) & 255) * (2 * math.pi / 256), 0.0
            for i in range(samples):
                part, angle = (i + 0.5) / samples * radius, turn + i * golden
                u = min(max(x + int(math.cos(angle) * part), 0), width - 1)
                v = min(max(y + int(math.sin(angle) * part), 0), height - 1)
                there = depth[v, u, 0]
                dx = ((u + 0.5) / width * 2 - 1) * wide * there - px
                dy = (1 - (v + 0.5) / height * 2) / focal * there - py
                dz = far - there
                square = dx * dx + dy * dy + dz * dz
                rise = dx * normal[y, x, 0] + dy * normal[y, x, 1] + dz * normal[y, x, 2]
                if square < reach * reach:
                    hidden += max(0.0, rise - bias * far) / (square + 1e-3)
            out[y, x, 0] = max(0.0, 1 - 2 * hidden * reach / samples)
    return out


@compiled
def blur_by_depth(a, depth, focus, aperture, largest, samples, golden):
    """T8."""
    height, width, _ = a.shape
    out = np.empty_like(a)
    for y in numba.prange(height):
        for x in range(width):
            here, total = depth[y, x, 0], np.float32(1)
            own = min(abs(here - focus) / here * aperture, largest)
            red, green, blue, alpha = a[y, x, 0], a[y, x, 1], a[y, x, 2], a[y, x, 3]
            for i in range(1, samples):
                radius, angle = math.sqrt(i / samples) * largest, i * golden
                u = min(max(x + int(math.cos(angle) * radius), 0), width - 1)
                v = min(max(y + int(math.sin(angle) * radius), 0), height - 1)
                there = depth[v, u, 0]
                circle = min(abs(there - focus) / there * aperture, largest)
                if there > here:
                    circle = min(circle, own * 2)
                weight = np.float32(min(max(circle - radius + 0.5, 0.0), 1.0))
                red += a[v, u, 0] * weight
                green += a[v, u, 1] * weight
                blue += a[v, u, 2] * weight
                alpha += a[v, u, 3] * weight
                total += weight
            out[y, x, 0], out[y, x, 1] = red / total, green / total
            out[y, x, 2], out[y, x, 3] = blue / total, alpha / total
    return out


@compiled
def blur_by_motion(a, velocity, steps):
    """T9."""
    height, width, _ = a.shape
    out = np.empty_like(a)
    for y in numba.prange(height):
        for x in range(width):
            red, green, blue, alpha = np.float32(0), np.float32(0), np.float32(0), np.float32(0)
            for i in range(steps):
                time = (i + 0.5) / steps - 0.5
                u = min(max(int(x + velocity[y, x, 2] * time + 0.5), 0), width - 1)
                v = min(max(int(y + velocity[y, x, 3] * time + 0.5), 0), height - 1)
                red += a[v, u, 0]
                green += a[v, u, 1]
                blue += a[v, u, 2]
                alpha += a[v, u, 3]
            out[y, x, 0], out[y, x, 1] = red / steps, green / steps
            out[y, x, 2], out[y, x, 3] = blue / steps, alpha / steps
    return out


def _occlusion(depth: Array, normal: Array) -> Array:
    far, width = Occlusion, depth.shape[1]
    return occlusion(
        depth, normal, far.samples, scale_length(far.radius, width), far.reach, far.bias, far.focal, GOLDEN_ANGLE
    )


def _blur_by_depth(a: Array, depth: Array) -> Array:
    width = a.shape[1]
    aperture, largest = scale_length(Lens.aperture, width), scale_length(Lens.largest, width)
    return blur_by_depth(a, depth, Lens.focus, aperture, largest, Lens.samples, GOLDEN_ANGLE)


WORKS = {name: lambda a, sigma=sigma: blur(a, sigma) for name, sigma in SIGMAS.items()}
WORKS |= {
    "copy": lambda a: a,
    "T5": ten,
    "T10": ten,
    "T7": _occlusion,
    "T8": _blur_by_depth,
    "T6": lambda a, noise: displace(a, noise, np.float32(scale_length(PUSH, a.shape[1]))),
    "T9": lambda a, velocity: blur_by_motion(a, velocity, STEPS),
}

if __name__ == "__main__":
    main(WORKS)
