"""What the header of a picture says about its color."""

from __future__ import annotations

import OpenImageIO as oiio

from ...color.file_space import SRGB, ColorHints
from ...color.management import LINEAR_REC709
from .open import make_printable, read_color_tag


def read_color_hints(spec: oiio.ImageSpec, format: str, integer: bool) -> ColorHints:
    """What a header says about color: a tag, what its format means without one, an ICC profile, chromaticities.

    OpenImageIO tags every picture of some formats by itself. Such a tag says no more than the format does.
    """
    tag, usual = read_color_tag(spec), ""
    if (format != "openexr" and tag in (SRGB, "sRGB")) or (format == "hdr" and tag == LINEAR_REC709):
        tag, usual = "", SRGB if tag == "sRGB" else tag
    primaries = spec.getattribute("chromaticities")
    return ColorHints(
        tag,
        usual,
        make_printable(spec.get_string_attribute("ICCProfile:profile_description")),
        tuple(primaries) if isinstance(primaries, tuple) else (),
        integer,
    )
