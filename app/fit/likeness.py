"""How far a picture is from a reference: lists of differences, whose squares add up to the square of the error.

Both pictures are light of a display, linear Rec.709 over black. Differences are those of CIELAB in the units of
CIE94, so an error of 1 is about what can just be seen.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ..media.comparison.color_difference import scale_difference, to_lab
from ..media.comparison.metrics import Array

_FINEST = 0.5
"""The highest frequency that pixels hold, in periods per pixel."""

_QUIET = 0.05
"""Units of lightness: amplitudes far below it do not count, as nobody sees them. A difference of 1 is just visible side
by side. Chosen by judgement: for the look of another noise, a blur of 5 pixels is found as 6.0 pixels, with half of it
as 5.8 and with twice as much as 6.1."""

MAX_PIXELS = 40_000
"""Pixels that are compared of a larger picture, evenly spread over it. Chosen by judgement: the gradient of forty
values at so many takes 40 MB, and few values need more."""

_LEVELS = (np.arange(64) + 0.5) / 64.0
_DIRECTIONS = 24
_BANDS = 10
_TONE_WEIGHT, _COLOR_WEIGHT, _TEXTURE_WEIGHT = 1.0, 1.0, 2.0
"""Of what counts for a look: levels of tones and of colors along each direction, directions, bands of frequencies.
Chosen by judgement; a texture of double amplitude counts as much as a shift of tones by 1.4. For the look of another
noise, a blur of 5 pixels is found as 6.0 pixels. With half and twice the weight of textures it is 6.4 and 5.4, with
half and twice the directions 6.0, with half and twice the bands 6.6 and 6.3; the exposure is always found to 0.01."""


class Likeness(Protocol):
    """Measures pictures against one reference."""

    def measure(self, light: Array) -> Array:
        """The differences of a picture [h, w, 3] from the reference, each time as many of them."""
        ...


class PixelLikeness:
    """Compares pixel by pixel with the same frame. `light` is the reference in the size of the pictures."""

    def __init__(self, light: Array) -> None:
        self._places = _spread(light.shape[0] * light.shape[1])
        self._reference = to_lab(light.reshape(-1, 3)[self._places])

    def measure(self, light: Array) -> Array:
        """The differences in lightness, chroma and hue."""
        lab = to_lab(light.reshape(-1, 3)[self._places])
        return scale_difference(lab, self._reference).ravel() / np.sqrt(len(self._places))


class LookLikeness:
    """Compares what another picture looks like, wherever things are in it: tones, colors, grain and sharpness.

    Tones are the distribution of lightness; colors are compared by the sliced Wasserstein distance (Rabin et al. 2011);
    grain and sharpness by the amplitudes of octave bands of lightness, in pixels of the picture.
    """

    def __init__(self, light: Array) -> None:
        random = np.random.default_rng(1)
        directions = random.normal(size=(3, _DIRECTIONS))
        self._directions = directions / np.linalg.norm(directions, axis=0)
        self._reference = self._describe(light)

    def measure(self, light: Array) -> Array:
        """The differences of tones, of colors along each direction, and of the logarithms of amplitudes."""
        return self._describe(light) - self._reference

    def _describe(self, light: Array) -> Array:
        lab = to_lab(light)
        colors = lab.reshape(-1, 3)[_spread(light.shape[0] * light.shape[1])]
        tones = np.quantile(colors[:, 0], _LEVELS) * (_TONE_WEIGHT / np.sqrt(_LEVELS.size))
        slices = np.quantile(colors @ self._directions, _LEVELS, axis=0).ravel()
        slices *= _COLOR_WEIGHT * np.sqrt(3.0 / slices.size)
        bands = np.log(_measure_bands(lab[..., 0])) * (_TEXTURE_WEIGHT / np.sqrt(_BANDS))
        return np.concatenate([tones, slices, bands])


def _spread(count: int) -> Array:
    """Places of at most `MAX_PIXELS` of so many pixels, one at random in each of as many equal parts."""
    if count <= MAX_PIXELS:
        return np.arange(count)
    part = count / MAX_PIXELS
    jitter = np.random.default_rng(1).random(MAX_PIXELS)
    return ((np.arange(MAX_PIXELS) + jitter) * part).astype(np.int64)


def _measure_bands(lightness: Array) -> Array:
    """The amplitude of lightness in each half octave below the limit of the pixels, in its units, plus a little.

    The spectrum is taken with a Hann window, so that the borders of the picture add nothing.
    """
    height, width = lightness.shape
    window = np.hanning(height + 2)[1:-1, None] * np.hanning(width + 2)[None, 1:-1]
    mean = float((lightness * window).sum() / window.sum())
    power = np.abs(np.fft.rfft2((lightness - mean) * window)) ** 2 / (window**2).sum() / lightness.size
    power[:, 1 : (width + 1) // 2] *= 2.0
    frequency = np.hypot(np.fft.fftfreq(height)[:, None], np.fft.rfftfreq(width)[None, :])
    octaves = np.clip(np.floor(-2.0 * np.log2(np.maximum(frequency, 1e-9) / _FINEST)), 0, _BANDS).astype(int)
    return np.sqrt(np.bincount(octaves.ravel(), power.ravel(), _BANDS + 1)[:_BANDS]) + _QUIET
