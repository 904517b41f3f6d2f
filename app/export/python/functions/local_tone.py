"""Tone mapping that looks at what lies around each pixel."""

from __future__ import annotations

import numpy as np

from .blur import blur_gaussian
from .pixels import Array, luminance_of, premultiply_color, straight
from .tone import natural_key


def local_tone_map(
    image: Array,
    key: float,
    auto_key: bool,
    nits: float,
    size: float,
    sharpness: Array | float,
    threshold: Array | float,
    saturation: Array | float,
    clip: bool,
    average: Array | float | None = None,
    maximum: Array | float | None = None,
) -> Array:
    """Compress light locally: each pixel by the largest area around it that is uniform (Reinhard et al. 2002).

    An area may grow through eight scales, each 1.6 times as wide as the one before, while the mean of its surround, the
    next scale, is alike.
    """
    color, alpha = straight(image)
    weight, light = np.where(alpha > 1e-6, alpha, 0.0), luminance_of(np.maximum(color, 0.0))
    if average is None:
        average = float(np.exp((weight * np.log(1e-5 + light)).sum() / weight.sum())) if weight.sum() > 0.0 else 0.0
    if maximum is None:
        maximum = float(light[weight > 0.0].max(initial=0.0))
    typical = np.maximum(average, 1e-9)
    middle = natural_key(typical * nits) if auto_key else key
    white = np.maximum(maximum, 1e-9) * middle / typical
    scaled = weight * np.minimum(light * middle / typical, 1e9)

    def mean_within(sigma: float) -> Array:
        whole = blur_gaussian(weight, sigma, "clamp")
        return np.where(
            whole > 1e-6, np.maximum(blur_gaussian(scaled, sigma, "clamp") / np.maximum(whole, 1e-6), 0.0), 0.0
        )

    inner, area, grows = mean_within(0.0), mean_within(0.0), np.ones(light.shape, bool)
    for step in range(-1, 8):  # the pixel alone, then the eight scales
        # The Gaussian of a scale s has a sigma of s / 4; that of the surround is the next one.
        outer = mean_within(0.25 * size * 1.6 ** (step + 1))
        uneven = np.abs(inner - outer) / (np.exp2(sharpness) * middle / 1.6 ** (2 * step) + inner)
        grows = grows & (uneven < threshold)
        area = np.where(grows, outer if step < 0 else inner, area)
        inner = outer
    bright = np.clip(color, 0.0, 1e9)
    light = np.maximum(luminance_of(bright), 1e-12)
    keyed = light * middle / typical
    shown = keyed * (1.0 + keyed / white**2) / (1.0 + area) * np.maximum(bright / light, 1e-12) ** saturation
    return premultiply_color(np.clip(shown, 0.0, 1.0) if clip else shown, alpha)
