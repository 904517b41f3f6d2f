"""Blurs and sharpening."""

from __future__ import annotations

from math import ceil, floor

import numpy as np
from scipy import ndimage
from scipy.optimize import brentq
from scipy.special import erf, erfc

from .pixels import Array, join, length, luminance_of
from .places import Edge, bilinear, grid, shift_picture

MODES = {"clamp": "nearest", "mirror": "mirror", "reflect": "reflect", "wrap": "wrap", "black": "constant"}
"""The names of edge modes in scipy."""


def gaussian_weights(sigma: float) -> Array:
    """A normalized Gaussian out to four sigmas; below one pixel it is integrated over each pixel."""
    radius = int(4.0 * sigma + 0.5) if sigma >= 1.0 else ceil(4.0 * sigma)
    i = np.arange(-radius, radius + 1)
    if sigma >= 1.0:
        weights = np.exp(-0.5 * (i / sigma) ** 2)
    else:
        half = sigma * np.sqrt(2.0)
        weights = erf((i + 0.5) / half) - erf((i - 0.5) / half)
    return weights / weights.sum()


def convolve_axis(image: Array, weights: Array, axis: int, edge: str) -> Array:
    """The picture with centered weights along one axis: 0 is down, 1 is across."""
    return ndimage.correlate1d(image, weights, axis=axis, mode=MODES[edge])


def blur_gaussian(image: Array, sigma: float, edge: str) -> Array:
    """The picture blurred with a Gaussian."""
    for axis in (1, 0) if sigma > 0.0 else ():
        image = convolve_axis(image, gaussian_weights(sigma), axis, edge)
    return image


def gaussian_blur(image: Array, sigma: float, scale: tuple[float, float], edge: Edge) -> Array:
    """Blur with a Gaussian, along x and along y."""
    for axis, part in ((1, scale[0]), (0, scale[1])):
        if sigma * part > 0.0:
            image = convolve_axis(image, gaussian_weights(sigma * part), axis, edge)
    return image


def box_blur(image: Array, kind: str, radius: float, edge: Edge) -> Array:
    """Blur with one box, 2 radius + 1 pixels wide, or with two or three smaller ones (tent; Wells 1986)."""
    times = {"box": 1, "tent": 2, "iterated": 3}[kind]
    radius = radius / times
    whole = floor(radius)
    box = np.ones(2 * whole + 3)
    box[[0, -1]] = radius - whole  # the pixels at the ends count in part
    weights = np.ones(1)
    for _ in range(times):
        weights = np.convolve(weights, box / (2.0 * radius + 1.0))
    return convolve_axis(convolve_axis(image, weights, 1, edge), weights, 0, edge)


def directional_blur(image: Array, angle: float, length: float, shift: float, edge: Edge) -> Array:
    """The mean along a straight line, sampled at least once per pixel (midpoint rule)."""
    height, width = image.shape[:2]
    line = length * np.array([np.cos(angle), -np.sin(angle)])
    count = max(ceil(length), 1)
    total = np.zeros_like(image)
    for i in range(count):
        t = (i + 0.5) / count - 0.5 + shift
        total += bilinear(image, grid(width, height) - t * line, edge) / count
    return total


def radial_blur(image: Array, kind: str, zoom: float, angle: float, center: tuple[float, float], edge: Edge) -> Array:
    """The mean along an arc around the center (spin), or along the line through it (zoom)."""
    height, width = image.shape[:2]
    middle = np.asarray(center) * (width, height)
    away = grid(width, height) - middle
    spread = length(away) * (zoom if kind == "zoom" else angle)
    counts = np.clip(np.ceil(spread), 1, 512)
    total = np.zeros_like(image)
    for i in range(int(counts.max())):
        t = (i + 0.5) / counts - 0.5
        if kind == "zoom":
            moved = away * (1.0 + t * zoom)
        else:
            cos, sin = np.cos(t * angle), np.sin(t * angle)
            x, y = away[..., :1], away[..., 1:]
            moved = np.concatenate([cos * x - sin * y, sin * x + cos * y], axis=-1)
        total += np.where(i < counts, bilinear(image, middle + moved, edge) / counts, 0.0)
    return total


def median(image: Array, window: str, edge: Edge) -> Array:
    """The median of each channel in a square of 3 x 3 or 5 x 5 pixels."""
    side = int(window[0])
    return ndimage.median_filter(image, size=(side, side, 1), mode=MODES[edge])


def bilateral_blur(image: Array, sigma: float, sigma_range: float, edge: Edge, guide: Array | None = None) -> Array:
    """Weigh neighbors by distance and by likeness (Tomasi and Manduchi 1998), or by the likeness of a guide.

    exp(-d^2 / (2 sigma^2) - c^2 / (2 sigma_range^2)) within 1.5 sigma, where c is the difference of the color.
    """
    guide = image if guide is None else guide
    radius = max(round(1.5 * sigma), 1)
    total, whole = np.zeros_like(image), np.zeros_like(image[..., :1])
    for y in range(-radius, radius + 1):
        for x in range(-radius, radius + 1):
            if x * x + y * y > radius * radius:
                continue
            other = shift_picture(guide, x, y, edge)[..., :3] - guide[..., :3]
            unlike = (other * other).sum(axis=-1, keepdims=True) / (2.0 * sigma_range**2)
            weight = np.exp(-(x * x + y * y) / (2.0 * sigma * sigma) - unlike)
            total += weight * shift_picture(image, x, y, edge)
            whole += weight
    return total / whole


