"""Glare: every light becomes a picture, by convolution."""

from __future__ import annotations

from math import ceil, floor, log2

import numpy as np
from scipy.signal import fftconvolve

from .glow import bright_light
from .noises import ENDLESS, gradient_noise
from .pixels import Array, join, luminance_of, smoothstep
from .places import Edge, bilinear, fold, grid

BRIGHTEST = 65504.0  # the largest half float


def light_to_spread(image: Array) -> Array:
    """The light, with an alpha of 1: after spreading, alpha is the part of the glare that comes from the picture."""
    return join(np.clip(image[..., :3], -BRIGHTEST, BRIGHTEST), np.ones_like(image[..., 3:]))


def light_convolved(light: Array, kernel: Array) -> Array:
    """The convolution with a kernel of odd sides, black beyond the picture."""
    return fftconvolve(light, kernel, mode="same", axes=(0, 1))


def tents_down(light: Array, factor: int, width: int, height: int) -> Array:
    """The light in a smaller picture with one more pixel on each side: sums by tents, not averages."""
    share = 1.0 - np.abs((np.arange(2 * factor) + 0.5) / factor - 1.0)
    for axis, size in ((0, height), (1, width)):
        before = factor + factor // 2
        after = max(size * factor + factor - before - light.shape[axis], 0)
        pads = [(0, 0), (0, 0), (0, 0)]
        pads[axis] = (before, after)
        padded = np.pad(light, pads)
        taps = [share[i] * padded.take(np.arange(size) * factor + i, axis=axis) for i in range(2 * factor)]
        light = np.sum(taps, axis=0)
    return light


def tents_up(small: Array, factor: int, width: int, height: int) -> Array:
    """The smaller picture at the full size again."""
    return bilinear(small, grid(width, height) / factor + 1.0)


def wavelength_lobe(nm: float, middle: float, below: float, above: float) -> float:
    """A Gaussian with different widths below and above its middle."""
    return float(np.exp(-0.5 * ((nm - middle) / (below if nm < middle else above)) ** 2))


def wavelength_color(nm: float) -> Array:
    """Light of one wavelength for the CIE 1931 observer (Wyman, Sloan and Shirley 2013), clipped to Rec.709."""
    x = 1.056 * wavelength_lobe(nm, 599.8, 37.9, 31.0) + 0.362 * wavelength_lobe(nm, 442.0, 16.0, 26.7)
    x -= 0.065 * wavelength_lobe(nm, 501.1, 20.4, 26.2)
    y = 0.821 * wavelength_lobe(nm, 568.8, 46.9, 40.5) + 0.286 * wavelength_lobe(nm, 530.9, 16.3, 31.1)
    z = 1.217 * wavelength_lobe(nm, 437.0, 11.8, 36.0) + 0.681 * wavelength_lobe(nm, 459.0, 26.0, 13.8)
    rows = [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]]
    return np.maximum(np.array(rows) @ np.array([x, y, z]), 0.0)


WAVELENGTHS = [(float(nm), wavelength_color(float(nm))) for nm in range(400, 701, 5)]
"""Wavelengths in nm, with their colors."""


def nearest_odd(size: float) -> int:
    """The nearest odd number of pixels."""
    return 2 * round((size - 1.0) / 2.0) + 1 if size > 1.0 else 1


def kernel_at_size(kernel: Array, width: int, height: int) -> Array:
    """A picture resized to a kernel: each pixel is the mean of the area that it covers, one pixel at least."""
    result = np.clip(kernel[..., :3], 0.0, BRIGHTEST)
    for axis, size in ((0, height), (1, width)):
        scale = result.shape[axis] / size
        middle, covered = (np.arange(size) + 0.5) * scale, 0.5 * max(scale, 1.0)
        low, high = middle - covered, middle + covered
        total = 0.0
        for step in range(ceil(2.0 * covered) + 2):
            i = np.floor(low).astype(int) + step
            share = np.maximum(np.minimum(high, i + 1.0) - np.maximum(low, i), 0.0)
            share = share[:, None, None] if axis == 0 else share[None, :, None]
            total = total + share * np.take(result, fold(i, result.shape[axis], "clamp"), axis=axis)
        result = np.asarray(total)
    return result


def polygon_diffraction(k: Array, blades: int, angle: float) -> Array:
    """The diffraction pattern of a regular polygon of radius 1: the square of its Fourier transform, 1 in the center.

    By the divergence theorem it is a sum over the edges.
    """
    part, square = 2.0 * np.pi / blades, (k * k).sum(axis=-1)
    side, inner, area = 2.0 * np.sin(0.5 * part), np.cos(0.5 * part), 0.5 * blades * np.sin(part)
    total = np.zeros(square.shape, complex)
    for i in range(blades):
        normal = np.array([np.cos(angle + part * i), np.sin(angle + part * i)])
        across, along = k @ normal, 0.5 * side * (k[..., 1] * normal[0] - k[..., 0] * normal[1])
        total += across * side * np.sinc(along / np.pi) * np.exp(1j * across * inner)
    is_far = square >= 1e-3
    return np.where(is_far, np.abs(total) ** 2 / np.where(is_far, square * square * area * area, 1.0), 1.0)


