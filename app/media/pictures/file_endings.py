"""Which files are pictures, by the endings of their names."""

from __future__ import annotations

from pathlib import Path

import OpenImageIO as oiio

from ...graph.frames import VIDEO_ENDINGS

_NO_PICTURES = ("null", "term", "ffmpeg", "openvdb", "ptex")
"""Formats of OpenImageIO that hold no still pictures."""


def list_readable_endings() -> frozenset[str]:
    """File name endings of pictures that can be read, such as `.exr`."""
    formats = oiio.get_string_attribute("extension_list").split(";")
    entries = [entry.partition(":") for entry in formats if not entry.startswith(_NO_PICTURES)]
    return frozenset(f".{ending.lower()}" for _, _, endings in entries for ending in endings.split(",") if ending)


def is_picture(path: str | Path) -> bool:
    """True if the ending of a path is that of a picture or video that can be read."""
    ending = Path(path).suffix.lower()
    return ending != ".json" and (ending in VIDEO_ENDINGS or ending in list_readable_endings())
