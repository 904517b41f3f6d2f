"""What the header of a file says of its color."""

from __future__ import annotations

import OpenImageIO as oiio

from ...color.file_space import SRGB, Hints
from ...color.management import LINEAR_REC709
from ..info import make_printable
from ..info import read_color_tag as tag_of


def read_color_hints(spec: oiio.ImageSpec, format: str, integer: bool) -> Hints:
    """What a header says of its color."""
    tag, usual = tag_of(spec), ""
    if format != "openexr" and tag in (SRGB, "sRGB"):  # as good as nothing: readers say so of any picture
        tag, usual = "", SRGB
    if format == "hdr" and tag == LINEAR_REC709:
        tag, usual = "", tag
    primaries = spec.getattribute("chromaticities")
    return Hints(
        tag,
        usual,
        make_printable(spec.get_string_attribute("ICCProfile:profile_description")),
        tuple(primaries) if isinstance(primaries, tuple) else (),
        integer,
    )
