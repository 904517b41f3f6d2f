"""Pixels out of files, as the sockets of a graph want them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from halation.nodes import ColorSettings, Kind
from msgspec import Struct, field

from ..color.file_space import AUTO, space_of
from ..color.management import DEFAULT_COLOR, managed
from ..color.transforms import Array, as_float, available_cores, is_working, to_working
from ..errors import InputError
from ..graph.frames import is_video
from ..resources.input_files import check_file
from ..resources.input_files import fingerprint as marked
from .info import ImageInfo, check_memory, describe_fault, describe_picture, describe_video, find_layer, open_picture
from .layers import Layer
from .pictures.color_hints import read_color_hints
from .pictures.finite import find_non_finite, has_non_finite

READ_AS = {"float16": "half", "uint8": "uint8", "uint16": "uint16", "uint32": "uint"}
_ALPHA = ("a", "alpha")
_AS_IT_IS = {(*"rgb", alpha) for alpha in _ALPHA}

# OpenImageIO hears OPENIMAGEIO_THREADS, but not which processors this process may use, and OpenEXR hears neither.
oiio.attribute("threads", min(available_cores(), oiio.get_int_attribute("threads")))
oiio.attribute("exr_threads", oiio.get_int_attribute("threads"))


class LayerRequest(Struct, frozen=True):
    """A layer, and the socket it is for; `width` counts the channels of a Vector.

    `space` is what its color is in, by name or role, "" to find out; `color` says how colors are managed.
    """

    layer: str
    kind: Kind = Kind.IMAGE
    width: int = 4
    space: str = ""
    color: ColorSettings = field(default_factory=ColorSettings)


class Pixels(Struct, frozen=True):
    """A contiguous [height, width, channels] array; row 0 is the top.

    `half` says that 16 bits hold it without loss (the dtype is then float16), `repaired` how many pixels were not
    finite in the file and were replaced.
    """

    array: Array
    half: bool
    repaired: int


def read_layer(
    path: str | Path,
    layer: str,
    kind: Kind,
    width: int = 4,
    frame: int = 1,
    *,
    space: str = "",
    color: ColorSettings = DEFAULT_COLOR,
) -> Pixels:
    """Read one layer over the whole display window; what the file has no data for is 0.

    IMAGE is RGBA in the working space, premultiplied, alpha 1 where the file has none. FIELD is the first channel,
    VECTOR the first `width` ones, missing ones 0: both are the numbers of the file, without any color conversion.
    Non-finite color becomes the mean of its finite neighbors (OpenImageIO, fixNonFinite BOX3); in data a NaN
    becomes 0 and infinity, the background of many depth passes, stays. Of a video it is the frame of that number.

    Raises:
        InputError: the file or the layer is missing, or the file is damaged.
        GraphError, UsageError: `space` is unknown, or there is no config.
    """
    return read_layers(path, [LayerRequest(layer, kind, width, space, color)], frame)[0]


def read_layers(path: str | Path, wants: Sequence[LayerRequest], frame: int = 1) -> list[Pixels]:
    """Read several layers of one file; those that lie in one part are decoded together.

    Raises:
        InputError: as `read`.
    """
    if is_video(str(path)):
        return _read_video(str(check_file(path)), wants, frame)
    with open_picture(path) as handle:
        header = describe_picture(handle, str(path))
        layers = [find_layer(header, want.layer) for want in wants]
        blocks = _decode(handle, header, layers)
        made: list[Pixels] = []
        for want, layer, block in zip(wants, layers, blocks, strict=True):
            handle.seek_subimage(layer.part, 0)
            made.append(pixels_of(block, layer, want, handle.spec(), header))
        return made


def _read_video(path: str, wants: Sequence[LayerRequest], frame: int) -> list[Pixels]:
    """What sockets want of one frame of a video."""
    mark = marked(path)
    from .video import facts_of, signal_at

    header = describe_video(facts_of(path, mark))
    signal = signal_at(path, mark, frame)
    made: list[Pixels] = []
    for want in wants:
        layer = find_layer(header, want.layer)
        color = want.kind in (Kind.IMAGE, Kind.COLOR) and not layer.is_data
        as_it_is = not color or want.space not in AUTO
        block, encoding = (signal.numbers, "") if as_it_is else signal.light
        spec = oiio.ImageSpec(block.shape[1], block.shape[0], block.shape[2], "float")
        spec.attribute("oiio:ColorSpace", encoding)
        spec.attribute("oiio:UnassociatedAlpha", 1)
        made.append(pixels_of(select(block, layer.indices, 0), layer, want, spec, header))
    return made


def _decode(handle: oiio.ImageInput, header: ImageInfo, layers: Sequence[Layer]) -> list[Array]:
    """The channels of every layer over the data window, in the file's precision."""
    spans: dict[tuple[int, str], list[int]] = {}
    for layer in layers:
        spans.setdefault((layer.part, layer.format), []).extend(layer.indices)
    decoded: dict[tuple[int, str], Array] = {}
    for (part, dtype), indices in spans.items():
        check_memory(header.path, header.size, max(indices) + 1 - min(indices))
        try:
            block = handle.read_image(part, 0, min(indices), max(indices) + 1, READ_AS.get(dtype, "float"))
        except (MemoryError, ValueError) as error:
            width, height = header.size
            raise InputError(f"{header.path}: {width}x{height} pixels do not fit into memory") from error
        if block is None:
            raise InputError(f"{header.path}: {describe_fault(handle.geterror() or 'corrupt')}")
        decoded[part, dtype] = np.asarray(block)
    keys = [(layer.part, layer.format) for layer in layers]
    return [select(decoded[key], layer.indices, min(spans[key])) for key, layer in zip(keys, layers, strict=True)]


