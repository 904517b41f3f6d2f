"""Files and arrays: every picture format that OpenImageIO reads, color through OpenColorIO."""

from __future__ import annotations

from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from .color import displays, looks, to_display, views
from .encoding import Encoding
from .info import ImageInfo, content_hash, find_layer, fingerprint, info
from .layers import Layer
from .managed import color_digest, color_mark
from .metadata import Attribute, read_metadata
from .primaries import working_of
from .read import Pixels, Want, read, read_many
from ..resources.atomic_write import sweep
from .write import check_destination, rounds, write

if TYPE_CHECKING:
    from .recolor import gpu_view
    from .sequences import Sequence, find_sequence, frame_file, suggest_pattern
    from .video_file import VideoFile, check_video

__all__ = [
    "Attribute",
    "Encoding",
    "ImageInfo",
    "Layer",
    "Pixels",
    "Sequence",
    "VideoFile",
    "Want",
    "check_destination",
    "check_video",
    "color_digest",
    "color_mark",
    "content_hash",
    "displays",
    "find_layer",
    "find_sequence",
    "fingerprint",
    "frame_file",
    "gpu_view",
    "info",
    "looks",
    "read",
    "read_many",
    "read_metadata",
    "rounds",
    "suggest_pattern",
    "sweep",
    "to_display",
    "views",
    "working_of",
    "write",
]

_LATER = MappingProxyType(
    {
        "Sequence": "sequences",
        "VideoFile": "video_file",
        "check_video": "video_file",
        "find_sequence": "sequences",
        "frame_file": "sequences",
        "gpu_view": "recolor",
        "suggest_pattern": "sequences",
    }
)
"""What most renderings do without, and the modules that have it, which are loaded when it is asked for (PEP 562)."""


def __getattr__(name: str) -> Any:
    if name in _LATER:
        return getattr(import_module(f".{_LATER[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
