"""Files and arrays: pictures by OpenImageIO, sequences, videos, meshes."""

from __future__ import annotations

from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from .info import ImageInfo, find_layer, read_info
from .layers import Layer
from .metadata import TypedAttribute, read_metadata
from .pictures.writer import check_destination, stores_halves, write_picture
from .pixels import LayerRequest, Pixels, read_layer, read_layers

if TYPE_CHECKING:
    from .sequences import Sequence, find_sequence, frame_file, suggest_pattern
    from .video.writer import VideoFile, check_video

__all__ = [
    "ImageInfo",
    "Layer",
    "LayerRequest",
    "Pixels",
    "Sequence",
    "TypedAttribute",
    "VideoFile",
    "check_destination",
    "check_video",
    "find_layer",
    "find_sequence",
    "frame_file",
    "read_info",
    "read_layer",
    "read_layers",
    "read_metadata",
    "stores_halves",
    "suggest_pattern",
    "write_picture",
]

_LATER = MappingProxyType(
    {
        "Sequence": "sequences",
        "VideoFile": "video.writer",
        "check_video": "video.writer",
        "find_sequence": "sequences",
        "frame_file": "sequences",
        "suggest_pattern": "sequences",
    }
)
"""What most renderings do without, and the modules that have it, which are loaded when it is asked for (PEP 562)."""


def __getattr__(name: str) -> Any:
    if name in _LATER:
        return getattr(import_module(f".{_LATER[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
