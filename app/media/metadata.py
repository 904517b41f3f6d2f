"""Attributes of a file's header that are copied to the files made from it."""

from __future__ import annotations

import contextlib
import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import OpenImageIO as oiio
from msgspec import Struct

from ..graph.frames import is_video
from ..resources.library_names import escape_bytes
from ..resources.sandbox import Sandbox
from .pictures.open import open_picture

_STRUCTURAL = re.compile(
    r"(oiio|openexr|png|jpeg|tiff|targa|bmp|gif|hdr|webp|jpegxl|ICCProfile|dwa):.*|Exif:(ColorSpace|Pixel.Dimension|ImageHistory)"
    r"|compression(:.*)?|planarconfig|Orientation|chromaticities|colorInteropID|name|type|version|view|multiView|chunkCount"
    r"|lineOrder|tiles|channels|dataWindow|displayWindow|screenWindow(Center|Width)|ICCProfile|CICP|acesImageContainerFlag"
    r"|envmap|wrapmodes|textureformat|fovcot|thumbnail.*|DateTime",
    re.IGNORECASE,
)
_JPEG_BYTES = 8000
"""Bytes of one attribute in a JPEG. Chosen by judgement: six long texts fit into `_JPEG_TOTAL`, and a single one cannot
take the place of all others."""
_JPEG_TOTAL = 48_000
"""Bytes of all attributes together except the packed one: each block of a JPEG's header may hold all of them, with
their names, within 65,533 bytes (ITU T.81)."""
_ASPECTS = ("PixelAspectRatio", "XResolution", "YResolution")
_MOST_ASPECT = 1e6
"""The largest pixel aspect ratio that OpenEXR accepts."""
_PACKED = {"jpeg": "halation:header", "tiff": "DocumentName"}
"""Formats without custom attributes, and the one attribute that holds all of Halation's."""
_PACKED_BYTES = 60_000
"""Bytes of the packed attribute of a JPEG: below the 65,533 of a block, with room for its name and escapes."""
_OURS = "halation:"


class TypedAttribute(Struct, frozen=True):
    """A value with a type besides int, float and str: `type` is OpenImageIO's name (`matrix`, `timecode`)."""

    type: str
    value: Any


def read_metadata(path: str | Path, sandbox: Sandbox) -> dict[str, int | float | str | TypedAttribute]:
    """The attributes of the first part that also apply to a picture made from it.

    Those that describe how this file is stored (windows, compression, color encoding, date) are left out.

    Raises:
        InputError: the file cannot be read.
    """
    if is_video(str(path)):
        from .video import find_kept_tags, read_video_info

        return {**find_kept_tags(read_video_info(str(path), sandbox=sandbox))}
    with open_picture(path, sandbox=sandbox) as handle:
        attributes: dict[str, int | float | str | TypedAttribute] = {}
        for item in handle.spec().extra_attribs:
            try:
                if is_structural(item.name):
                    continue
                value: Any = item.value
            except UnicodeDecodeError:  # text in an unknown encoding is no reason to refuse a picture
                continue
            if value is not None:
                is_plain = isinstance(value, int | float | str)
                attributes[item.name] = value if is_plain else TypedAttribute(str(item.type), value)
        return _unpack(attributes, _PACKED.get(handle.format_name(), ""))


def set_pixel_aspect(metadata: Mapping[str, Any], aspect: float) -> dict[str, Any]:
    """The attributes of a picture whose pixels are `aspect` times as wide as high.

    What those of a picture with other pixels say of its resolution is left out.
    """
    if float(metadata.get(_ASPECTS[0], 1.0)) == aspect:
        return dict(metadata)
    return {name: item for name, item in metadata.items() if name not in _ASPECTS} | {_ASPECTS[0]: aspect}


def is_structural(name: str) -> bool:
    """True for attributes that describe how this file is stored."""
    return _STRUCTURAL.fullmatch(name) is not None


def add_metadata(spec: oiio.ImageSpec, metadata: Mapping[str, Any], format: str) -> None:
    """Put attributes into a header, as far as the format can hold them.

    No date is among them: the same picture gives the same bytes.
    """
    spec.attribute("DateTime", "")
    left, has_aspect = _JPEG_TOTAL, _is_aspect(metadata)
    for name, value in _pack(metadata, format).items():
        if is_structural(name):
            continue
        if format == "png" and not isinstance(value, str):  # PNG holds text only
            value = str(value.value if isinstance(value, TypedAttribute) else value)
        name, value = escape_bytes(name), escape_bytes(value) if isinstance(value, str) else value
        if name in _ASPECTS and not has_aspect:
            continue
        if format == "jpeg" and isinstance(value, TypedAttribute):  # it would be read back as
            continue
        if format == "jpeg":  # libjpeg ends the process if a block of the header is longer than 64 KB
            is_packed, size = name == _PACKED["jpeg"], _measure_escaped(str(value))
            if size > (_PACKED_BYTES if is_packed else min(_JPEG_BYTES, left)):
                continue
            if is_packed:
                spec.attribute("jpeg:com_attributes", 1)
            else:
                left -= size
        _set_attribute(spec, name, value)


def _measure_escaped(text: str) -> int:
    """The bytes of a text in the packet of a JPEG, which is XML."""
    from html import escape  # it comes with a table of 2,000 names, which other formats do not need

    return len(escape(text).encode())


def _set_attribute(spec: oiio.ImageSpec, name: str, value: Any) -> None:
    """Put an attribute into a header, or leave it out if its value does not fit its type, as in damaged files."""
    with contextlib.suppress(TypeError, ValueError, RuntimeError, OverflowError):
        if isinstance(value, TypedAttribute):
            spec.attribute(name, oiio.TypeDesc(value.type), value.value)
        else:
            spec.attribute(name, value)


def _is_aspect(metadata: Mapping[str, Any]) -> bool:
    """True if a pixel aspect ratio, given as a number or by two resolutions, is possible."""
    numbers = [value for name in _ASPECTS if (value := metadata.get(name)) is not None]
    if not all(isinstance(number, int | float) and 0.0 < number < math.inf for number in numbers):
        return False
    across, down = (metadata.get(name, 1.0) for name in _ASPECTS[1:])
    return all(1.0 / _MOST_ASPECT <= ratio <= _MOST_ASPECT for ratio in (metadata.get(_ASPECTS[0], 1.0), across / down))


def _pack(metadata: Mapping[str, Any], format: str) -> dict[str, Any]:
    """The attributes to write: for formats with a single custom attribute, all of Halation's as one JSON text."""
    name = _PACKED.get(format)
    ours = {key: value for key, value in metadata.items() if key.startswith(_OURS)}
    if not name or not ours:
        return dict(metadata)
    rest = {key: value for key, value in metadata.items() if key not in ours and key != name}
    return {**rest, name: json.dumps(ours, separators=(",", ":"), default=str)}


def _unpack(
    attributes: dict[str, int | float | str | TypedAttribute], name: str
) -> dict[str, int | float | str | TypedAttribute]:
    """The attributes from that JSON text."""
    text = attributes.get(name, "")
    if not isinstance(text, str) or not text.startswith(f'{{"{_OURS}'):
        return attributes
    try:
        ours: Any = json.loads(text)
    except (ValueError, RecursionError):
        return attributes
    rest = {key: value for key, value in attributes.items() if key != name}
    return {**rest, **{key: value for key, value in ours.items() if isinstance(value, str)}}
