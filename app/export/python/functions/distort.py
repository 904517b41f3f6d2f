"""Pictures that are moved, bent and resampled."""

from __future__ import annotations

from math import ceil, copysign

import numpy as np

from .glow import spectrum_response
from .hashing import stream_of
from .noises import ENDLESS, gradient_noise, simplex_noise, simplex_slope
from .pixels import Array, length
from .places import Edge, bilinear, fold, grid, kernel_radius, kernel_weight, pixels_at, warp, warp_by_counts


def rotate_vectors(away: Array, angle: Array | float) -> Array:
    """Vectors [..., 2] rotated, x toward y."""
    x, y, cos, sin = away[..., :1], away[..., 1:], np.cos(angle), np.sin(angle)
    return np.concatenate([cos * x - sin * y, sin * x + cos * y], axis=-1)


def backward_matrix(
    position: tuple[float, float],
    rotation: float,
    scale: tuple[float, float],
    skew: tuple[float, float],
    pivot: tuple[float, float],
    direction: str,
) -> Array:
    """The matrix [2, 3] from a pixel of the result to its place in the picture: scale, skew, rotate, move, undone."""
    wide, high = (copysign(max(abs(part), 1e-3), part) for part in scale)
    cos, sin = np.cos(rotation), np.sin(rotation)
    lean, fall = np.tan(skew[0]), np.tan(skew[1])
    rotated = np.array([[cos, -sin], [sin, cos]])
    forward = rotated @ np.array([[1.0, lean], [fall, 1.0]]) @ np.diag([wide, high])
    if direction == "inverse":
        forward_start, matrix = np.add(pivot, position), forward
        start = np.asarray(pivot)
        return np.column_stack([matrix, forward_start - matrix @ start])
    matrix = np.linalg.inv(forward)
    return np.column_stack([matrix, np.asarray(pivot) - matrix @ np.add(pivot, position)])


def resample_through(image: Array, matrix: Array, kernel: str, edge: str) -> Array:
    """Resample a picture through a matrix, with a kernel that is wider where the picture shrinks."""
    height, width = image.shape[:2]
    center = grid(width, height) @ matrix[:, :2].T + matrix[:, 2]
    if kernel == "nearest":
        at = np.floor(center).astype(int)
        return pixels_at(image, at[..., 0], at[..., 1], edge)
    spread = np.clip(np.hypot(matrix[:, 0], matrix[:, 1]), 1.0, 32.0)
    reach = kernel_radius(kernel) * spread
    first, last = np.floor(center - reach).astype(int), np.ceil(center + reach).astype(int)
    total, whole = np.zeros_like(image), np.zeros_like(image[..., :1])
    for down in range(int((last - first)[..., 1].max())):
        y = first[..., 1] + down
        row = np.where(y < last[..., 1], kernel_weight((y + 0.5 - center[..., 1]) / spread[1], kernel), 0.0)
        for right in range(int((last - first)[..., 0].max())):
            x = first[..., 0] + right
            weight = np.where(x < last[..., 0], kernel_weight((x + 0.5 - center[..., 0]) / spread[0], kernel), 0.0)
            weight = (row * weight)[..., None]
            total += weight * pixels_at(image, x, y, edge)
            whole += weight
    return total / np.where(whole != 0.0, whole, 1.0)


def transform(
    image: Array,
    position: tuple[float, float],
    rotation: float,
    scale: tuple[float, float],
    skew: tuple[float, float],
    pivot: tuple[float, float],
    direction: str,
    kernel: str,
    edge: Edge,
) -> Array:
    """Scale, skew, rotate around the pivot, and move (kernels: Mitchell and Netravali 1988)."""
    height, width = image.shape[:2]
    matrix = backward_matrix(position, rotation, scale, skew, (pivot[0] * width, pivot[1] * height), direction)
    return resample_through(image, matrix, kernel, edge)


def crop(
    image: Array,
    top_left: tuple[float, float],
    bottom_right: tuple[float, float],
    resize: bool,
    softness: float,
) -> Array:
    """Keep a rectangle of the picture, rounded to whole pixels."""
    sides = []
    for start, end, size in zip(top_left, bottom_right, image.shape[1::-1], strict=True):
        low, high = (round(min(max(place, 0.0), 1.0) * size) for place in sorted((start, end)))
        low = min(low, size - 1)
        sides.append((low, max(high, low + 1)))
    (left, right), (top, bottom) = sides
    at = grid(image.shape[1], image.shape[0])
    within = np.minimum(at - (left, top), (right, bottom) - at)
    faded = np.clip(within / max(softness, 1e-6), 0.0, 1.0).prod(axis=-1, keepdims=True) if softness > 0.0 else 1.0
    cropped = np.where(within.min(axis=-1, keepdims=True) > 0.0, image * faded, 0.0)
    return cropped[top:bottom, left:right] if resize else cropped


