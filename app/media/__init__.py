"""Files and arrays: pictures, sequences, videos and meshes on the disk, numpy arrays in memory.

A path becomes an array in five steps, each a function with its own module:

    path -> sequences.find_frame_file   which file shows a frame
         -> info.read_info              the header: size and layers (`channels` sorts channels into layers)
         -> layers.find_layer           the layer that a user names
         -> pictures.reader, video.reader    the numbers of that layer, decoded
         -> convert.convert_layer       what a socket takes: color in the working space, repaired, upright

`pixels.read_layer` does all of it for one file. Arrays become files by `pictures.writer.write_picture`,
`pictures.row_writer` (a picture that no memory holds) and `video.writer`. `meshes` are triangles of 3D scenes,
`comparison` measures and shows how pictures differ, `header` and `metadata` are all else that a file says.
"""

from __future__ import annotations

from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .convert import LayerRequest, Pixels
    from .info import read_info
    from .layers import ImageInfo, Layer, find_layer
    from .metadata import TypedAttribute, read_metadata, set_pixel_aspect
    from .pictures.writer import (
        PICTURE_ENDINGS,
        check_destination,
        cut_to_frame,
        holds_light,
        stores_halves,
        write_picture,
    )
    from .pixels import read_layer, read_layers
    from .sequences import FrameSequence, find_frame_file, find_sequence, suggest_pattern
    from .video.writer import VideoWriter, check_video

__all__ = [
    "PICTURE_ENDINGS",
    "FrameSequence",
    "ImageInfo",
    "Layer",
    "LayerRequest",
    "Pixels",
    "TypedAttribute",
    "VideoWriter",
    "check_destination",
    "check_video",
    "cut_to_frame",
    "find_frame_file",
    "find_layer",
    "find_sequence",
    "holds_light",
    "read_info",
    "read_layer",
    "read_layers",
    "read_metadata",
    "set_pixel_aspect",
    "stores_halves",
    "suggest_pattern",
    "write_picture",
]

_HOMES = MappingProxyType(
    {
        "FrameSequence": "sequences",
        "ImageInfo": "layers",
        "PICTURE_ENDINGS": "pictures.writer",
        "Layer": "layers",
        "LayerRequest": "convert",
        "Pixels": "convert",
        "TypedAttribute": "metadata",
        "VideoWriter": "video.writer",
        "check_destination": "pictures.writer",
        "check_video": "video.writer",
        "find_frame_file": "sequences",
        "find_layer": "layers",
        "find_sequence": "sequences",
        "holds_light": "pictures.writer",
        "read_info": "info",
        "read_layer": "pixels",
        "read_layers": "pixels",
        "read_metadata": "metadata",
        "set_pixel_aspect": "metadata",
        "stores_halves": "pictures.writer",
        "suggest_pattern": "sequences",
        "cut_to_frame": "pictures.writer",
        "write_picture": "pictures.writer",
    }
)
"""The module of each name, which is loaded on first use (PEP 562). Who only reads headers needs no arrays, and who only
looks for files needs no library at all."""


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f".{_HOMES[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