def iris_starburst(size: int, blades: int, angle: float, falloff: float) -> Array:
    """The starburst of an iris in white light: longer wavelengths give larger, fainter patterns."""
    wide = nearest_odd(size * 550.0 / 400.0 + 2.0)
    pitch = 400.0 / size  # units of the Fourier transform per pixel
    n = int(np.clip(np.ceil(pitch), 2.0, 8.0))
    centers = grid(wide, wide) - 0.5 * wide
    offsets = [(np.array([i % n, i // n]) + 0.5) / n - 0.5 for i in range(n * n)]
    patterns = [polygon_diffraction(pitch * (centers + offset), blades, angle) ** falloff for offset in offsets]
    pattern = np.mean(patterns, axis=0)[..., None]
    way = grid(size, size) - 0.5 * size
    shown = 0.0
    for nm, color in WAVELENGTHS:
        scale = 550.0 / nm
        shown = shown + color * scale * scale * bilinear(pattern, 0.5 * wide + scale * way)
    white = np.sum([color for _, color in WAVELENGTHS], axis=0)
    end = 2.0 * np.hypot(way[..., :1], way[..., 1:]) / size
    return shown / white * (1.0 - smoothstep(0.2, 1.0, end))


def glare_kernel(kernel: Array | None, height: float, blades: int, rotation: float, falloff: float) -> Array:
    """A kernel with sum 1, in luminance or for an iris in each channel. Its alpha is its luminance."""
    if kernel is None:
        shape = iris_starburst(nearest_odd(height), blades, -rotation, falloff)
        total = np.maximum(shape.sum(axis=(0, 1)), 1e-20)
    else:
        width = height * kernel.shape[1] / kernel.shape[0]
        shape = kernel_at_size(kernel, nearest_odd(width), nearest_odd(height))
        total = luminance_of(shape.sum(axis=(0, 1)))
    even = shape / total if np.all(total > 0.0) else np.zeros_like(shape)
    return np.concatenate([even, luminance_of(even)], axis=-1)


def kernel_glare(
    image: Array,
    size: float,
    blades: int,
    rotation: float,
    falloff: float,
    intensity: float,
    mode: str,
    threshold: float,
    knee: float,
    limit: float,
    quality: str,
    edge: Edge,
    kernel: Array | None = None,
) -> tuple[Array, Array]:
    """Turn every light into a picture, or into the starburst of an iris (Fraunhofer diffraction at a polygon)."""
    height, width = image.shape[:2]
    factor, lines = {"full": (1, 1), "half": (2, 500), "quarter": (4, 250)}[quality]
    while factor > 1 and height < factor * lines:
        factor //= 2
    is_bright = threshold > 0.0 or limit < BRIGHTEST
    light = light_to_spread(bright_light(image, threshold, knee, limit) if is_bright else image)
    shape = glare_kernel(kernel, size / factor, blades, rotation, falloff)
    down, across = (factor * (side // 2 + 1) if edge != "black" else 0 for side in shape.shape[:2])
    rows = fold(np.arange(-down, height + down), height, edge)
    around = light[np.ix_(rows, fold(np.arange(-across, width + across), width, edge))]
    if factor > 1:
        full_height, full_width = around.shape[:2]
        small = tents_down(around, factor, ceil(full_width / factor) + 2, ceil(full_height / factor) + 2)
        glare = tents_up(light_convolved(small, shape), factor, full_width, full_height) / (factor * factor)
    else:
        glare = light_convolved(around, shape)
    glare = glare[down : down + height, across : across + width]
    taken = glare[..., 3:] * light[..., :3] if mode == "mix" else 0.0
    glow = join(glare[..., :3], image[..., 3:])
    return join(image[..., :3] + intensity * (glow[..., :3] - taken), image[..., 3:]), glow


SCATTERED_SHARES = {
    "photopic": (0.478, 0.138, 0.0),
    "mesopic": (0.478, 0.138, 0.016),
    "scotopic": (0.478, 0.207, 0.033),
}
"""The weights of three terms of scattered light (Spencer et al. 1995); the rest is not scattered."""

HALO_END = 6.0  # degrees, beyond which the halo is dark


def halo_table(count: int) -> Array:
    """The lenticular halo of white light by angle, per steradian: each wavelength makes a ring."""
    angle = (np.arange(count)[:, None] + 0.5) / count * HALO_END
    rings = [
        color * 436.9 * (568.0 / nm) * np.exp(-19.75 * (angle - 3.0 * nm / 568.0) ** 2) for nm, color in WAVELENGTHS
    ]
    return np.sum(rings, axis=0) / np.sum([color for _, color in WAVELENGTHS], axis=0)


def scatter_light(angle: Array, shares: tuple[float, float, float], halo: Array) -> Array:
    """The light that eyes scatter by an angle in degrees, per steradian."""
    away = angle + 0.02
    veil = shares[0] * 20.91 / away**3 + shares[1] * 72.37 / away**2
    at = angle / HALO_END * len(halo) - 0.5
    rings = [np.interp(at, np.arange(len(halo)), halo[:, channel]) for channel in range(3)]
    ring = np.where((angle < HALO_END)[..., None], np.stack(rings, axis=-1), 0.0)
    return veil[..., None] + shares[2] * ring


def corona_rays(way: Array, pixels: float, rays: float) -> Array:
    """The rays of the ciliary corona as a factor with mean 1; rays thinner than pixels fade out."""
    away = np.hypot(way[..., :1], way[..., 1:])
    total = 0.0
    for count in (30.0, 75.0, 187.5):
        width = 2.0 * np.pi * away / (pixels * count)
        place = np.concatenate([way / away * count / (2.0 * np.pi), 0.6 * np.log(away) + count], axis=-1)
        noise = gradient_noise(place, np.zeros(3, int), np.full(3, ENDLESS))[..., :1]
        total = total + smoothstep(2.0, 5.0, width) * noise
    return 1.0 + rays * np.clip(2.0 * total, -1.0, 1.0)


def eye_kernel(
    reach: tuple[int, int], vision: str, pitch: float, cell: int, fade: tuple[float, float], rays: float, halo: Array
) -> Array:
    """The part of a pixel's light that goes to others. A pixel of the kernel covers `cell` pixels of `pitch` degrees.

    Within `fade` the kernel at full size crosses over to the smaller one. Near the center the kernel is steep, so a
    pixel is the mean of many samples.
    """
    width, height = 2 * reach[0] - 1, 2 * reach[1] - 1
    way = cell * (grid(width, height) - 0.5 * np.array([width, height]))
    away = np.hypot(way[..., 0], way[..., 1])
    share = np.ones_like(away)
    if fade[0] != fade[1]:
        share = smoothstep(fade[0], fade[1], away)
        share = 1.0 - share if cell == 1 else share
    share = np.where(away > 0.0, share, 0.0)  # light that stays in its own pixel is left out
    counts = np.ones_like(away)
    if cell == 1:
        counts = np.floor(np.clip(96.0 / np.maximum(away, 1.0), 2.0, 64.0))
    light = np.zeros((height, width, 3))
    for n in np.unique(counts).astype(int):
        here = (counts == n) & (share > 0.0)
        for i in range(n * n):
            inside = way[here] + (np.array([i % n, i // n]) + 0.5) / n - 0.5
            light[here] += (
                scatter_light(pitch * np.hypot(inside[:, 0], inside[:, 1]), SCATTERED_SHARES[vision], halo) / n**2
            )
    safe = np.where(away[..., None] > 0.0, way, 1.0)
    kernel = light * np.radians(pitch) ** 2 * share[..., None] * corona_rays(pitch * safe, pitch * cell, rays)
    return np.concatenate([kernel, kernel.mean(axis=-1, keepdims=True)], axis=-1)


def sharpen_kernel(kernel: Array) -> Array:
    """Without the blur that enlarging with tents adds: a variance of 1/3 square pixel, to second order."""
    padded = np.pad(kernel, ((1, 1), (1, 1), (0, 0)), mode="edge")
    around = padded[:-2, 1:-1] + padded[2:, 1:-1] + padded[1:-1, :-2] + padded[1:-1, 2:]
    return kernel - (around - 4.0 * kernel) / 6.0


def eye_glare(image: Array, vision: str, field_of_view: float, rays: float, strength: float) -> tuple[Array, Array]:
    """The glare of lights in the human eye (Spencer, Shirley, Zimmerman and Greenberg 1995), and the glare alone."""
    height, width = image.shape[:2]
    degrees = float(np.degrees(field_of_view)) / height
    factor = 2 ** max(0, min(4, floor(log2(0.2 / degrees))))
    first, last = 6.0 * factor, 14.0 * factor
    reach = ceil(last)
    light, halo = light_to_spread(image), halo_table(2048)
    if factor == 1 or 2 * reach > max(width, height):
        glare = light_convolved(light, eye_kernel((width, height), vision, degrees, 1, (0.0, 0.0), rays, halo))
    else:
        small = ceil(width / factor) + 2, ceil(height / factor) + 2
        wide = sharpen_kernel(eye_kernel(small, vision, degrees, factor, (first, last), rays, halo))
        far = light_convolved(tents_down(light, factor, *small), wide)
        near = light_convolved(light, eye_kernel((reach, reach), vision, degrees, 1, (first, last), rays, halo))
        glare = near + tents_up(far, factor, width, height)
    glow = join(strength * glare[..., :3], image[..., 3:])
    scattered_light = glare[..., :3] - glare[..., 3:] * light[..., :3]  # a pixel loses what it scatters
    return join(image[..., :3] + strength * scattered_light, image[..., 3:]), glow
