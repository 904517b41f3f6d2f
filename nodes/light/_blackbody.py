"""The color of a black body: a glowing thing that only its temperature colors, as lamps are described by kelvin."""

from __future__ import annotations

COOLEST, HOTTEST = 1000.0, 15000.0
"""The range of Krystek's formula, in kelvin. Outside of it the nearest color is taken."""

LUMINANCE = (0.2126729, 0.7151522, 0.0721750)
"""The luminance of linear Rec.709: the row that belongs to the matrix below."""


def blackbody_chromaticity(kelvin: float) -> tuple[float, float]:
    """The CIE 1931 chromaticity x, y of a black body (Krystek 1985, in CIE 1960 uv: exact to 0.0001)."""
    t = min(max(kelvin, COOLEST), HOTTEST)  # all numbers below are Krystek's, and those of the conversion to x, y
    u = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) / (1.0 + 8.42420235e-4 * t + 7.08145163e-7 * t * t)
    v = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) / (1.0 - 2.89741816e-5 * t + 1.61456053e-7 * t * t)
    scale = 2.0 * u - 8.0 * v + 4.0
    return 3.0 * u / scale, 2.0 * v / scale


def blackbody_rec709(kelvin: float) -> tuple[float, float, float]:
    """The color of a black body in linear Rec.709 with a luminance of 1. Components below 0 become 0."""
    x, y = blackbody_chromaticity(kelvin)
    big_x, big_z = x / y, (1.0 - x - y) / y
    rgb = (  # the inverse of the matrix of IEC 61966-2-1
        3.2404542 * big_x - 1.5371385 - 0.4985314 * big_z,
        -0.9692660 * big_x + 1.8760108 + 0.0415560 * big_z,
        0.0556434 * big_x - 0.2040259 + 1.0572252 * big_z,
    )
    red, green, blue = (max(part, 0.0) for part in rgb)
    luminance = sum(weight * part for weight, part in zip(LUMINANCE, (red, green, blue), strict=True))
    return red / luminance, green / luminance, blue / luminance
