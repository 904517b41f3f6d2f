"""Reads single rows of large pictures."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
from msgspec.structs import replace

from ...color.transforms import Array
from ...errors import InputError
from ...resources.sandbox import Sandbox
from ..convert import LayerRequest, Pixels, convert_layer, select_channels
from ..layers import ImageInfo, Layer, find_layer
from ..limits import check_memory
from .finite import find_non_finite, has_non_finite
from .open import describe_fault, describe_picture, open_picture
from .reader import choose_decoding, scale_integers

_MORE_ROWS = 16
"""Rows that are read at a time above and below, until the repair of a pixel is known. Such rows are rare, and 16 is the
block of scan lines in EXR files with ZIP compression (OpenEXR file layout): fewer would decode the same block again."""


def read_rows(path: str, request: LayerRequest, first: int, end: int, sandbox: Sandbox) -> Pixels:
    """Rows `first` to before `end` of what `read_layer` returns, of a file that can be read by rows (`by_rows`).

    A pixel that is not finite is repaired from its neighbors, and a repaired pixel counts as a finite neighbor. So the
    repair of a row depends on the rows around it if these need repairs too: rows above and below are added up to one
    without repairs.

    Raises:
        InputError: as `read_layer`.
    """
    with open_picture(path, sandbox=sandbox) as picture:
        info = describe_picture(picture, path, sandbox=sandbox)
        layer = find_layer(info, request.layer)
        picture.seek_subimage(layer.part, 0)
        spec = picture.spec()
        if not info.by_rows or end > info.size[1]:
            raise InputError(f"{path}: the file has changed since the rendering began: render again")
        is_color = request.wants_color and not layer.is_data
        top, bottom = max(first - 1, 0), min(end + 1, info.size[1])
        block = _decode_rows(picture, spec, layer, info, top, bottom)
        while is_color and top and block.dtype.kind == "f" and has_non_finite(block[:1]):
            above = max(top - _MORE_ROWS, 0)
            block = np.concatenate([_decode_rows(picture, spec, layer, info, above, top), block])
            top = above
        while is_color and bottom < info.size[1] and block.dtype.kind == "f" and has_non_finite(block[-1:]):
            below = min(bottom + _MORE_ROWS, info.size[1])
            block = np.concatenate([block, _decode_rows(picture, spec, layer, info, bottom, below)])
            bottom = below
        pixels = convert_layer(block, layer, request, spec, info)
        rows = slice(first - top, end - top)
        repaired = _count_repaired(block[rows], is_color) if pixels.repaired else 0
        return replace(pixels, array=pixels.array[rows], repaired=repaired)


def _decode_rows(
    picture: oiio.ImageInput, spec: oiio.ImageSpec, layer: Layer, info: ImageInfo, first: int, end: int
) -> Array:
    """The channels of a layer in some rows, in the file's precision."""
    low, high, format = min(layer.indices), max(layer.indices) + 1, choose_decoding(layer)
    tile = spec.tile_height
    start, stop = (first // tile * tile, min(-(-end // tile) * tile, spec.height)) if tile else (first, end)
    check_memory(info.path, (spec.width, stop - start), high - low)
    rows = (spec.y + start, spec.y + stop)
    if tile:
        columns = (spec.x, spec.x + spec.width)
        block = picture.read_tiles(layer.part, 0, *columns, *rows, 0, 1, low, high, format)
    else:
        block = picture.read_scanlines(layer.part, 0, *rows, 0, low, high, format)
    if block is None:
        raise InputError(f"{info.path}: {describe_fault(picture.geterror() or 'corrupt')}")
    array = scale_integers(np.asarray(block), info, spec).reshape(stop - start, spec.width, high - low)[
        first - start : end - start
    ]
    return select_channels(array, layer.indices, low)


def _count_repaired(block: Array, is_color: bool) -> int:
    """How many pixels are repaired: in color those with NaN or infinity, in data those with NaN."""
    return int((find_non_finite(block) if is_color else np.isnan(block)).any(axis=2).sum())
