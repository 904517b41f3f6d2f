"""The whole header of a file: its parts and windows, and everything that it says of itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import OpenImageIO as oiio

from ..graph.frames import is_video
from .info import ImageInfo, described, described_video, opened, space, text, video_facts
from .video import Facts, passed_on, said_of

Value = int | float | str | tuple[Any, ...]
Window = tuple[int, int, int, int]


@dataclass(frozen=True)
class PartHeader:
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


@dataclass(frozen=True)
class Header:
    """What a file says before its first pixel. `attributes` are those of all parts; of equal names the first counts."""

    info: ImageInfo
    parts: tuple[PartHeader, ...]
    attributes: Mapping[str, Value]


def read_header(path: str | Path) -> Header:
    """Read all of it.

    Raises:
        InputError: as `info`.
    """
    if is_video(str(path)):
        return _video_header(video_facts(path))
    with opened(path) as handle:
        info = described(handle, str(path))
        parts: list[PartHeader] = []
        attributes: dict[str, Value] = {}
        while handle.seek_subimage(len(parts), 0):
            spec = handle.spec()
            parts.append(_part(len(parts), spec))
            attributes = {**_attributes(spec), **attributes}
    return Header(info, tuple(parts), MappingProxyType(attributes))


def _video_header(facts: Facts) -> Header:
    info, window = described_video(facts), (0, 0, *facts.size)
    layer = info.layers[0]
    formats = (layer.format,) * len(layer.channels)
    part = PartHeader(0, "", "", facts.container, facts.codec, window, window, layer.channels, formats, "")
    return Header(info, (part,), MappingProxyType({**passed_on(facts), **said_of(facts)}))


def _part(index: int, spec: oiio.ImageSpec) -> PartHeader:
    formats = spec.channelformats or (spec.format,) * spec.nchannels
    tiles = f"tiles of {spec.tile_width}x{spec.tile_height}" if spec.tile_width else "scan lines"
    return PartHeader(
        index,
        text(spec.get_string_attribute("oiio:subimagename")),
        text(spec.get_string_attribute("view")),
        tiles,
        text(spec.get_string_attribute("compression")),
        (spec.x, spec.y, spec.width, spec.height),
        (spec.full_x, spec.full_y, spec.full_width or spec.width, spec.full_height or spec.height),
        tuple(map(text, spec.channelnames)),
        tuple(map(str, formats)),
        space(spec),
    )


def _attributes(spec: oiio.ImageSpec) -> dict[str, Value]:
    found: dict[str, Value] = {}
    for item in spec.extra_attribs:
        try:
            value: Any = item.value
        except UnicodeDecodeError:  # text of an unknown alphabet is no reason to refuse a picture
            continue
        if isinstance(value, str):
            found[text(item.name)] = text(value)
        elif isinstance(value, int | float | tuple):
            found[text(item.name)] = value
    return found
