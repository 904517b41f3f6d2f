"""Edges, relief and kernels."""

from __future__ import annotations

from math import ceil

import numpy as np
from scipy import ndimage

from .blur import blur_gaussian
from .pixels import Array, display_tone, join, largest, length, luminance_of, srgb_decode
from .places import Edge, bilinear, grid, shift_picture
from .stylize import structure


def spacing_of(width: float) -> tuple[int, float, float]:
    """How far apart an operator of 3 x 3 pixels reads for lines of a width, the blur before it, and its gain.

    The variance of a box that is n pixels wide is n^2 / 12, of which the pixel itself has 1 / 12.
    """
    if width <= 0.0:
        return 1, 0.0, 1.0
    step = max(1, round(width))
    return step, np.sqrt(max(width * width - 1.0, 0.0) / 12.0), width / step


def edge_detect(
    image: Array, operator: str, channels: str, strength: float, threshold: float, width: float, edge: Edge
) -> tuple[Array, Array]:
    """The length of the gradient (Sobel and Feldman 1968, Prewitt 1970, Scharr 2000), or the Laplacian.

    Every operator is scaled so that a step of height 1 along a row or column gives 1.
    """
    step, sigma, gain = spacing_of(width)
    soft = blur_gaussian(image, sigma, edge)

    def at(x: int, y: int) -> Array:
        return shift_picture(soft[..., :3], x * step, y * step, edge)

    if operator == "laplace":
        across = at(-1, 0) + at(1, 0) + at(0, -1) + at(0, 1) - 4.0 * soft[..., :3]
        down = np.zeros_like(across)
    else:
        side = {"sobel": 1.0 / 4.0, "scharr": 3.0 / 16.0, "prewitt": 1.0 / 3.0}[operator]
        rising, falling = at(1, -1) - at(-1, 1), at(1, 1) - at(-1, -1)
        across = (1.0 - 2.0 * side) * (at(1, 0) - at(-1, 0)) + side * (falling + rising)
        down = (1.0 - 2.0 * side) * (at(0, 1) - at(0, -1)) + side * (falling - rising)
    if channels == "luminance":
        across, down = luminance_of(across), luminance_of(down)
    size = np.hypot(across, down)
    size = strength * gain * np.maximum(size - threshold / gain, 0.0)
    size = np.broadcast_to(size, image[..., :3].shape)
    return join(size, soft[..., 3:]), largest(size)


def flow_blurs(tone: Array, sigma: float, ratio: float, smoothing: float, stroke: float, edge: str) -> list[Array]:
    """Two blurs across the lines of a picture, then along them (Kang et al. 2007, Kyprianidis and Döllner 2008)."""
    height, width = tone.shape[:2]
    tensor = blur_gaussian(structure(tone, edge), smoothing, edge)
    center = grid(width, height)
    across = most_change(tensor)
    sigmas = np.maximum([sigma, sigma * ratio], 1e-3)
    reach = 3.0 * sigmas[1]
    apart = max(1.0, reach / 64.0)
    total, whole = np.repeat(tone, 2, axis=-1), np.ones(2)
    for i in range(1, int(reach / apart + 0.5) + 1):
        weight = np.exp(-0.5 * (i * apart / sigmas) ** 2)
        beside = bilinear(tone, center + i * apart * across, edge) + bilinear(tone, center - i * apart * across, edge)
        total, whole = total + weight * beside, whole + 2.0 * weight
    blurs = total / whole
    if stroke > 0.0:
        blurs = along_lines(blurs, tensor, across, stroke, edge)
    return [blurs[..., :1], blurs[..., 1:]]


