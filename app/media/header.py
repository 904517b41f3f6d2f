"""The whole header of a file: its parts, windows and attributes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import OpenImageIO as oiio
from msgspec import Struct

from ..graph.frames import is_video
from ..resources.sandbox import Sandbox
from .layers import ImageInfo
from .pictures.open import describe_picture, make_printable, open_picture, read_color_tag
from .video import VideoInfo, describe_video, describe_video_attributes, find_kept_tags, read_video_info

Value = int | float | str | tuple[Any, ...]
Window = tuple[int, int, int, int]


class PartHeader(Struct, frozen=True):
    """One part of a file. Windows are left, top, width and height; `tag` is the color space, "data" or ""."""

    index: int
    name: str
    view: str
    storage: str
    compression: str
    data: Window
    display: Window
    channels: tuple[str, ...]
    formats: tuple[str, ...]
    tag: str


class FileHeader(Struct, frozen=True):
    """The header of a file. `attributes` are those of all parts; of equal names the first one counts."""

    info: ImageInfo
    parts: tuple[PartHeader, ...]
    attributes: Mapping[str, Value]


def read_header(path: str | Path, sandbox: Sandbox) -> FileHeader:
    """Read all of it.

    Raises:
        InputError: as `info`.
    """
    if is_video(str(path)):
        return _describe_video_header(read_video_info(str(path), sandbox=sandbox), sandbox=sandbox)
    with open_picture(path, sandbox=sandbox) as handle:
        info = describe_picture(handle, str(path), sandbox=sandbox)
        parts: list[PartHeader] = []
        attributes: dict[str, Value] = {}
        while handle.seek_subimage(len(parts), 0):
            spec = handle.spec()
            parts.append(_read_part(len(parts), spec))
            attributes = {**_read_attributes(spec), **attributes}
    return FileHeader(info, tuple(parts), MappingProxyType(attributes))


def _describe_video_header(video: VideoInfo, sandbox: Sandbox) -> FileHeader:
    info, window = describe_video(video, sandbox=sandbox), (0, 0, *video.size)
    layer = info.layers[0]
    formats = (layer.format,) * len(layer.channels)
    part = PartHeader(0, "", "", video.container, video.codec, window, window, layer.channels, formats, "")
    return FileHeader(info, (part,), MappingProxyType({**find_kept_tags(video), **describe_video_attributes(video)}))


def _read_part(index: int, spec: oiio.ImageSpec) -> PartHeader:
    formats = spec.channelformats or (spec.format,) * spec.nchannels
    tiles = f"tiles of {spec.tile_width}x{spec.tile_height}" if spec.tile_width else "scan lines"
    return PartHeader(
        index,
        make_printable(spec.get_string_attribute("oiio:subimagename")),
        make_printable(spec.get_string_attribute("view")),
        tiles,
        make_printable(spec.get_string_attribute("compression")),
        (spec.x, spec.y, spec.width, spec.height),
        (spec.full_x, spec.full_y, spec.full_width or spec.width, spec.full_height or spec.height),
        tuple(map(make_printable, spec.channelnames)),
        tuple(map(str, formats)),
        read_color_tag(spec),
    )


def _read_attributes(spec: oiio.ImageSpec) -> dict[str, Value]:
    attributes: dict[str, Value] = {}
    for item in spec.extra_attribs:
        try:
            name, value = make_printable(item.name), item.value
        except UnicodeDecodeError:  # text in an unknown encoding is no reason to refuse a picture
            continue
        if isinstance(value, str):
            attributes[name] = make_printable(value)
        elif isinstance(value, int | float | tuple):
            attributes[name] = value
    return attributes
