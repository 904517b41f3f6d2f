"""What eyes do at night."""

from __future__ import annotations

import numpy as np

from .blur import blur_gaussian
from .pixels import Array, luminance_of, premultiply_color, straight

REC709_TO_XYZ = np.array(  # ITU-R BT.709-6
    [
        [0.41239080, 0.35758434, 0.18048079],
        [0.21263901, 0.71516868, 0.07219232],
        [0.01933082, 0.11919478, 0.95053215],
    ]
)


def rod_response(xyz: Array) -> Array:
    """What the rods see of a color (Ward Larson et al. 1997)."""
    x, y, z = (xyz[..., i : i + 1] for i in range(3))
    return np.maximum(y * (1.33 * (1.0 + (y + z) / np.maximum(x, 1e-30)) - 1.68), 0.0)


def finest_stripes(light: Array) -> Array:
    """Cycles per degree that the eye can tell apart, fitted to Shaler's data (Ward Larson et al. 1997)."""
    decades = np.log10(np.maximum(light, 1e-9))
    return np.clip(17.25 * np.arctan(1.4 * decades + 0.35) + 25.72, 2.0, DAYLIGHT)


DAYLIGHT = 17.25 * np.pi / 2.0 + 25.72  # the limit in bright light


def scotopic_vision(
    image: Array,
    nits: float,
    amount: float,
    blue_shift: float,
    brightness: float,
    blur: float,
    field_of_view: float,
) -> Array:
    """Rods replace cones in dark places: no color, less sharpness, a bluish tint (Krawczyk et al. 2005)."""
    color, alpha = straight(image)
    light = np.clip(luminance_of(np.maximum(color, 0.0)) * nits, 0.0, 1e9)
    white = rod_response(np.array([0.95045593, 1.0, 1.08905775]))
    tint = np.maximum(1.0 + blue_shift * (np.array([1.05, 0.97, 1.27]) - 1.0), 0.0)
    rods = brightness * rod_response(np.maximum(color, 0.0) @ REC709_TO_XYZ.T) / white * tint
    share = amount * 0.04 / (0.04 + light)
    night = premultiply_color((1.0 - share) * color + share * rods, alpha)
    # Sigma of the blur in pixels; 1.86 of it in a period of stripes leave 0.3 percent of them.
    scale = amount * blur * image.shape[1] / np.degrees(field_of_view) / 1.86
    widest = scale * np.sqrt(2.0**-2 - DAYLIGHT**-2)
    if widest < 0.25:
        return night
    sigma = scale * np.sqrt(np.maximum(finest_stripes(light) ** -2.0 - DAYLIGHT**-2, 0.0))
    low, high, result = 0.0, min(0.5, widest), night
    while low < widest:  # between two blurs of the whole picture, by variance
        part = np.clip((sigma**2 - low**2) / (high**2 - low**2), 0.0, 1.0)
        result = (1.0 - part) * result + part * blur_gaussian(night, high, "clamp")
        low, high = high, min(high * np.sqrt(2.0), widest)
    return result