def resize(image: Array, scale: tuple[float, float], kernel: str, edge: Edge) -> Array:
    """Another size in pixels; the filter covers pixels of the result where the picture shrinks."""
    for axis, part in ((1, scale[0]), (0, scale[1])):
        before = image.shape[axis]
        after = max(round(before * part), 1)
        shrink = before / after
        center, width = (np.arange(after) + 0.5) * shrink, max(shrink, 1.0)
        reach = 0.5 * shrink if kernel == "box" else kernel_radius(kernel) * width
        low, high = center - reach, center + reach
        total, whole = 0.0, 0.0
        for step in range(int(np.ceil(2.0 * reach)) + 1):
            i = np.floor(low).astype(int) + step
            if kernel == "box":  # each pixel counts by the part of it that lies inside
                weight = np.maximum(np.minimum(i + 1.0, high) - np.maximum(i, low), 0.0)
            else:
                weight = np.where(i < np.ceil(high), kernel_weight((i + 0.5 - center) / width, kernel), 0.0)
            read = np.take(image, fold(i, before, edge), axis=axis)
            shape = (1, -1, 1) if axis == 1 else (-1, 1, 1)
            inside = (i >= 0) & (i < before) if edge == "black" else np.ones_like(i, bool)
            total = total + (weight * inside).reshape(shape) * read
            whole = whole + weight.reshape(shape)
        image = np.asarray(total / whole)
    return image


def bulge(image: Array, strength: float, radius: float, center: tuple[float, float], edge: Edge) -> Array:
    """A magnifying glass: read at center + distance (1 - strength (1 - (distance / radius)^2)^2)."""
    middle = np.asarray(center) * image.shape[1::-1]

    def source(at: Array) -> Array:
        away = at - middle
        within = np.maximum(1.0 - (away * away).sum(axis=-1, keepdims=True) / radius**2, 0.0)
        return middle + away * (1.0 - strength * within**2)

    return warp(image, source, edge)


def swirl(image: Array, angle: float, radius: float, center: tuple[float, float], edge: Edge) -> Array:
    """Rotate around a point by angle exp(-(distance / radius)^2)."""
    middle = np.asarray(center) * image.shape[1::-1]

    def source(at: Array) -> Array:
        away = at - middle
        return middle + rotate_vectors(away, -angle * np.exp(-(away * away).sum(axis=-1, keepdims=True) / radius**2))

    return warp(image, source, edge)


def ripple(
    image: Array,
    shape: str,
    motion: str,
    amplitude: float,
    wavelength: float,
    phase: float,
    angle: float,
    reach: float,
    center: tuple[float, float],
    edge: Edge,
) -> Array:
    """Waves: amplitude sin(2 pi (distance / wavelength - phase)), which fade as exp(-distance / reach)."""
    middle = np.asarray(center) * image.shape[1::-1]

    def source(at: Array) -> Array:
        away = at - middle
        along = np.broadcast_to([np.cos(angle), np.sin(angle)], away.shape)
        run = (away * along).sum(axis=-1, keepdims=True)
        if shape == "circular":
            run = length(away)
            along = away / np.where(run > 0.0, run, 1.0)
        height = amplitude * np.sin(2.0 * np.pi * (run / wavelength - phase)) * np.exp(-np.abs(run) / reach)
        across = np.stack([-along[..., 1], along[..., 0]], axis=-1)
        return at + height * (along if motion == "along" else across)

    return warp(image, source, edge)


def kaleidoscope(
    image: Array, segments: int, rotation: float, slice: float, zoom: float, center: tuple[float, float], edge: Edge
) -> Array:
    """Mirror one slice of the picture all around."""
    middle, wedge = np.asarray(center) * image.shape[1::-1], 2.0 * np.pi / segments

    def source(at: Array) -> Array:
        away = at - middle
        far = length(away)
        angle = np.where(far > 0.0, np.arctan2(away[..., 1:], away[..., :1]) - rotation, 0.0) % wedge
        angle = np.minimum(angle, wedge - angle) + slice  # every second wedge is mirrored
        return middle + far / zoom * np.concatenate([np.cos(angle), np.sin(angle)], axis=-1)

    return warp(image, source, edge)