def along_lines(blurs: Array, tensor: Array, across: Array, stroke: float, edge: str) -> Array:
    """The mean along the line through each pixel (line integral convolution, midpoint method)."""
    height, width = blurs.shape[:2]
    reach = 3.0 * stroke
    apart = max(1.0, reach / 64.0)
    total, whole = blurs, 1.0
    for side in (-1.0, 1.0):
        at = grid(width, height)
        direction = side * np.stack([-across[..., 1], across[..., 0]], axis=-1)
        for i in range(1, int(reach / apart + 0.5) + 1):
            here = most_change(bilinear(tensor, at + 0.5 * apart * direction, edge))
            along = np.stack([-here[..., 1], here[..., 0]], axis=-1)
            turned = np.where((along * direction).sum(axis=-1, keepdims=True) < 0.0, -along, along)
            direction = np.where(length(here) > 0.0, turned, direction)
            at = at + apart * direction
            weight = np.exp(-0.5 * (i * apart / stroke) ** 2)
            total, whole = total + weight * bilinear(blurs, at, edge), whole + weight
    return total / whole


def most_change(tensor: Array) -> Array:
    """The direction of most change of a structure tensor; 0 where all directions are alike."""
    xx, xy, yy = tensor[..., 0:1], tensor[..., 1:2], tensor[..., 2:3]
    angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    has_way = np.hypot(xx - yy, 2.0 * xy) > 1e-12
    return np.where(has_way, np.concatenate([np.cos(angle), np.sin(angle)], axis=-1), 0.0)


def difference_of_gaussians(
    image: Array,
    kind: str,
    sigma: float,
    ratio: float,
    strength: float,
    epsilon: float,
    phi: float,
    guide: str,
    smoothing: float,
    stroke: float,
    edge: Edge,
) -> tuple[Array, Array]:
    """Ink (XDoG, Winnemöller et al. 2012) or detail (Marr and Hildreth 1980): the difference of two blurs of the tone.

    S = (1 + p) G(sigma) - p G(ratio sigma) is white where it is at least epsilon, else 1 + tanh(phi (S - epsilon)).
    """
    tone = display_tone(image)
    if guide == "flow":
        fine, coarse = flow_blurs(tone, sigma, ratio, smoothing, stroke, edge)
    else:
        fine, coarse = blur_gaussian(tone, sigma, edge), blur_gaussian(tone, sigma * ratio, edge)
    if kind == "dog":
        value = strength * (fine - coarse)
    else:
        sharp = (1.0 + strength) * fine - strength * coarse
        value = np.where(sharp >= epsilon, 1.0, 1.0 + np.tanh(np.clip(phi * (sharp - epsilon), -20.0, 0.0)))
    alpha = image[..., 3:]
    return join((srgb_decode(value) if kind == "xdog" else value) * alpha, alpha), value


def emboss(
    image: Array,
    kind: str,
    direction: float,
    elevation: float,
    height: float,
    softness: float,
    width: float,
    edge: Edge,
) -> Array:
    """The tone as a relief, lit from one side: N.L / L.z (Lambert; bump mapping: Blinn 1978)."""
    step, sigma, _ = spacing_of(width)
    relief = blur_gaussian(display_tone(image), np.hypot(softness, sigma), edge)

    def difference(x: int, y: int) -> Array:
        return shift_picture(relief, x * step, y * step, edge) - shift_picture(relief, -x * step, -y * step, edge)

    falling, rising = difference(1, 1), difference(1, -1)
    across = (2.0 * difference(1, 0) + falling + rising) / (8.0 * step)
    down = (2.0 * difference(0, 1) + falling - rising) / (8.0 * step)
    normal = np.concatenate([-height * across, -height * down, np.ones_like(across)], axis=-1)
    light = [np.cos(elevation) * np.cos(direction), -np.cos(elevation) * np.sin(direction), np.sin(elevation)]
    facing = (normal * np.array(light)).sum(axis=-1, keepdims=True) / length(normal)
    shade = np.maximum(facing, 0.0) / np.sin(elevation)
    return join(0.18 * shade * image[..., 3:] if kind == "relief" else image[..., :3] * shade, image[..., 3:])