def sharpen(
    image: Array, amount: float, sigma: float, threshold: float, limit: float, channels: str, edge: Edge
) -> Array:
    """An unsharp mask: in + amount * detail, where the detail is in - blur(in), reduced by the threshold."""
    soft = blur_gaussian(image, sigma, edge)
    gray = channels == "luminance"
    sharp = luminance_of(image) if gray else image[..., :3]
    detail = sharp - (luminance_of(soft) if gray else soft[..., :3])
    detail = np.sign(detail) * np.clip(np.abs(detail) - threshold, 0.0, limit * np.abs(sharp))
    return join(image[..., :3] + amount * detail, image[..., 3:])


def cas_sharpen(image: Array, sharpness: float, edge: Edge) -> Array:
    """Contrast adaptive sharpening of 3 x 3 pixels (AMD FidelityFX CAS, Lottes 2019)."""
    color = image[..., :3]
    cross = [shift_picture(color, x, y, edge) for x, y in ((0, -1), (-1, 0), (1, 0), (0, 1))]
    corners = [shift_picture(color, x, y, edge) for x, y in ((-1, -1), (1, -1), (-1, 1), (1, 1))]
    least, most = np.minimum.reduce([*cross, color]), np.maximum.reduce([*cross, color])
    least = least + np.minimum.reduce([*corners, least])
    most = most + np.maximum.reduce([*corners, most])
    # The smaller distance to black or white, relative to the brightest neighbor, says how much is safe to add.
    safe = np.sqrt(np.clip(np.minimum(least, 2.0 - most) / np.maximum(most, 1e-6), 0.0, 1.0))
    weight = -safe / (8.0 + (5.0 - 8.0) * min(max(sharpness, 0.0), 1.0))
    sharp = (weight * sum(cross) + color) / (1.0 + 4.0 * weight)
    return join(np.where(safe > 0.0, np.clip(sharp, 0.0, 1.0), color), image[..., 3:])


def variance_of(sigma: Array | float) -> Array:
    """The variance of the weights of a blur; below one pixel they are integrated over each pixel."""
    sigma = np.asarray(sigma, np.float64)
    safe = np.maximum(sigma, 1e-9)
    fine = sum((2 * i + 1) * erfc((i + 0.5) / (safe * np.sqrt(2.0))) for i in range(4))
    return np.where(sigma >= 1.0, sigma * sigma, fine)


def ladder_weights(t: Array, is_shaped: bool) -> list[Array]:
    """The weights of a blur and of the two next finer ones, whose variances differ by a factor of 2^(2/3).

    Two blurs can give the wanted variance; the third makes the mixture most like a Gaussian.
    """
    ratio = 2.0 ** (-2.0 / 3.0)
    share = (1.0 - ratio**t) / (1.0 - ratio)
    bend = 0.5355 * t * (1.0 - t) if is_shaped else 0.0 * t
    return [1.0 - share - bend * ratio, share + bend * (1.0 + ratio), -bend]


def variable_blur(image: Array, sigma: float, edge: Edge, field: Array | None = None) -> Array:
    """Blur every pixel with a Gaussian of its own, sigma * field, mixed from a ladder of blurs, three to an octave."""
    if field is None or sigma <= 0.1:
        return blur_gaussian(image, sigma, edge)
    step = 2.0 ** (2.0 / 3.0)
    full = float(variance_of(sigma))
    last = max(ceil(np.log(full / 0.16) / np.log(step)), 0)
    variances = [full / step**rung for rung in range(last + 1)]
    sigmas = [sigma, *(brentq(lambda s, v=v: float(variance_of(s)) - v, 0.1, sigma) for v in variances[1:])]
    variance = variance_of(field * sigma)
    rung = np.clip(np.log2(full / np.maximum(variance, 1e-9)) / np.log2(step), 0.0, last)
    rung = np.where(variance < variances[-1], last + 1.0 - variance / variances[-1], rung)
    rung = np.where(field <= 0.0, last + 1.0, np.where(field >= 1.0, 0.0, rung))
    above = np.minimum(np.floor(rung), last)
    t = rung - above
    total = np.maximum(rung - last, 0.0) * image
    for number, each in enumerate(sigmas):
        soft, away = blur_gaussian(image, each, edge), number - above
        shaped, plain = ladder_weights(t, True), ladder_weights(t, False)
        for place in range(3):
            weight = np.where(above < last - 1, shaped[place], plain[place])
            weight = np.where(above == last, 1.0 - t, weight)
            total += np.where(away == place, weight, 0.0) * soft
    return total
