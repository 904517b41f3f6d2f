"""Rows of large pictures, read alone."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
from halation.nodes import Kind
from msgspec.structs import replace

from ...color.transforms import Array
from ...errors import InputError
from ..info import check_memory, describe_fault, describe_picture, find_layer, open_picture
from ..layers import Layer
from ..pixels import READ_AS, LayerRequest, Pixels, pixels_of, select
from .finite import find_non_finite, has_non_finite

_MORE = 16
"""Rows that are read besides at a time, until what is repaired in the first one that is wanted can be known."""


def read_rows(path: str, want: LayerRequest, first: int, end: int) -> Pixels:
    """Rows `first` to before `end` of what `read` returns, of a file that can be read by rows (`ImageInfo.by_rows`).

    Raises:
        InputError: as `read`.
    """
    with open_picture(path) as handle:
        header = describe_picture(handle, path)
        layer = find_layer(header, want.layer)
        handle.seek_subimage(layer.part, 0)
        spec = handle.spec()
        if not header.by_rows or end > header.size[1]:
            raise InputError(f"{path}: it is not the file any more that it was when the rendering began; render again")
        color = want.kind in (Kind.IMAGE, Kind.COLOR) and not layer.is_data
        # What is no number is made of what is around it, from the top down: where a row has none, it begins anew.
        top, bottom = max(first - 1, 0), min(end + 1, header.size[1])
        block = _decode_rows(handle, spec, layer, path, top, bottom)
        while color and top and block.dtype.kind == "f" and has_non_finite(block[:1]):
            above = max(top - _MORE, 0)
            block = np.concatenate([_decode_rows(handle, spec, layer, path, above, top), block])
            top = above
        made = pixels_of(block, layer, want, spec, header)
        own = slice(first - top, end - top)
        repaired = _count_repaired(block[own], color) if made.repaired else 0
        return replace(made, array=made.array[own], repaired=repaired)


def _decode_rows(handle: oiio.ImageInput, spec: oiio.ImageSpec, layer: Layer, path: str, first: int, end: int) -> Array:
    """The channels of a layer in some rows, in the file's precision."""
    low, high, kind = min(layer.indices), max(layer.indices) + 1, READ_AS.get(layer.format, "float")
    tile = spec.tile_height
    start, stop = (first // tile * tile, min(-(-end // tile) * tile, spec.height)) if tile else (first, end)
    check_memory(path, (spec.width, stop - start), high - low)
    rows = (spec.y + start, spec.y + stop)
    if tile:
        across = (spec.x, spec.x + spec.width)
        block = handle.read_tiles(layer.part, 0, *across, *rows, 0, 1, low, high, kind)
    else:
        block = handle.read_scanlines(layer.part, 0, *rows, 0, low, high, kind)
    if block is None:
        raise InputError(f"{path}: {describe_fault(handle.geterror() or 'corrupt')}")
    array = np.asarray(block)
    array = array.reshape(stop - start, spec.width, high - low)[first - start : end - start]
    return select(array, layer.indices, low)


def _count_repaired(block: Array, color: bool) -> int:
    """How many pixels are repaired: in color those with anything that is not finite, in data with a NaN."""
    return int((find_non_finite(block) if color else np.isnan(block)).any(axis=2).sum())
