"""How different colors look: CIELAB and the CIE measures of color difference.

A difference of 1 is about what can just be seen side by side, in all of them. Light is linear Rec.709 with white at 1,
as `decode_srgb` gives it, and its white point D65 is the white of CIELAB.
"""

from __future__ import annotations

import numpy as np

from ...color.transforms import Array

_TO_XYZ = np.array(
    [
        [0.4123907993, 0.3575843394, 0.1804807884],
        [0.2126390059, 0.7151686788, 0.0721923154],
        [0.0193308187, 0.1191947798, 0.9505321522],
    ]
)
"""Rec.709 to CIE 1931 XYZ (IEC 61966-2-1). The sums of its rows are the white."""

_EPSILON, _KAPPA = 216.0 / 24389.0, 24389.0 / 27.0
"""Where the cube root of CIELAB becomes a line, and the slope of that (CIE 15:2004)."""


def to_lab(light: Array) -> Array:
    """CIELAB of linear Rec.709 light [..., 3], as float64. Light above 1 and below 0 goes on by the same formulas."""
    relative = np.asarray(light, np.float64) @ (_TO_XYZ / _TO_XYZ.sum(axis=1, keepdims=True)).T
    root = np.where(relative > _EPSILON, np.cbrt(relative), (_KAPPA * relative + 16.0) / 116.0)
    x, y, z = root[..., 0], root[..., 1], root[..., 2]
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)


def scale_difference(lab: Array, reference: Array) -> Array:
    """The difference from a reference in lightness, chroma and hue, [..., 3]; its length is CIE94's (CIE 116-1995).

    It is linear in `lab`: the tolerances are those around the colors of the reference, as for graphic arts.
    """
    difference = lab - reference
    chroma = np.hypot(reference[..., 1], reference[..., 2])
    has_hue = chroma > 0.0
    scale = np.where(has_hue, chroma, 1.0)
    along_a, along_b = np.where(has_hue, reference[..., 1] / scale, 1.0), reference[..., 2] / scale
    outward = along_a * difference[..., 1] + along_b * difference[..., 2]
    around = along_a * difference[..., 2] - along_b * difference[..., 1]
    return np.stack([difference[..., 0], outward / (1.0 + 0.045 * chroma), around / (1.0 + 0.015 * chroma)], axis=-1)


def delta_e_2000(first: Array, second: Array) -> Array:
    """CIEDE2000 of CIELAB colors [..., 3], as [...] (Sharma, Wu and Dalal 2005)."""
    chroma = (np.hypot(first[..., 1], first[..., 2]) + np.hypot(second[..., 1], second[..., 2])) / 2.0
    stretch = 1.5 - 0.5 * np.sqrt(chroma**7 / (chroma**7 + 25.0**7))
    a1, a2, b1, b2 = first[..., 1] * stretch, second[..., 1] * stretch, first[..., 2], second[..., 2]
    c1, c2 = np.hypot(a1, b1), np.hypot(a2, b2)
    h1, h2 = np.degrees(np.arctan2(b1, a1)) % 360.0, np.degrees(np.arctan2(b2, a2)) % 360.0
    has_hues = c1 * c2 > 0.0
    turn = np.where(has_hues, (h2 - h1 + 180.0) % 360.0 - 180.0, 0.0)
    apart = np.abs(h1 - h2) > 180.0
    total = h1 + h2
    around = np.where(apart, np.where(total < 360.0, total + 360.0, total - 360.0), total) / 2.0
    hue = np.radians(np.where(has_hues, around, total))
    lightness, mean_chroma = (first[..., 0] + second[..., 0]) / 2.0, (c1 + c2) / 2.0
    tolerance = (
        1.0
        - 0.17 * np.cos(hue - np.radians(30.0))
        + 0.24 * np.cos(2.0 * hue)
        + 0.32 * np.cos(3.0 * hue + np.radians(6.0))
        - 0.20 * np.cos(4.0 * hue - np.radians(63.0))
    )
    middle = (lightness - 50.0) ** 2
    light_part = (second[..., 0] - first[..., 0]) / (1.0 + 0.015 * middle / np.sqrt(20.0 + middle))
    chroma_part = (c2 - c1) / (1.0 + 0.045 * mean_chroma)
    hue_part = 2.0 * np.sqrt(c1 * c2) * np.sin(np.radians(turn) / 2.0) / (1.0 + 0.015 * mean_chroma * tolerance)
    blue = np.radians(60.0 * np.exp(-(((np.degrees(hue) - 275.0) / 25.0) ** 2)))
    rotation = -2.0 * np.sqrt(mean_chroma**7 / (mean_chroma**7 + 25.0**7)) * np.sin(blue)
    return np.sqrt(np.maximum(light_part**2 + chroma_part**2 + hue_part**2 + rotation * chroma_part * hue_part, 0.0))
