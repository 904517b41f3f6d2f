"""Mattes: keys, their edges, growing and shrinking."""

from __future__ import annotations

from math import floor

import numpy as np
from scipy import ndimage

from .blur import MODES, blur_gaussian
from .pixels import Array, join, largest, length, luminance_of, mix, rgb, smallest, straight
from .places import Edge


def luma_key(
    image: Array,
    measure: str,
    low: Array | float,
    high: Array | float,
    low_softness: Array | float,
    high_softness: Array | float,
    invert: bool,
) -> tuple[Array, Array]:
    """Cut out what is between two levels of brightness; beyond them the matte falls to 0 linearly."""

    def ramp(inside: Array, softness: Array | float) -> Array:
        return np.where(inside >= 0.0, 1.0, np.clip(1.0 + inside / np.maximum(softness, 1e-9), 0.0, 1.0))

    color, _ = straight(image)
    most = largest(color)
    light = {
        "luminance": luminance_of(color),
        "maximum": most,
        "minimum": smallest(color),
        "saturation": np.where(most > 0.0, 1.0 - smallest(color) / np.where(most > 0.0, most, 1.0), 0.0),
    }[measure]
    matte = ramp(light - low, low_softness) * ramp(high - light, high_softness)
    matte = 1.0 - matte if invert else matte
    return image * matte, np.clip(image[..., 3:], 0.0, 1.0) * matte


def screen_channel(screen: Array) -> int:
    """The channel of a screen of this color: the largest one, green before blue before red."""
    red, green, blue = np.ravel(screen)[:3]
    return 1 if green >= max(red, blue) else 2 if blue >= red else 0


def screen_excess(color: Array, channel: int, balance: float) -> Array:
    """How much the screen's channel exceeds a mix of the smaller (balance 0) and larger other one (Vlahos 1964)."""
    first, second = (color[..., other : other + 1] for other in ((channel + 1) % 3, (channel + 2) % 3))
    most = mix(np.minimum(first, second), np.maximum(first, second), balance)
    return color[..., channel : channel + 1] - most


def chroma_key(
    image: Array,
    screen: tuple[float, ...],
    method: str,
    limit: str,
    black: Array | float,
    white: Array | float,
    tolerance: Array | float,
    spill: Array | float,
) -> tuple[Array, Array]:
    """Cut out a subject before a screen: by color difference (Vlahos 1964) or by chromaticity."""
    color, alpha, back = image[..., :3], image[..., 3:], rgb(screen)[None, None]
    channel, balance = screen_channel(back), 0.5 if limit == "average" else 1.0

    def chromaticity(color: Array) -> Array:
        light = np.maximum(color, 0.0)
        return light / np.maximum(light.sum(axis=-1, keepdims=True), 1e-6)

    if method == "distance":
        empty = 1.0 - length(chromaticity(color) - chromaticity(back)) / np.maximum(tolerance, 1e-6)
    else:
        empty = screen_excess(color, channel, balance) / np.maximum(screen_excess(back, channel, balance), 1e-6)
    cover = (1.0 - np.clip(empty, 0.0, 1.0) - black) / np.maximum(np.subtract(white, black), 1e-6)
    cover = np.clip(cover, 0.0, 1.0)
    # Subtract the screen, then the light that the screen throws on the subject (spill).
    subject = color - (1.0 - cover) * back
    excess = spill * np.maximum(screen_excess(subject, channel, balance), 0.0)
    subject = subject - excess * np.eye(3)[channel]
    subject = np.where(cover > 0.0, np.maximum(subject, np.minimum(color, 0.0)), 0.0)
    return join(subject, cover * alpha), cover * np.clip(alpha, 0.0, 1.0)


def despill(
    image: Array, screen: str, limit: str, amount: Array | float, scale: Array | float, keep_light: Array | float
) -> Array:
    """Take what the screen's channel has above a limit out of a picture; a part comes back as gray."""
    at = {"red": 0, "green": 1, "blue": 2}[screen]
    first, second = (image[..., other : other + 1] for other in range(3) if other != at)
    most = {
        "average": 0.5 * (first + second),
        "maximum": np.maximum(first, second),
        "minimum": np.minimum(first, second),
        "double": (2.0 * first + second) / 3.0,
    }[limit]
    excess = amount * np.maximum(image[..., at : at + 1] - scale * most, 0.0)
    gray = keep_light * excess * (0.2126, 0.7152, 0.0722)[at]
    return join(image[..., :3] - excess * np.eye(3)[at] + gray, image[..., 3:])