def polar(
    image: Array, direction: str, radius: float, rotation: float, center: tuple[float, float], edge: Edge
) -> Array:
    """Wrap the picture into a disc, clockwise with its top at the center, or unwrap a disc into a strip."""
    height, width = image.shape[:2]
    middle = np.asarray(center) * (width, height)
    if direction == "unwrap":
        pixel_angle, ring = 2.0 * np.pi / width, radius / height

        def unroll(at: Array) -> Array:
            angle = at[..., :1] * pixel_angle + rotation
            return middle + at[..., 1:] * ring * np.concatenate([np.cos(angle), np.sin(angle)], axis=-1)

        return warp_by_counts(image, unroll, edge, np.maximum(pixel_angle * grid(width, height)[..., 1:] * ring, ring))

    def place_of(at: Array) -> Array:
        away = at - middle
        angle = np.where(length(away) > 0.0, np.arctan2(away[..., 1:], away[..., :1]) - rotation, 0.0)
        return np.concatenate([(angle / (2.0 * np.pi)) % 1.0 * width, length(away) / radius * height], axis=-1)

    def wrap_around(at: Array) -> Array:
        place = place_of(at)
        return np.concatenate([place[..., :1], np.clip(place[..., 1:], 0.5, height - 0.5)], axis=-1)

    far = np.maximum(length(grid(width, height) - middle), 0.5)
    span = np.maximum(width / (2.0 * np.pi * far), height / radius)
    return warp_by_counts(
        image, wrap_around, "wrap", span, None if edge != "black" else lambda at: place_of(at)[..., 1:] <= height
    )


def pixelate(image: Array, size: tuple[float, float], sampling: str) -> Array:
    """Coarse squares, each the average of the pixels that it covers; border pixels count by their part.

    Centers are the averages of the middle eighth of the sides of squares, at least of a pixel.
    """
    for axis, side in ((1, max(size[0], 1.0)), (0, max(size[1], 1.0))):
        count = image.shape[axis]
        first = np.arange(ceil(count / side)) * side
        last = np.minimum(first + side, count)
        if sampling == "center":
            middle, reach = 0.5 * (first + last), 0.5 * np.minimum(max(0.125 * side, 1.0), last - first)
            first, last = middle - reach, middle + reach
        pixel = np.arange(count)
        cover = np.minimum(pixel + 1.0, last[:, None]) - np.maximum(pixel, first[:, None])
        cover = np.maximum(cover, 0.0)
        cover /= cover.sum(axis=1, keepdims=True)
        squares = np.moveaxis(np.tensordot(cover, image, (1, axis)), 0, axis)
        image = np.take(squares, ((pixel + 0.5) / side).astype(int), axis=axis)
    return image


def displace(image: Array, vector: Array, amount: tuple[float, float], edge: Edge) -> Array:
    """Every pixel shows what is `vector * amount` pixels away; x points right and y down."""
    height, width = image.shape[:2]
    return bilinear(image, grid(width, height) + vector[..., :2] * np.asarray(amount), edge)


def st_map(image: Array, st: Array, origin: str, edge: Edge) -> Array:
    """Every pixel of the map holds a place in the picture, from 0 to 1."""

    def source(at: Array) -> Array:
        place = bilinear(st[..., :2], at)
        if origin == "bottom left":
            place = np.concatenate([place[..., :1], 1.0 - place[..., 1:]], axis=-1)
        return place * image.shape[1::-1]

    return warp(image, source, edge)