def select(block: Array, indices: Sequence[int], first: int) -> Array:
    """Channels at these places in a part, of a block that begins with the one at `first`."""
    wanted = [index - first for index in indices]
    run = list(range(wanted[0], wanted[0] + len(wanted)))
    return block[..., run[0] : run[-1] + 1] if wanted == run else block[..., wanted]


def pixels_of(block: Array, layer: Layer, want: LayerRequest, spec: oiio.ImageSpec, header: ImageInfo) -> Pixels:
    """The array that a socket wants, from the channels of its layer."""
    if want.kind in (Kind.IMAGE, Kind.COLOR):
        array = _data_image(block, layer) if layer.is_data else _image(block, layer, spec, header, want)
    else:
        width = want.width if want.kind is Kind.VECTOR else 1
        array = as_float(block[..., :width])
        if (missing := width - array.shape[2]) > 0:
            array = np.concatenate([array, np.zeros((*array.shape[:2], missing), array.dtype)], axis=2)
    color = want.kind in (Kind.IMAGE, Kind.COLOR) and not layer.is_data
    array = np.ascontiguousarray(array)
    array, repaired = _repaired_color(array) if color else _repaired_data(array)
    array = np.ascontiguousarray(_upright(_placed(array, spec), spec.get_int_attribute("Orientation", 1)))
    return Pixels(array, array.dtype == np.float16, repaired)


def _data_image(block: Array, layer: Layer) -> Array:
    """Data shown as a picture: one channel gray, else the first three as they are, opaque unless there is an alpha."""
    rgb, alpha = _parts(block, layer)
    return _rgba(as_float(rgb), None if alpha is None else as_float(alpha))


def _image(block: Array, layer: Layer, spec: oiio.ImageSpec, header: ImageInfo, want: LayerRequest) -> Array:
    """Premultiplied RGBA in the working space."""
    manager = managed(want.color)
    found = space_of(header.path, read_color_hints(spec, header.format, block.dtype.kind in "ui"), manager, want.space)
    straight = spec.get_int_attribute("oiio:UnassociatedAlpha") == 1
    if is_working(found, manager) and not straight and tuple(map(str.casefold, layer.channels)) in _AS_IT_IS:
        return as_float(block)
    rgb, alpha = _parts(block, layer)
    if alpha is not None:
        alpha = as_float(alpha)
    if is_working(found, manager):
        rgb = as_float(rgb)
    elif alpha is None or straight:
        rgb = to_working(rgb, found, manager)
    else:  # premultiplied after encoding: the encoded color must come out first
        rgb = np.divide(as_float(rgb), alpha, out=np.zeros(rgb.shape, np.float32), where=alpha > 0.0)
        rgb = to_working(rgb, found, manager) * alpha
    if alpha is not None and straight:
        rgb = rgb * alpha
    return _rgba(rgb, alpha)


def _parts(block: Array, layer: Layer) -> tuple[Array, Array | None]:
    """Three channels of color, and alpha if there is one."""
    names = [name.casefold() for name in layer.channels]
    place = next((index for index, name in enumerate(names) if name in _ALPHA and len(names) > 1), None)
    others = [index for index in range(len(names)) if index != place]
    if len(others) == 1:
        rgb = block[..., others * 3]
    elif len(others) == 2:
        rgb = np.concatenate([block[..., others], np.zeros_like(block[..., :1])], axis=2)
    else:
        rgb = block[..., :3] if others[:3] == [0, 1, 2] else block[..., others[:3]]
    return rgb, None if place is None else block[..., place : place + 1]


def _rgba(rgb: Array, alpha: Array | None) -> Array:
    made = np.ones((*rgb.shape[:2], 4), rgb.dtype)
    made[..., :3] = rgb
    if alpha is not None:
        made[..., 3:] = alpha
    return made


def _repaired_color(array: Array) -> tuple[Array, int]:
    bad = int(find_non_finite(array).any(axis=2).sum()) if has_non_finite(array) else 0
    if not bad:
        return array, 0
    buffer = oiio.ImageBuf(array)
    # one thread: a repaired neighbor counts as finite, so the order decides the result
    fixed = oiio.ImageBufAlgo.fixNonFinite(buffer, oiio.NONFINITE_BOX3, nthreads=1)
    return np.asarray(fixed.get_pixels("half" if array.dtype == np.float16 else "float")), bad


def _repaired_data(array: Array) -> tuple[Array, int]:
    if not has_non_finite(array):
        return array, 0
    nan = np.isnan(array)
    return np.where(nan, array.dtype.type(0.0), array), int(nan.any(axis=2).sum())


def _placed(array: Array, spec: oiio.ImageSpec) -> Array:
    """The data window inside the display window; what lies outside of it is cut off."""
    width, height = spec.full_width or spec.width, spec.full_height or spec.height
    left, top = spec.x - spec.full_x, spec.y - spec.full_y
    if (left, top, spec.width, spec.height) == (0, 0, width, height):
        return array
    placed = np.zeros((height, width, array.shape[2]), array.dtype)
    rows = slice(max(top, 0), min(top + spec.height, height))
    columns = slice(max(left, 0), min(left + spec.width, width))
    if rows.start < rows.stop and columns.start < columns.stop:
        placed[rows, columns] = array[rows.start - top : rows.stop - top, columns.start - left : columns.stop - left]
    return placed


def _upright(array: Array, orientation: int) -> Array:
    """Undo the rotation that a camera noted (TIFF 6.0, tag 274)."""
    if orientation > 4:
        array = array.transpose(1, 0, 2)
    rows = -1 if orientation in (3, 4, 7, 8) else 1
    columns = -1 if orientation in (2, 3, 6, 7) else 1
    return array[::rows, ::columns]