def difference_key(
    image: Array, clean_plate: Array, measure: str, tolerance: Array | float, falloff: Array | float
) -> tuple[Array, Array]:
    """Cut out what is different from a picture of the same place without the subject."""
    apart = np.abs(image[..., :3] - clean_plate[..., :3])
    measures = {"largest": largest, "distance": length}
    difference = measures[measure](apart) if measure in measures else apart.mean(axis=-1, keepdims=True)
    cover = np.clip((difference - tolerance) / np.maximum(falloff, 1e-6), 0.0, 1.0)
    return cover * image, cover * np.clip(image[..., 3:], 0.0, 1.0)


def set_matte(image: Array, matte: Array, operation: str, color: str, invert: bool) -> Array:
    """Replace the alpha of a picture, or join it with a matte."""
    covered = np.clip(matte, 0.0, 1.0)
    covered = 1.0 - covered if invert else covered
    alpha = image[..., 3:]
    joined = {
        "replace": covered,
        "multiply": alpha * covered,
        "maximum": np.maximum(alpha, covered),
        "subtract": alpha * (1.0 - covered),
    }[operation]
    light = image[..., :3] if color == "straight" else straight(image)[0]
    return join(light * joined, joined)


def map_range(
    field: Array,
    from_low: Array | float,
    from_high: Array | float,
    to_low: Array | float,
    to_high: Array | float,
    kind: str,
    steps: Array | float,
    limit: bool,
) -> Array:
    """Map one range of a Field to another: linearly, smoothly, or in steps."""
    span, away = np.subtract(from_high, from_low), field - from_low
    t = np.where(span == 0.0, np.where(away < 0.0, 0.0, 1.0), away / np.where(span == 0.0, 1.0, span))
    if limit or kind in ("smooth", "smoother"):
        t = np.clip(t, 0.0, 1.0)
    if kind == "smooth":
        t = t * t * (3.0 - 2.0 * t)
    if kind == "smoother":
        t = t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
    if kind == "steps":
        count = np.maximum(np.floor(np.add(steps, 0.5)), 2.0)
        number = np.floor(t * count)
        t = (np.clip(number, 0.0, count - 1.0) if limit else number) / (count - 1.0)
    return mix(to_low, to_high, t)


def edge_matte(matte: Array, width: float, side: str, gain: float, edge: Edge) -> Array:
    """A matte of the edge of another one: 4 s (1 - s) of the blurred matte s."""
    m = np.clip(matte, 0.0, 1.0)
    s = np.clip(blur_gaussian(matte, width / (2.0 * 1.617), edge), 0.0, 1.0)
    part = {"inside": m, "outside": 1.0 - m}.get(side, 1.0)
    return np.minimum(4.0 * s * (1.0 - s) * part * gain, 1.0)


def feather(image: Array, width: float, side: str, edge: Edge) -> Array:
    """Soften the edge of a matte on both sides, only inward, or only outward."""
    soft = blur_gaussian(image, width / (4.0 if side == "both" else 2.0), edge)
    if side == "both":
        return soft
    inward = np.minimum(image, np.maximum(2.0 * soft - 1.0, 0.0))
    return inward if side == "inside" else np.maximum(image, np.minimum(2.0 * soft, 1.0))


def light_wrap(image: Array, background: Array, width: float, intensity: float, edge: Edge) -> tuple[Array, Array]:
    """Let the light of a background shine around the edge of a subject: the subject with it, and the light alone."""
    cover = np.clip(image[..., 3:], 0.0, 1.0)
    beside = join(background[..., :3] * (1.0 - cover), np.zeros_like(cover))
    light = intensity * cover * blur_gaussian(beside, 0.5 * width, edge)
    return image + light, light


def extremes(image: Array, radius: int, shape: str, grows: bool, edge: str) -> Array:
    """The largest or the smallest pixel in a disc or a square."""
    y, x = np.mgrid[-radius : radius + 1, -radius : radius + 1]
    disc = x * x + y * y <= radius * radius if shape == "circle" else np.ones(x.shape, bool)
    find = ndimage.maximum_filter if grows else ndimage.minimum_filter
    return find(image, footprint=disc[..., None], mode=MODES[edge])