def noise_warp(
    image: Array,
    mask: Array | float,
    amount: float,
    kind: str,
    size: float,
    octaves: int,
    gain: float,
    evolution: float,
    speed: float,
    seed: int,
    edge: Edge,
    frame: int,
) -> Array:
    """Points move by simplex noise: by two noises (push), or by the curl of one (flow, Bridson et al. 2007)."""
    height, width = image.shape[:2]
    at = grid(width, height)
    place = np.concatenate([at / size, np.full_like(at[..., :1], evolution + speed * frame)], axis=-1)
    ways, strength, whole, endless = np.zeros_like(at), 1.0, 0.0, np.full(3, ENDLESS)
    for octave in range(octaves):
        stream = stream_of(seed, octave, 0)
        if kind == "push":
            layer = simplex_noise(place, stream, endless)[..., :2]
        else:
            slope = simplex_slope(place, stream, endless) / 3.44793  # the steepest slope in a plane of two axes
            layer = np.stack([slope[..., 1], -slope[..., 0]], axis=-1)
        ways, whole, strength = ways + strength * layer, whole + strength, strength * gain
        place = place * (2.0, 2.0, 1.0)
    ways = ways / whole
    far = amount * np.broadcast_to(np.asarray(mask), ways[..., :1].shape)
    padded = np.pad(ways, ((1, 1), (1, 1), (0, 0)), mode="edge")
    across = np.array([1.0, 0.0]) + 0.5 * far * (padded[1:-1, 2:] - padded[1:-1, :-2])
    along = np.array([0.0, 1.0]) + 0.5 * far * (padded[2:, 1:-1] - padded[:-2, 1:-1])
    counts = np.ceil(np.clip(np.maximum(length(across), length(along)) - 0.01, 1.0, 8.0))
    result = np.zeros_like(image)
    for n in np.unique(counts).astype(int):  # a pixel that covers several is the mean of n x n samples
        for i in range(n * n):
            x, y = (i % n + 0.5) / n - 0.5, (i // n + 0.5) / n - 0.5
            read = bilinear(image, at + far * ways + x * across + y * along, edge)
            result += np.where(counts == n, read / (n * n), 0.0)
    return result


def refract(slope: Array, thickness: float, index: float) -> Array:
    """The offset at which a picture is seen through a surface of this slope (Snell's law)."""
    normal = np.concatenate([-slope, np.ones_like(slope[..., :1])], axis=-1)
    normal = normal / length(normal)
    ratio = 1.0 / max(index, 1.0)
    cosine = normal[..., 2:]
    k = 1.0 - ratio**2 * (1.0 - cosine**2)
    ray = ratio * np.array([0.0, 0.0, -1.0]) + (ratio * cosine - np.sqrt(k)) * normal
    return thickness * ray[..., :2] / -ray[..., 2:]


def glass(
    image: Array,
    relief: float,
    thickness: float,
    index: float,
    dispersion: float,
    samples: int,
    size: float,
    seed: int,
    edge: Edge,
    surface: Array | None = None,
) -> Array:
    """Uneven glass before the picture: the slope of its surface bends the view by Snell's law, red less than blue."""
    height, width = image.shape[:2]
    at = grid(width, height)

    def bump(place: Array) -> Array:
        lattice = np.concatenate([place / size, np.full_like(place[..., :1], 0.5)], axis=-1)
        return 0.5 + 0.5 * gradient_noise(lattice, np.array([seed, 0, 0]), np.full(3, ENDLESS))[..., :1]

    if surface is None:  # hammered glass
        right, down = np.array([0.5, 0.0]), np.array([0.0, 0.5])
        across, along = bump(at + right) - bump(at - right), bump(at + down) - bump(at - down)
    else:
        padded = np.pad(surface, ((1, 1), (1, 1), (0, 0)), mode="edge")
        across = 0.5 * (padded[1:-1, 2:] - padded[1:-1, :-2])
        along = 0.5 * (padded[2:, 1:-1] - padded[:-2, 1:-1])
    slope = relief * np.concatenate([across, along], axis=-1)
    if dispersion == 0.0:
        return bilinear(image, at + refract(slope, thickness, index), edge)
    total, whole = np.zeros_like(image), np.zeros(4)
    for i in range(samples):
        place = 2.0 * i / (samples - 1) - 1.0
        response = spectrum_response(place)
        total += response * bilinear(image, at + refract(slope, thickness, index + 0.5 * place * dispersion), edge)
        whole += response
    return total / whole


def heat_haze(
    image: Array,
    heat: Array | float,
    amount: float,
    size: float,
    stretch: float,
    rise: float,
    change: float,
    rate: float,
    seed: int,
    edge: Edge,
    frame: int,
) -> Array:
    """Points move by two octaves of gradient noise (Perlin 2002), which rise and change from frame to frame."""
    height, width = image.shape[:2]
    at = grid(width, height)
    place = (at + np.array([0.0, rise / rate * frame])) / (size, size * stretch)
    place = np.concatenate([place, np.full_like(place[..., :1], change / rate * frame)], axis=-1)
    endless = np.full(3, ENDLESS)
    coarse = gradient_noise(place, np.array([seed, 0, 0]), endless)[..., :2]
    fine = gradient_noise(place * (2.0, 2.0, 1.0), np.array([seed, 1, 0]), endless)[..., :2]
    return bilinear(image, at + heat * amount * (2.0 * coarse + fine) / 3.0, edge)
