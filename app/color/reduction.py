"""Few colors for a picture: a palette that is found in it, and error diffusion from pixel to pixel.

Colors are sRGB codes here, as distances between them are nearer to what is seen.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from .transforms import Array, decode_srgb, encode_srgb

_SAMPLES = 1 << 15
"""The most pixels that a palette is found from: four times as many change the error by less than a hundredth."""

_ROUNDS = 40
"""The most rounds of k-means: later ones change the error by less than a hundredth."""

_BLOCK = 1 << 16
"""Pixels whose nearest colors are found at once: 16 MiB with 64 colors."""


def reduce_colors(
    pictures: Mapping[str, Array], settings: Mapping[str, str | float | bool], report: Callable[[float], bool]
) -> Array:
    """The picture `codes` in the colors of a palette, scene-linear; alpha as it is.

    `colors` are the scene-linear numbers of the palette; without any, as many as `count` are found in the picture. Each
    pixel gets the nearest color, with what errors of other pixels have added where they are `diffused`, else as it is
    in the picture `pattern`, if that is there.
    """
    codes = pictures["codes"].astype(np.float32)
    numbers = np.array(str(settings["colors"]).split(), np.float64).reshape(-1, 3)
    palette = encode_srgb(np.maximum(numbers, 0.0)) if len(numbers) else find_palette(codes, int(settings["count"]))
    if settings["diffused"]:
        indices = diffuse_errors(codes[..., :3], palette, report)
    else:
        indices = _find_nearest(pictures.get("pattern", codes)[..., :3], palette)
    return np.concatenate([decode_srgb(palette)[indices], codes[..., 3:]], axis=2).astype(np.float32)


def find_palette(codes: Array, count: int) -> Array:
    """At most `count` colors of a picture: those of boxes, moved by k-means (Lloyd 1982).

    What is transparent does not count, and light counts up to 1: else a few lamps would take most colors.
    """
    visible = codes.reshape(-1, codes.shape[-1])
    visible = np.minimum(visible[visible[:, 3] > 0.0, :3].astype(np.float64), 1.0)
    if not len(visible):
        return np.zeros((1, 3))
    samples = visible[:: -(-len(visible) // _SAMPLES)]
    palette = np.array([box.mean(axis=0) for box in _cut_by_variance(samples, count)])
    for _ in range(_ROUNDS):
        nearest = _find_nearest(samples[None], palette)[0]
        sizes = np.bincount(nearest, minlength=len(palette))
        sums = np.stack([np.bincount(nearest, samples[:, axis], len(palette)) for axis in range(3)], axis=1)
        moved = np.where(sizes[:, None] > 0, sums / np.maximum(sizes, 1)[:, None], palette)
        if np.abs(moved - palette).max() < 1e-4:
            break
        palette = moved
    return np.unique(palette, axis=0)


def _cut_by_variance(samples: Array, count: int) -> list[Array]:
    """Boxes of colors: again and again the one whose colors differ most is cut at their mean (Wan, Prusinkiewicz and
    Wong 1990)."""
    boxes = [samples]
    while len(boxes) < count:
        errors = [box.var(axis=0).max() * len(box) for box in boxes]
        number = int(np.argmax(errors))
        if errors[number] <= 0.0:
            break
        box = boxes.pop(number)
        values = box[:, int(np.argmax(box.var(axis=0)))]
        is_low = values < values.mean()
        boxes += [box[is_low], box[~is_low]]
    return boxes


def _find_nearest(codes: Array, palette: Array) -> Array:
    """The number of the nearest color for each pixel of [height, width, 3]."""
    flat, found = codes.reshape(-1, 3), np.empty(codes.shape[0] * codes.shape[1], np.intp)
    for first in range(0, len(flat), _BLOCK):
        found[first : first + _BLOCK] = _pick(flat[first : first + _BLOCK].astype(np.float64), palette)
    return found.reshape(codes.shape[:2])


def _pick(colors: Array, palette: Array) -> Array:
    """The number of the nearest color: the square of the distance without that of the color, which all have."""
    return np.argmin((palette * palette).sum(axis=1) - 2.0 * colors @ palette.T, axis=1)


def diffuse_errors(codes: Array, palette: Array, report: Callable[[float], bool]) -> Array:
    """The number of the color of each pixel by error diffusion (Floyd and Steinberg 1976), row by row, left to right.

    A pixel waits for its left neighbor and three above it, so all with the same x + 2 y are done at once: they lie side
    by side in a picture that is sheared by two pixels a row. No pixel goes beyond the colors of the palette, as errors
    that cannot be made good would grow.
    """
    height, width = codes.shape[:2]
    sheared = np.zeros((width + 2 * height + 2, height + 1, 3))
    rows, columns = np.mgrid[:height, :width]
    sheared[columns + 2 * rows, rows] = codes
    indices, low, high = np.empty((height, width), np.intp), palette.min(axis=0), palette.max(axis=0)
    last = width + 2 * (height - 1)
    for step in range(last):
        if step % 64 == 0 and not report(step / last):
            break
        first, end = max(-(-(step - width + 1) // 2), 0), min(step // 2, height - 1) + 1
        wanted = np.clip(sheared[step, first:end], low, high)
        picked = _pick(wanted, palette)
        error = wanted - palette[picked]
        here = np.arange(first, end)
        indices[here, step - 2 * here] = picked
        sheared[step + 1, first:end] += 7.0 / 16.0 * error
        sheared[step + 1, first + 1 : end + 1] += 3.0 / 16.0 * error
        sheared[step + 2, first + 1 : end + 1] += 5.0 / 16.0 * error
        sheared[step + 3, first + 1 : end + 1] += 1.0 / 16.0 * error
    return indices
