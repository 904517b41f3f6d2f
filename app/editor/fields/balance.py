"""Color balance and color temperature as numbers: what a wheel and the kelvin of the picker show. Nothing here draws.

A color is split into its level, the mean of red, green and blue, and a point of the plane in which they add up to 0.
There red, green and blue lie 120 degrees apart, so the angle of the point is the hue and its distance the strength. The
split loses nothing: a color that a wheel shows and gives back is the same color.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from halation.nodes.light._blackbody import COOLEST, HOTTEST, LUMINANCE, blackbody_rec709

if TYPE_CHECKING:
    from .colors import RGBA

_HALF_ROOT = math.sqrt(3.0) / 2.0
"""The sine of 120 degrees, by which the primaries are apart on the wheel."""


def split_balance(color: RGBA) -> tuple[float, float, float]:
    """The level of a color, and its point on the wheel: red to the right, green 120 degrees clockwise from it."""
    red, green, blue = color[:3]
    return (red + green + blue) / 3.0, (2.0 * red - green - blue) / 3.0, (green - blue) / (2.0 * _HALF_ROOT)


def join_balance(level: float, x: float, y: float, alpha: float = 1.0) -> RGBA:
    """The color of a level and a point on the wheel."""
    return level + x, level - x / 2.0 + _HALF_ROOT * y, level - x / 2.0 - _HALF_ROOT * y, alpha


def set_temperature(color: RGBA, kelvin: float) -> RGBA:
    """The light of a black body of a temperature, as bright as the color; of brightness 1 if that is black."""
    luminance = sum(weight * part for weight, part in zip(LUMINANCE, color[:3], strict=True))
    luminance = luminance if luminance > 0.0 else 1.0
    red, green, blue = (part * luminance for part in blackbody_rec709(kelvin))
    return red, green, blue, color[3]


def find_temperature(color: RGBA) -> float:
    """The temperature of the black body whose light has the same ratio of blue to red as a color, in kelvin."""
    red, _, blue = color[:3]
    if red <= 0.0:
        return HOTTEST if blue > 0.0 else 6504.0
    low, high = math.log(COOLEST), math.log(HOTTEST)
    for _ in range(40):  # the ratio grows with the temperature; 40 halvings leave nothing that a number shows
        middle = (low + high) / 2.0
        light = blackbody_rec709(math.exp(middle))
        low, high = (middle, high) if light[2] * red < blue * light[0] else (low, middle)
    return math.exp(high)
