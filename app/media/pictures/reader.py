"""Reads layers of picture files."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import OpenImageIO as oiio

from ...color.transforms import Array
from ...errors import InputError
from ...resources.large_arrays import create_array
from ...resources.sandbox import Sandbox
from ..convert import LayerRequest, Pixels, convert_layer, select_channels
from ..layers import ImageInfo, Layer, find_layer
from ..limits import check_memory
from .open import describe_fault, describe_picture, open_picture
from .wide_integers import scale_to_unit

_BLOCK_ROWS = 32
"""Rows of an EXR that each thread decodes at a time: the largest block of scan lines but that of DWAB (OpenEXR file
layout). Larger bands are not faster, and the allocator keeps them: T5 at 2560x1440 takes 301 MiB with 128 rows for each
thread, and 290 with these."""

_DWAB_ROWS = 256
"""The same of DWAB, whose block is larger: two threads take 0.7 of the time of one."""

_DECODED_AS = {"float16": "half", "uint8": "uint8", "uint16": "uint16", "uint32": "uint"}


def choose_decoding(layer: Layer) -> str:
    """The format to which OpenImageIO decodes a layer: its own, or 32-bit floats, in which integers fill 0..1."""
    return _DECODED_AS.get(layer.format, "float")


def scale_integers(block: Array, info: ImageInfo, spec: oiio.ImageSpec) -> Array:
    """Decoded numbers with 32-bit integers as 0..1, except in an EXR, where they are ids and counts."""
    return scale_to_unit(block, spec) if block.dtype == np.uint32 and info.format != "openexr" else block


def read_picture_layers(path: str, requests: Sequence[LayerRequest], sandbox: Sandbox) -> list[Pixels]:
    """Read layers of one file. Raises InputError."""
    with open_picture(path, sandbox=sandbox) as picture:
        info = describe_picture(picture, path, sandbox=sandbox)
        layers = [find_layer(info, request.layer) for request in requests]
        results: list[Pixels] = []
        for request, layer, block in zip(requests, layers, decode_layers(picture, info, layers), strict=True):
            picture.seek_subimage(layer.part, 0)
            results.append(convert_layer(block, layer, request, picture.spec(), info))
        return results


def decode_layers(picture: oiio.ImageInput, info: ImageInfo, layers: Sequence[Layer]) -> list[Array]:
    """The channels of every layer over the data window, in the file's precision.

    Layers of one part and precision are decoded in one go, with whatever lies between them: an EXR is compressed by
    rows of all channels, so a second reading would decompress all of it again.
    """
    spans: dict[tuple[int, str], list[int]] = {}
    keys = [(layer.part, choose_decoding(layer)) for layer in layers]
    for key, layer in zip(keys, layers, strict=True):
        spans.setdefault(key, []).extend(layer.indices)
    blocks: dict[tuple[int, str], Array] = {}
    for (part, format), indices in spans.items():
        check_memory(info.path, info.size, max(indices) + 1 - min(indices))
        try:
            block = _read_block(picture, info, part, min(indices), max(indices) + 1, format)
        except (MemoryError, ValueError) as error:
            width, height = info.size
            raise InputError(f"{info.path}: {width}x{height} pixels do not fit into memory") from error
        if block is None:
            raise InputError(f"{info.path}: {describe_fault(picture.geterror() or 'corrupt')}")
        picture.seek_subimage(part, 0)
        blocks[part, format] = scale_integers(block, info, picture.spec())
    return [
        select_channels(blocks[key], layer.indices, min(spans[key])) for key, layer in zip(keys, layers, strict=True)
    ]


def _read_block(
    picture: oiio.ImageInput, info: ImageInfo, part: int, first: int, end: int, format: str
) -> Array | None:
    """Channels `first` to before `end` of a part; None if they cannot be decoded.

    An EXR is decoded in bands of rows: OpenImageIO copies each array that it returns, and of a whole picture there
    would be two at a time.
    """
    picture.seek_subimage(part, 0)
    spec = picture.spec()
    is_dwab = spec.get_string_attribute("compression").startswith("dwab")
    height = (_DWAB_ROWS if is_dwab else _BLOCK_ROWS) * max(1, oiio.get_int_attribute("threads"))
    if info.format != "openexr" or spec.tile_width or spec.height <= height:
        block = picture.read_image(part, 0, first, end, format)
        return None if block is None else np.asarray(block)
    whole: Array | None = None
    for row in range(0, spec.height, height):
        rows = slice(row, min(row + height, spec.height))
        band = picture.read_scanlines(part, 0, spec.y + rows.start, spec.y + rows.stop, 0, first, end, format)
        if band is None:
            return None
        if whole is None:
            whole = create_array((spec.height, spec.width, end - first), band.dtype)
        whole[rows] = band.reshape(whole[rows].shape)
        del band  # before there is another
    return whole