def convolve3x3(
    image: Array, kernel: tuple[float, ...], bias: float, filter_alpha: bool, width: float, edge: Edge
) -> Array:
    """Each pixel and its eight neighbors, weighted by rows of a kernel, which is not flipped (correlation)."""
    step, _, _ = spacing_of(width)
    total = np.zeros_like(image)
    for at, weight in enumerate(kernel):
        total += weight * shift_picture(image, step * (at % 3 - 1), step * (at // 3 - 1), edge)
    alpha = total[..., 3:] if filter_alpha else image[..., 3:]
    return join(total[..., :3] + bias * alpha, alpha)


def height_to_normal(height: Array, depth: float, kernel: str, green: str, edge: Edge) -> tuple[Array, Array]:
    """A normal map: (-dh/dx, -dh/dy, 1) at length 1, and the same as a color."""

    def slope(x: int, y: int, right: int, down: int) -> Array:
        return 0.5 * (
            shift_picture(height, right + x, down + y, edge) - shift_picture(height, right - x, down - y, edge)
        )

    across, down = slope(1, 0, 0, 0), slope(0, 1, 0, 0)
    if kernel == "sobel":
        across = 0.5 * across + 0.25 * (slope(1, 0, 0, 1) + slope(1, 0, 0, -1))
        down = 0.5 * down + 0.25 * (slope(0, 1, 1, 0) + slope(0, 1, -1, 0))
    rise = depth * down if green == "up" else -depth * down
    normal = np.concatenate([-depth * across, rise, np.ones_like(rise)], axis=-1)
    normal = normal / length(normal)
    return normal, join(0.5 + 0.5 * normal, np.ones_like(rise))


def canny_ridges(across: Array, down: Array, low: float, high: float) -> tuple[Array, Array]:
    """Pixels that are stronger than both neighbors across the edge, above each of two thresholds (Canny 1986)."""
    strength = np.hypot(across, down)
    padded = np.pad(strength[..., 0], 1)

    def beside(x: int, y: int) -> Array:
        return padded[1 + y : padded.shape[0] - 1 + y, 1 + x : padded.shape[1] - 1 + x][..., None]

    slope = np.tan(np.pi / 8.0)
    flat, upright = np.abs(down) < slope * np.abs(across), np.abs(across) < slope * np.abs(down)
    falling = across * down >= 0.0
    ways = [flat, ~flat & upright, ~flat & ~upright & falling, ~flat & ~upright & ~falling]
    steps = [(1, 0), (0, 1), (1, 1), (-1, 1)]
    before = np.select(ways, [beside(-x, -y) for x, y in steps])
    after = np.select(ways, [beside(x, y) for x, y in steps])
    diagonal = ~flat & ~upright
    ridge = (strength > before) & (strength >= after) & ~(diagonal & (strength == after))
    return ridge & (strength > low), ridge & (strength > high)


def canny(
    image: Array, sigma: float, low: float, high: float, reach: float, width: float, edge: Edge
) -> tuple[Array, Array]:
    """Edges as lines: ridges of the Sobel gradient above two thresholds, weak ones where they touch a strong one."""
    step, softness, gain = spacing_of(width)
    tone = blur_gaussian(display_tone(image), np.hypot(sigma, softness), edge)

    def at(x: int, y: int) -> Array:
        return shift_picture(tone, x * step, y * step, edge)

    falling, rising = at(1, 1) - at(-1, -1), at(1, -1) - at(-1, 1)
    across = gain / 4.0 * (2.0 * (at(1, 0) - at(-1, 0)) + falling + rising)
    down = gain / 4.0 * (2.0 * (at(0, 1) - at(0, -1)) + falling - rising)
    weak, strong = canny_ridges(across, down, min(low, high), max(low, high))
    square = np.ones((3, 3, 1), bool)
    if reach > 0.0:  # three pixels at a time
        strong = ndimage.binary_dilation(strong, square, iterations=3 * ceil(reach / 3.0), mask=weak)
    lines = np.where(strong, min(gain, 1.0), 0.0)
    if step > 1:
        lines = ndimage.maximum_filter(lines, size=(step, step, 1), mode="constant")
    return join(lines * image[..., 3:], image[..., 3:]), lines
