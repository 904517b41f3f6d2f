"""Attributes of a file's header that are worth carrying to the next file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import OpenImageIO as oiio

from .info import opened

_STRUCTURAL = re.compile(
    r"(oiio|openexr|png|jpeg|tiff|targa|bmp|gif|hdr|webp|jpegxl|ICCProfile|dwa):.*|Exif:(ColorSpace|Pixel.Dimension|ImageHistory)"
    r"|compression|planarconfig|Orientation|chromaticities|colorInteropID|name|type|version|view|multiView|chunkCount"
    r"|lineOrder|tiles|channels|dataWindow|displayWindow|screenWindow(Center|Width)|ICCProfile|CICP|acesImageContainerFlag"
    r"|envmap|wrapmodes|textureformat|fovcot|thumbnail.*|DateTime",
    re.IGNORECASE,
)
_JPEG_BYTES = 8000


@dataclass(frozen=True)
class Attribute:
    """A value whose type is more than int, float or str: `type` is OpenImageIO's name (`matrix`, `timecode`)."""

    type: str
    value: Any


def read_metadata(path: str | Path) -> dict[str, int | float | str | Attribute]:
    """The attributes of the first part that still hold for another picture made from it.

    Those that describe how this file is stored (windows, compression, color encoding, date) are left out.

    Raises:
        InputError: the file cannot be read.
    """
    with opened(path) as handle:
        found: dict[str, int | float | str | Attribute] = {}
        for item in handle.spec().extra_attribs:
            if is_structural(item.name):
                continue
            try:
                value: Any = item.value
            except UnicodeDecodeError:  # text of an unknown alphabet is no reason to refuse a picture
                continue
            found[item.name] = value if isinstance(value, int | float | str) else Attribute(str(item.type), value)
        return found


def is_structural(name: str) -> bool:
    """True for attributes that describe how a file is stored, which another picture made from it will not be."""
    return _STRUCTURAL.fullmatch(name) is not None


def add_metadata(spec: oiio.ImageSpec, metadata: Mapping[str, Any], format: str) -> None:
    """Put attributes into a header to be written, as far as the format can hold them.

    No date is among them: the same picture gives the same bytes.
    """
    spec.attribute("DateTime", "")
    for name, value in metadata.items():
        if is_structural(name):
            continue
        if format == "png" and not isinstance(value, str):  # PNG holds text only
            value = str(value.value if isinstance(value, Attribute) else value)
        if format == "jpeg" and len(str(value).encode()) > _JPEG_BYTES:  # libjpeg ends the process beyond 64 KB
            continue
        if isinstance(value, Attribute):
            spec.attribute(name, oiio.TypeDesc(value.type), value.value)
        else:
            spec.attribute(name, value)