def dilate_erode(image: Array, radius: float, shape: str, edge: Edge) -> Array:
    """Grow a matte, or shrink it (gray morphology); a fraction of a pixel mixes the two nearest whole radii."""
    size = abs(radius)
    whole, part = floor(size), size - floor(size)
    smaller = extremes(image, whole, shape, radius > 0.0, edge)
    return mix(smaller, extremes(image, whole + 1, shape, radius > 0.0, edge), part) if part else smaller


def contour_distance(mask: Array, most: float) -> Array:
    """The distance of every pixel from where a mask crosses one half; below 0 inside.

    The nearest pixel of the other kind is that of the nearest row in each column, then the nearest of those along the
    row. Its coverage, or that of the pixel one step back, says where the edge lies.
    """
    inside = mask[..., 0] >= 0.5
    y, x = np.mgrid[: mask.shape[0], : mask.shape[1]]
    result = np.empty_like(mask)
    for kind in (True, False):  # pixels of this kind look for the other one
        other = inside != kind
        above = np.maximum.accumulate(np.where(other, y, -1e9), axis=0)
        below = np.minimum.accumulate(np.where(other, y, 1e9)[::-1], axis=0)[::-1]
        rows = np.where(y - above <= below - y, above, below)
        nearest, row, column = np.full(mask.shape[:2], most**2), -np.ones_like(y), np.zeros_like(x)
        for away in range(mask.shape[1]):
            for beside in (x - away, x + away):
                row_beside = rows[y, np.clip(beside, 0, mask.shape[1] - 1)]
                square = away**2 + (row_beside - y) ** 2.0
                nearer = (beside >= 0) & (beside < mask.shape[1]) & (square < nearest)
                nearest = np.where(nearer, square, nearest)
                row, column = np.where(nearer, row_beside, row).astype(int), np.where(nearer, beside, column)
        cover = np.clip(mask[..., 0], 0.0, 1.0)
        cover = 1.0 - cover if kind else cover  # by the other kind
        sideways = np.abs(x - column) > np.abs(y - row)
        back = row + np.where(sideways, 0, np.sign(y - row)), column + np.where(sideways, np.sign(x - column), 0)
        here = cover[row, column]
        before = np.where(here < 1.0, here - 0.5, 0.5 + cover[back])
        far = np.sqrt(nearest) - np.where(row >= 0, before, 0.0)
        result[inside == kind] = (-far if kind else far)[inside == kind][:, None]
    return result


def distance_field(mask: Array) -> Array:
    """The distance of every pixel from the edge of a mask, below 0 inside."""
    return contour_distance(mask, np.hypot(*mask.shape[:2]))


def depth_slice(
    depth: Array,
    near: Array | float,
    far: Array | float,
    near_softness: Array | float,
    far_softness: Array | float,
    invert: bool,
) -> Array:
    """A mask of what lies between two depths; beyond them it falls to 0 linearly."""

    def ramp(inside: Array, softness: Array | float) -> Array:
        return np.where(inside >= 0.0, 1.0, np.clip(1.0 + inside / np.maximum(softness, 1e-9), 0.0, 1.0))

    away = np.where((depth > 0.0) & (depth < 1e9), depth, 1e10)
    mask = ramp(away - near, near_softness) * ramp(far - away, far_softness)
    return 1.0 - mask if invert else mask


def fill_holes(matte: Array, turns: int) -> Array:
    """Close the holes of a matte: each pixel gets the highest value on the lowest way out (Vincent 1993).

    Ways are found along all rows from both ends, then along all columns, and so on, `turns` times.
    """
    low = np.clip(matte[..., 0], 0.0, 1.0)
    filled = np.ones_like(low)
    for _ in range(turns):
        for axis in (1, 0):
            most, arrived = np.maximum(low, filled), []
            for step in (1, -1):
                least_barrier = np.moveaxis(np.empty_like(low), axis, 0)
                least, limit = (np.moveaxis(each, axis, 0)[::step] for each in (low, most))
                coming = np.zeros(least.shape[1:])  # from outside of the picture
                for at in range(len(least)):
                    coming = np.clip(coming, least[at], limit[at])
                    least_barrier[at] = coming
                arrived.append(np.moveaxis(least_barrier[::step], 0, axis))
            filled = np.minimum(*arrived)
    return filled[..., None]
