"""Reads what the header of a picture says about its color."""

from __future__ import annotations

import math

import OpenImageIO as oiio

from ...color.file_space import SRGB, ColorHints
from ...color.management import LINEAR_REC709
from .open import COLOR_TAG, make_printable, read_color_tag

_STRAIGHT_FORMATS = ("bmp", "gif", "ico", "jpegxl")
"""Formats with straight color that OpenImageIO does not report as such."""

_UNUSABLE = {"pnm": "rec709"}
"""Tags that OpenImageIO gives to every file of a format, but that programs do not follow: PNM means BT.709 by its
specification and sRGB in practice, and floats in PFM are linear."""


def read_color_hints(spec: oiio.ImageSpec, format: str, stored: str) -> ColorHints:
    """The facts of a header about color: a tag, the meaning of the format without a tag, an ICC profile, a gamma,
    chromaticities.

    OpenImageIO tags every picture of some formats by itself. Such a tag says no more than the format does.
    """
    tag, usual = read_color_tag(spec), ""
    is_own_tag = format == "openexr" or bool(spec.get_string_attribute(COLOR_TAG))
    if (format != "openexr" and tag in (SRGB, "sRGB")) or (format == "hdr" and tag == LINEAR_REC709):
        tag, usual = "", SRGB if tag == "sRGB" else tag
    if tag and tag.casefold() == _UNUSABLE.get(format):
        tag = ""
    return ColorHints(
        tag,
        usual,
        make_printable(spec.get_string_attribute("ICCProfile:profile_description")),
        _read_chromaticities(spec),
        "int" in stored and format != "openexr",
        0.0 if is_own_tag else _read_gamma(spec),
        is_own_tag,
    )


def has_straight_alpha(spec: oiio.ImageSpec, format: str) -> bool:
    """True if the color of a file is straight."""
    return spec.get_int_attribute("oiio:UnassociatedAlpha") == 1 or format in _STRAIGHT_FORMATS


def _read_chromaticities(spec: oiio.ImageSpec) -> tuple[float, ...]:
    """x and y of the primaries and white; nothing where the attribute is missing or damaged."""
    numbers = spec.getattribute("chromaticities")
    if not isinstance(numbers, tuple) or not all(isinstance(number, int | float) for number in numbers):
        return ()
    return tuple(float(number) for number in numbers)


def _read_gamma(spec: oiio.ImageSpec) -> float:
    """The exponent that decodes the numbers, 0 if the header has none."""
    gamma = spec.get_float_attribute("oiio:Gamma", 0.0)
    return gamma if math.isfinite(gamma) and gamma > 0.0 else 0.0
