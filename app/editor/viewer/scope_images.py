"""Scopes as 8-bit pictures, [height, width, 4]: bright traces on transparent black."""

from __future__ import annotations

import numpy as np

from . import scopes
from .scopes import Array

LEVELS = 192
"""Rows of waveforms."""

_RED, _GREEN, _BLUE = (1.0, 0.28, 0.28), (0.30, 0.95, 0.40), (0.36, 0.56, 1.0)
_CHANNELS = np.asarray((_RED, _GREEN, _BLUE), np.float32)


def histogram_image(rgb: Array, low: float, high: float, logarithmic: bool, dark: bool, rows: int = 128) -> Array:
    """Filled curves of red, green and blue that add up where they overlap, and luminance behind them."""
    counts = scopes.histogram(rgb, low, high).astype(np.float32)
    inner = counts[:, 1:-1]  # clipped pixels would flatten everything else
    if logarithmic:
        counts, inner = np.log1p(counts), np.log1p(inner)
    top = max(float(np.percentile(inner, 99.5)), 1e-6)  # one level that most pixels have would too
    height = np.clip(counts / top, 0.0, 1.0) * rows
    row = np.arange(rows, 0, -1, dtype=np.float32)[:, None] - 0.5
    covered = np.clip(height[:, None, :] - row + 0.5, 0.0, 1.0)
    color = np.einsum("crw,ck->rwk", covered[:3], _CHANNELS)
    gray = covered[3][..., None] * (0.35 if dark else 0.6)
    cover = covered.max(axis=0)
    color = np.maximum(color, gray) if dark else _ink(color) * (covered[:3].max(axis=0)[..., None] > 0.0)
    return _image(color, cover if dark else np.maximum(covered[:3].max(axis=0) * 0.9, gray[..., 0]))


def waveform_image(rgb: Array, low: float, high: float, dark: bool) -> Array:
    """Levels of all channels, in their colors, by the place along the width."""
    counts = scopes.waveform(rgb, rgb.shape[1], LEVELS, low, high)
    return _traces(counts, dark)


def parade_image(rgb: Array, low: float, high: float, dark: bool) -> Array:
    """The waveforms of red, green and blue side by side."""
    return _traces(scopes.parade(rgb, rgb.shape[1] // 3 * 3, LEVELS, low, high), dark)


def vectorscope_image(rgb: Array, dark: bool, size: int = 256) -> Array:
    """The vectorscope, with traces in the colors of their chroma."""
    light = scopes.glow(scopes.vectorscope(np.clip(rgb, 0.0, 1.0), size))
    axis = (np.arange(size, dtype=np.float32) + 0.5) / size * (2 * scopes.CHROMA) - scopes.CHROMA
    blue, red = np.meshgrid(axis, -axis)
    luma = np.full_like(blue, 0.55)
    color = np.stack(
        [
            luma + 1.5748 * red,
            luma - 0.1873 * blue - 0.4681 * red,
            luma + 1.8556 * blue,
        ],
        axis=2,
    )
    return _image(np.clip(color, 0.15, 1.0) if dark else _ink(color), light)


def _traces(counts: Array, dark: bool) -> Array:
    """Traces: the hue from the share of each channel, the opacity from the count."""
    light = scopes.glow(counts)
    color = light @ _CHANNELS
    hue = color / np.maximum(color.max(axis=2, keepdims=True), 1e-6)
    cover = light.max(axis=2)
    return _image(hue, cover) if dark else _image(_ink(hue), cover**0.6)


def _ink(color: Array) -> Array:
    """A color that is visible on a light background."""
    return color / np.maximum(color.max(axis=2, keepdims=True), 1e-6) * 0.58


def _image(color: Array, cover: Array) -> Array:
    """Straight color and opacity as 8 bits."""
    pixels = np.concatenate([np.clip(color, 0.0, 1.0), np.clip(cover, 0.0, 1.0)[..., None]], axis=2)
    return (pixels * 255.0 + 0.5).astype(np.uint8)
