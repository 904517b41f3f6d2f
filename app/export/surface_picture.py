"""A small picture of what a pass has made, for people who look at passes one by one."""

from __future__ import annotations

import numpy as np
from msgspec import Struct

from ..compiler import Surface
from ..media.comparison.data_range import find_data_range
from ..media.pictures.stored import Array, StoredPart, encode_for_viewing
from ..media.pictures.thumbnail import shrink_to_fit


class SurfacePicture(Struct, frozen=True, eq=False):
    """The pixels of a surface as codes for a screen, [height, width, 3] of uint8."""

    codes: Array
    span: tuple[float, float] | None
    """For data: the numbers that are shown black and white."""


def picture_surface(array: Array, surface: Surface, view: str, width: int) -> SurfacePicture:
    """The pixels of a surface, at most `width` across: light through a view, data over its range.

    `array` is [height, width, channels].
    """
    if not surface.is_data and surface.channels == 4:
        small = shrink_to_fit(array, width, width)
        return SurfacePicture(encode_for_viewing(StoredPart(small, ("R", "G", "B", "A"), False), view), None)
    step = max(1, -(-array.shape[1] // width))
    small = np.ascontiguousarray(array[::step, ::step], np.float32)  # a mean of data lies on no surface
    span = find_data_range(small)
    return SurfacePicture(encode_for_viewing(StoredPart(small, ("data",), False), "", span), span)
