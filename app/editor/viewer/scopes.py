"""Computes the arrays of scopes. Pictures are [height, width, 3 or 4]; nothing here draws."""

from __future__ import annotations

import numpy as np

from ...color.primaries import REC709_LUMINANCE

Array = np.ndarray

BINS = 256
"""Bins of a histogram: one for each code of 8 bits."""

CHROMA = 0.5 * 1.06
"""The range of Cb and Cr in the vectorscope, from minus to plus this: all display colors, with a margin of 6 %."""

SKIN_ANGLE = 123.0
"""The skin tone line: degrees from the axis of Cb towards that of Cr (the I axis of NTSC)."""

TARGETS = (
    ("R", (0.75, 0.0, 0.0)),
    ("Yl", (0.75, 0.75, 0.0)),
    ("G", (0.0, 0.75, 0.0)),
    ("Cy", (0.0, 0.75, 0.75)),
    ("B", (0.0, 0.0, 0.75)),
    ("Mg", (0.75, 0.0, 0.75)),
)
"""The colors of 75 % color bars."""


def rgb_of(pixels: Array) -> Array:
    """Color [h, w, 3] of pixels of any number of channels, not finite ones black."""
    count = pixels.shape[2]
    rgb = pixels[..., :3] if count >= 3 else np.repeat(pixels[..., :1], 3, axis=2)
    if count == 2:
        rgb = np.concatenate([pixels, np.zeros_like(pixels[..., :1])], axis=2)
    return np.where(np.isfinite(rgb), rgb, 0.0).astype(np.float32)


def luminance(rgb: Array) -> Array:
    """BT.709 luma of encoded color, luminance of linear color: [h, w]."""
    return rgb @ np.asarray(REC709_LUMINANCE, np.float32)


def histogram(rgb: Array, low: float = 0.0, high: float = 1.0) -> Array:
    """Counts [4, BINS] of red, green, blue and luminance; what lies outside counts in the first and last bin."""
    four = np.concatenate([rgb, luminance(rgb)[..., None]], axis=2).reshape(-1, 4)
    bins = _bins(four, low, high, BINS)
    return np.stack([np.bincount(bins[:, index], minlength=BINS) for index in range(4)])


def measure_clipping(rgb: Array) -> tuple[float, float]:
    """The part of all pixels that is at or below 0 in every channel, and at or above 1 in any."""
    if not rgb.size:
        return 0.0, 0.0
    return float((rgb <= 0.0).all(axis=2).mean()), float((rgb >= 1.0).any(axis=2).mean())


def waveform(rgb: Array, columns: int, rows: int, low: float = 0.0, high: float = 1.0) -> Array:
    """How many pixels of a part of the width have a level: [rows, columns, 3], the highest level on top."""
    height, width, _ = rgb.shape
    level = rows - 1 - _bins(rgb, low, high, rows)
    column = np.broadcast_to((np.arange(width) * columns // max(width, 1))[None, :], (height, width))
    return np.stack(
        [
            np.bincount((level[..., index] * columns + column).ravel(), minlength=rows * columns).reshape(rows, columns)
            for index in range(3)
        ],
        axis=2,
    )


def parade(rgb: Array, columns: int, rows: int, low: float = 0.0, high: float = 1.0) -> Array:
    """Waveforms of red, green and blue side by side: [rows, columns, 3], each in its own color alone."""
    each = max(columns // 3, 1)
    counts = waveform(rgb, each, rows, low, high)
    parade_counts = np.zeros((rows, each * 3, 3), counts.dtype)
    for index in range(3):
        parade_counts[:, index * each : (index + 1) * each, index] = counts[..., index]
    return parade_counts


def chroma(rgb: Array) -> Array:
    """BT.709 Cb and Cr of encoded color [..., 3]: [..., 2], each -0.5..0.5 for colors of the display."""
    red, green, blue = np.moveaxis(np.asarray(rgb, np.float32), -1, 0)
    luma = REC709_LUMINANCE[0] * red + REC709_LUMINANCE[1] * green + REC709_LUMINANCE[2] * blue
    return np.stack([(blue - luma) / 1.8556, (red - luma) / 1.5748], axis=-1)


def vectorscope(rgb: Array, size: int) -> Array:
    """How many pixels have a chroma: [size, size], Cb to the right and Cr up."""
    pair = _bins(chroma(rgb).reshape(-1, 2), -CHROMA, CHROMA, size)
    place = (size - 1 - pair[:, 1]) * size + pair[:, 0]
    return np.bincount(place, minlength=size * size).reshape(size, size)


def chroma_place(rgb: tuple[float, float, float]) -> tuple[float, float]:
    """The place of a color in the vectorscope: fractions of its width and height from the top left."""
    blue, red = (float(part) for part in chroma(np.asarray(rgb)))
    return 0.5 + blue / (2 * CHROMA), 0.5 - red / (2 * CHROMA)


def glow(counts: Array) -> Array:
    """Counts as brightness 0 to 1: single pixels are visible, and large counts do not hide the rest."""
    top = float(np.percentile(counts[counts > 0], 97.0)) if (counts > 0).any() else 1.0
    return np.clip((counts / max(top, 1.0)) ** 0.45 * 1.1, 0.0, 1.0).astype(np.float32)


def extent(rgb: Array) -> tuple[float, float]:
    """The range that shows scene-linear color: 0..1, wider where the picture is."""
    if not rgb.size:
        return 0.0, 1.0
    low, high = float(rgb.min()), float(np.percentile(rgb, 99.9))
    return min(low, 0.0), max(high, 1.0)


def _bins(values: Array, low: float, high: float, count: int) -> Array:
    """Which of `count` equal parts of low..high each number is in, as np.histogram counts."""
    place = (values - low) * (count / max(high - low, 1e-12))
    return np.clip(np.floor(place), 0, count - 1).astype(np.int64)
