"""Converts the channels of a file to the array of a socket: color, missing channels, repair, placement.

Pictures, rows of pictures and frames of videos all go through `convert_layer`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import OpenImageIO as oiio
from halation.nodes import Kind
from msgspec import Struct, field

from ..color.file_space import FileSpace, find_file_space
from ..color.management import ColorManager, get_default_color_manager
from ..color.transforms import (
    Array,
    convert_premultiplied,
    copy_rgb,
    is_in_working_space,
    is_linear,
    to_float,
    to_working,
)
from ..resources.picture import PixelRectangle
from .layers import ImageInfo, Layer
from .pictures.color_hints import has_straight_alpha, read_color_hints
from .pictures.finite import fill_non_finite, find_non_finite, has_non_finite
from .pictures.open import find_data_window, read_orientation

_LARGEST_COUNT = 2**32 - 1
"""The white of 32-bit integers: the largest one."""

_ALPHA_NAMES = ("a", "alpha")
_RGBA_LAYOUTS = {(*"rgb", alpha) for alpha in _ALPHA_NAMES}


class LayerRequest(Struct, frozen=True):
    """A layer, and the socket that reads it; `width` counts the channels of a Vector.

    `space` is the color space of the layer, by name or role, "" to recognize it; `manager` is the color manager.
    """

    layer: str
    kind: Kind = Kind.IMAGE
    width: int = 4
    space: str = ""
    manager: ColorManager = field(default_factory=get_default_color_manager)
    overscan: bool = False
    """Whether pixels around the display window are wanted as well, as far as `ImageInfo.overscan` says."""

    @property
    def wants_color(self) -> bool:
        """True for sockets of color, even if the layer is data."""
        return self.kind.is_color


class Pixels(Struct, frozen=True):
    """A contiguous [height, width, channels] array; row 0 is the top.

    `half` says that 16 bits hold it without loss (the dtype is then float16), `repaired` how many pixels were not
    finite in the file and were replaced, `warning` the rest of a sentence about what of the header could not be used.
    """

    array: Array
    half: bool
    repaired: int
    warning: str = ""


def convert_layer(block: Array, layer: Layer, request: LayerRequest, spec: oiio.ImageSpec, info: ImageInfo) -> Pixels:
    """The array for a socket, from the channels of a layer over the data window that `spec` describes.

    The order matters: NaN and infinity are repaired among the pixels of the file, before the window that is wanted
    surrounds them with zeros.
    """
    is_color, warning = request.wants_color and not layer.is_data, ""
    if is_color:
        array, space = _to_light(block, layer, request, spec, info)
        warning = space.warning
    elif request.wants_color:
        rgb, alpha = _split_alpha(block, layer)
        array = _join_rgba(to_float(rgb), None if alpha is None else to_float(alpha))
    else:
        width = request.width if request.kind is Kind.VECTOR else 1
        array = _fit_width(to_float(block[..., :width]), width)
    array, repaired = _repair(np.ascontiguousarray(array), is_color)
    width, height = spec.full_width or spec.width, spec.full_height or spec.height
    window = info.overscan if request.overscan and info.overscan else (0, 0, width, height)
    array = _place_in_window(array, find_data_window(spec), window)
    array = np.ascontiguousarray(_turn_upright(array, read_orientation(spec)))
    return Pixels(array, array.dtype == np.float16, repaired, warning)


def select_channels(block: Array, indices: Sequence[int], first: int) -> Array:
    """Channels at these indices in a part, of a block that begins with the channel `first`."""
    places = [index - first for index in indices]
    if places == list(range(places[0], places[0] + len(places))):
        return block[..., places[0] : places[-1] + 1]
    return block[..., places]


def _to_light(
    block: Array, layer: Layer, request: LayerRequest, spec: oiio.ImageSpec, info: ImageInfo
) -> tuple[Array, FileSpace]:
    """Premultiplied RGBA in the working space, and the space of the file.

    A file stores color either straight, or multiplied by alpha after encoding. Encoding is not linear, so in the second
    case color is divided by alpha before it is decoded; in both cases the linear color is multiplied by alpha at the
    end. If a matrix is the whole conversion, the order does not matter, and nothing is divided.
    """
    manager = request.manager
    hints = read_color_hints(spec, info.format, layer.format)
    space = find_file_space(info.path, hints, manager, request.space)
    is_straight = has_straight_alpha(spec, info.format)
    keeps_numbers = is_in_working_space(space, manager)
    if block.dtype == np.uint32:
        block = (block / np.float64(_LARGEST_COUNT)).astype(np.float32)
    if keeps_numbers and not is_straight and tuple(map(str.casefold, layer.channels)) in _RGBA_LAYOUTS:
        return to_float(block), space
    rgb, alpha = _split_alpha(block, layer)
    if alpha is not None:
        alpha = to_float(alpha)
        if info.format == "bmp" and not alpha.any():  # a fourth byte that only pads a word
            alpha = np.ones_like(alpha)
    if keeps_numbers:
        rgb = to_float(rgb)
    elif alpha is None or is_straight or is_linear(space, manager):
        rgb = to_working(rgb, space, manager)
    else:
        rgb = to_float(rgb)
        is_empty = (alpha == 0.0) & (rgb == 0.0).all(axis=2, keepdims=True)  # some curves give light for the code 0
        rgb = convert_premultiplied(rgb, alpha, lambda straight: to_working(straight, space, manager))
        rgb = np.where(is_empty, np.float32(0.0), rgb)
    if alpha is not None and is_straight:
        rgb = rgb * alpha
    return _join_rgba(rgb, alpha), space


def _split_alpha(block: Array, layer: Layer) -> tuple[Array, Array | None]:
    """Three channels of color (one channel is gray, two are red and green), and alpha if there is one."""
    names = [name.casefold() for name in layer.channels]
    place = next((index for index, name in enumerate(names) if name in _ALPHA_NAMES and len(names) > 1), None)
    colors = [index for index in range(len(names)) if index != place]
    if len(colors) == 1:
        rgb = block[..., colors * 3]
    elif len(colors) == 2:
        rgb = np.concatenate([block[..., colors], np.zeros_like(block[..., :1])], axis=2)
    else:
        rgb = block[..., :3] if colors[:3] == [0, 1, 2] else block[..., colors[:3]]
    return rgb, None if place is None else block[..., place : place + 1]


def _join_rgba(rgb: Array, alpha: Array | None) -> Array:
    """Color and alpha in one array, opaque without alpha."""
    rgba = np.empty((*rgb.shape[:2], 4), rgb.dtype)
    copy_rgb(rgb, rgba)
    rgba[..., 3:] = rgb.dtype.type(1) if alpha is None else alpha
    return rgba


def _fit_width(array: Array, width: int) -> Array:
    """The channels, with zeros for missing ones."""
    missing = width - array.shape[2]
    if missing <= 0:
        return array
    return np.concatenate([array, np.zeros((*array.shape[:2], missing), array.dtype)], axis=2)


def _repair(array: Array, is_color: bool) -> tuple[Array, int]:
    """The array without NaN and infinity, and the number of repaired pixels.

    Color gets the mean of its finite neighbors. In data, NaN becomes 0, and infinity stays: many depth passes use it
    for the background.
    """
    if not has_non_finite(array):
        return array, 0
    if is_color:
        return fill_non_finite(array), int(find_non_finite(array).any(axis=2).sum())
    nan = np.isnan(array)
    return np.where(nan, array.dtype.type(0.0), array), int(nan.any(axis=2).sum())


def _place_in_window(array: Array, data_window: PixelRectangle, window: PixelRectangle) -> Array:
    """The data window placed in another rectangle; what lies outside is cut off."""
    if data_window == window:
        return array
    (x, y, width, height), (left, top, wide, high) = data_window, window
    x, y = x - left, y - top
    placed = np.zeros((high, wide, array.shape[2]), array.dtype)
    rows = slice(max(y, 0), min(y + height, high))
    columns = slice(max(x, 0), min(x + width, wide))
    if rows.start < rows.stop and columns.start < columns.stop:
        placed[rows, columns] = array[rows.start - y : rows.stop - y, columns.start - x : columns.stop - x]
    return placed


def _turn_upright(array: Array, orientation: int) -> Array:
    """Undo the rotation that a camera noted (TIFF 6.0, tag 274)."""
    if orientation > 4:
        array = array.transpose(1, 0, 2)
    rows = -1 if orientation in (3, 4, 7, 8) else 1
    columns = -1 if orientation in (2, 3, 6, 7) else 1
    return array[::rows, ::columns]
