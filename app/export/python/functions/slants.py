"""Stairs of jagged edges, replaced by slanted lines."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .pixels import Array, display_tone, srgb_encode, straight
from .places import shift_picture

SEARCH_LENGTHS = {"low": (8, 0), "medium": (16, 0), "high": (32, 8), "ultra": (64, 16)}
"""How many pixels the ends of an edge are searched along rows and columns, and along diagonals."""


def find_steps(tones: Array, threshold: float, contrast: float) -> Array:
    """Whether there is an edge at the left (0) and at the top (1) of each pixel.

    The step of tone there is above the threshold, and no step nearby is `contrast` times as large.
    """
    ways = [(1, 0), (0, 1)]
    far = {
        (x, y, n): np.abs(shift_picture(tones, n * x, n * y) - shift_picture(tones, (n + 1) * x, (n + 1) * y)).max(
            axis=-1
        )
        for x, y in ways
        for n in (-2, -1, 0)
    }
    strongest = np.max(list(far.values()), axis=0)
    least = np.maximum(threshold, strongest / contrast)
    steps = [far[x, y, -1] for x, y in ways]
    return np.stack([(step >= least) & (step > 0.0) for step in steps], axis=-1)


def edge_reader(edges: Array) -> Callable[[Array, int], Array]:
    """A function that says for places [n, 2] whether there is an edge at their left (axis 0) or top (axis 1)."""
    margin = 4
    padded = np.pad(edges, ((margin, margin), (margin, margin), (0, 0)))

    def edge_at(at: Array, axis: int) -> Array:
        return padded[at[:, 1] + margin, at[:, 0] + margin, axis]

    return edge_at


def line_areas(from_y: Array, to_y: Array, from_x: Array, to_x: Array, x: Array) -> Array:
    """The areas below (0) and above (1) the axis that a line between two points encloses, from x to x + 1."""
    first, last = np.maximum(x, from_x), np.minimum(x + 1.0, to_x)
    steep = (to_y - from_y) / (to_x - from_x)
    a, b = from_y + (first - from_x) * steep, from_y + (last - from_x) * steep
    areas = 0.5 * np.stack([np.maximum(-a, 0.0) + np.maximum(-b, 0.0), np.maximum(a, 0.0) + np.maximum(b, 0.0)], -1)
    crosses = (a * b < 0.0)[:, None]  # then there are two triangles
    areas = np.where(crosses, areas * areas / np.where(crosses, 0.5 * np.abs(a - b)[:, None], 1.0), areas)
    return np.where((first < last)[:, None], (last - first)[:, None] * areas, 0.0)


def larger_when_short(areas: Array, size: Array) -> Array:
    """Areas of short U shapes made larger, as in the area texture of the authors of SMAA."""
    part = np.minimum(size / 32.0, 1.0)[:, None]
    return (1.0 - part) * np.sqrt(0.5 * areas) + part * areas


def stair_areas(left: Array, right: Array, up: tuple[Array, Array], down: tuple[Array, Array]) -> Array:
    """Areas of an edge that goes on for so many pixels on both sides, where edges leave its ends up or down.

    There the true line starts half a pixel up or down. An end with edges on both sides takes the direction opposite to
    the other end.
    """
    size, zero = left + right + 1.0, np.zeros(len(left))
    ends = [0.5 * (1.0 * a - 1.0 * b) for a, b in zip(up, down, strict=True)]
    start = np.where(up[0] & down[0], -ends[1], ends[0])
    end = np.where(up[1] & down[1], -ends[0], ends[1])
    whole = line_areas(start, end, zero, size, left)
    first = np.where((start != 0.0)[:, None], line_areas(start, zero, zero, 0.5 * size, left), 0.0)
    last = np.where((end != 0.0)[:, None], line_areas(zero, end, 0.5 * size, size, left), 0.0)
    opposite, alike = (start * end < 0.0)[:, None], (start * end > 0.0)[:, None]
    bent = np.where(alike, larger_when_short(first, size) + larger_when_short(last, size), first + last)
    return np.where(opposite, whole, bent)


def edge_length(edge_at: Callable[[Array, int], Array], pixels: Array, axis: int, forward: bool, reach: int) -> Array:
    """How far edges go on in one direction, until another edge crosses or touches them."""
    along = np.array([1, 0]) if axis == 1 else np.array([0, 1])
    side, way, at = 1 - along, along if forward else -along, pixels.copy()
    away, goes_on = np.zeros(len(pixels), int), np.ones(len(pixels), bool)
    for _ in range(reach):
        seam = at + along if forward else at
        goes_on &= ~(edge_at(seam, 1 - axis) | edge_at(seam - side, 1 - axis)) & edge_at(at + way, axis)
        away += goes_on
        at = at + way * goes_on[:, None]
    return away


def straight_areas(
    edge_at: Callable[[Array, int], Array], pixels: Array, axis: int, reach: int, corner_rounding: float
) -> Array:
    """The parts of pixels and of those across the edge that take the color of the other one."""
    along = np.array([1, 0]) if axis == 1 else np.array([0, 1])
    side, cross = 1 - along, 1 - axis
    left, right = (edge_length(edge_at, pixels, axis, forward, reach) for forward in (False, True))
    ends = pixels - left[:, None] * along, pixels + (right + 1)[:, None] * along
    down, up = (tuple(edge_at(end - away * side, cross) for end in ends) for away in (0, 1))
    areas = stair_areas(1.0 * left, 1.0 * right, (up[0], up[1]), (down[0], down[1]))
    # A crossing edge that is longer than one pixel is a corner of an object, not a stair of a slanted line.
    nearer = np.stack([left <= right, right <= left], axis=-1) * 1.0
    nearer *= (1.0 - corner_rounding) / nearer.sum(axis=-1, keepdims=True)
    corners = [np.stack([edge_at(end + away * side, cross) for end in ends], axis=-1) for away in (1, -2)]
    return areas * (1.0 - np.stack([(nearer * corner).sum(axis=-1) for corner in corners], axis=-1))


def count_stairs(
    edge_at: Callable[[Array, int], Array], pixels: Array, way: tuple[int, int], reach: int
) -> tuple[Array, Array]:
    """How many stairs of one pixel follow the edge above pixels, and how it goes on after them.

    1 is vertical, 2 horizontal, 3 both, 0 neither, or not found.
    """
    at, step = pixels.copy(), np.array(way)
    upright_side, along = np.array([max(way[0], 0), min(way[1], 0)]), np.array([way[0], 0])
    away, on, goes_on = np.zeros(len(at), int), np.zeros(len(at), int), np.ones(len(at), bool)
    for _ in range(reach):
        upright = edge_at(at + upright_side, 0)
        ends = goes_on & ~(upright & edge_at(at + step, 1))
        on = np.where(ends, 1 * upright + 2 * edge_at(at + along, 1), on)
        goes_on &= ~ends
        away += goes_on
        at = at + step * goes_on[:, None]
    return away, on


def ramp_integral(x: Array) -> Array:
    """The integral of a ramp that is clamped to 0..1."""
    return np.where(x <= 0.0, 0.0, np.where(x >= 1.0, x - 0.5, 0.5 * x * x))


def part_right_of(start: Array, end: Array, center: Array) -> Array:
    """The part of the unit square around `center` that lies to the right of a rising line."""
    d, away = end - start, center - start
    steep = d.max(axis=-1)
    slope = d.min(axis=-1) / steep
    middle = 0.5 + (d[:, 1] * away[:, 0] - d[:, 0] * away[:, 1]) / steep
    return (ramp_integral(middle + 0.5 * slope) - ramp_integral(middle - 0.5 * slope)) / slope


def diagonal_end(on: Array, straight_on: int, other: int, upper: bool) -> Array:
    """Where the line through stairs starts or ends; two candidates where that is ambiguous."""
    level = (on == straight_on) | ((on != other) & (not upper))
    x = np.where(level, 1.0, np.where(on == 0, 0.0, 1.0))
    return np.stack([x, np.where(level, 0.0, x)], axis=-1)


def diagonal_areas(edge_at: Callable[[Array, int], Array], pixels: Array, rise: int, reach: int) -> Array:
    """The areas of the diagonal through the edge above pixels: `rise` is -1 for stairs that rise to the right."""
    before, before_on = count_stairs(edge_at, pixels, (-1, -rise), reach)
    after, after_on = count_stairs(edge_at, pixels, (1, rise), reach)
    is_line, whole = before + after >= 3, np.zeros((len(pixels), 2))
    before, before_on, after, after_on = (part[is_line] for part in (before, before_on, after, after_on))
    size, areas = (before + after + 1.0)[:, None], np.zeros((len(before), 2))
    for upper in (False, True):
        start = diagonal_end(before_on, 1, 2, upper)
        end = diagonal_end(after_on, 2, 1, upper) + size
        center = before[:, None] + np.array([1.5, 0.5])
        above = 1.0 - part_right_of(start, end, center)
        areas += 0.5 * np.stack([above, part_right_of(start, end, center + np.array([0.0, 1.0]))], axis=-1)
    whole[is_line] = areas if rise < 0 else areas[:, ::-1]
    return whole


def slant_weights(edges: Array, reach: int, diagonal: int, corner_rounding: float) -> Array:
    """How much of each pixel and of the one across the edge takes the color of the other: at its top, at its left."""
    edge_at, weights = edge_reader(edges), np.zeros((*edges.shape[:2], 4))
    top = np.argwhere(edges[..., 1])[:, ::-1]
    above = np.zeros((len(top), 2))
    if diagonal:
        above = diagonal_areas(edge_at, top, -1, diagonal) + diagonal_areas(edge_at, top, 1, diagonal)
    is_sloped = above.sum(axis=-1) > 0.0
    level = straight_areas(edge_at, top, 1, reach, corner_rounding)
    weights[top[:, 1], top[:, 0], :2] = np.where(is_sloped[:, None], above, level)
    sloped = np.zeros(edges.shape[:2], bool)
    sloped[top[:, 1], top[:, 0]] = is_sloped
    side = np.argwhere(edges[..., 0] & ~sloped)[:, ::-1]
    weights[side[:, 1], side[:, 0], 2:] = straight_areas(edge_at, side, 0, reach, corner_rounding)
    return weights


def smaa(
    image: Array, quality: str, detection: str, threshold: float, contrast: float, corner_rounding: float
) -> Array:
    """SMAA 1x (Jimenez et al. 2012): each pixel is mixed by how much of it lies on either side of a slanted line."""
    tones = srgb_encode(np.maximum(straight(image)[0], 0.0))
    if detection == "luminance":
        tones = display_tone(image)
    reach, diagonal = SEARCH_LENGTHS[quality]
    weights = slant_weights(find_steps(tones, threshold, contrast), reach, diagonal, corner_rounding)
    left, right = weights[..., 2:3], shift_picture(weights, 1, 0, "black")[..., 3:4]
    top, below = weights[..., 0:1], shift_picture(weights, 0, 1, "black")[..., 1:2]
    is_level = np.maximum(left, right) > np.maximum(top, below)
    first, last = np.where(is_level, left, top), np.where(is_level, right, below)
    total = first + last
    share = total / np.where(total > 0.0, total, 1.0) / np.where(total > 0.0, total, 1.0)
    before = np.where(is_level, shift_picture(image, -1, 0, "black"), shift_picture(image, 0, -1, "black"))
    after = np.where(is_level, shift_picture(image, 1, 0, "black"), shift_picture(image, 0, 1, "black"))
    return image + share * (first * first * (before - image) + last * last * (after - image))
