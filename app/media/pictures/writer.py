"""Writes pictures to files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import OpenImageIO as oiio
from halation.nodes import Kind, Size
from msgspec import Struct

from ...color.encoding import SRGB, Encoding, choose_png_space
from ...color.transforms import Array
from ...errors import OutputError, UsageError
from ...resources.atomic_write import check_writable, write_atomically
from ...resources.machine import has_memory_limit
from ...resources.picture import PixelRectangle
from ...resources.render_choices import Precision
from ...resources.sandbox import Sandbox
from ...resources.suggestions import find_near_names
from ..channels import is_depth
from ..metadata import add_metadata
from .finite import to_half
from .open import COLOR_TAG

_FORMATS = {
    ".exr": "openexr",
    ".png": "png",
    ".jpg": "jpeg",
    ".jpeg": "jpeg",
    ".tif": "tiff",
    ".tiff": "tiff",
    ".webp": "webp",
    ".hdr": "hdr",
    ".dpx": "dpx",
}
PICTURE_ENDINGS = tuple(_FORMATS)
"""The endings of pictures that can be written."""

_LIGHT_FORMATS = ("openexr", "hdr")
_EXR_LOSSY = ("pxr24", "b44", "b44a", "dwaa", "dwab")
_COMPRESSIONS = {
    "openexr": ("none", "rle", "zips", "zip", "piz", *_EXR_LOSSY),
    "tiff": ("none", "lzw", "zip", "packbits"),
}
_PNG_LEVEL = 4
"""Of zlib's 1 to 9. Against its own choice, 6, photographs and screens take 0.3 to 0.75 of the processor time and are 3
to 8 % larger, measured at 1632x1224, dithered. Level 5 takes 0.5 to 0.85, and they are 1 to 4 % larger."""

_PNG_FILTERS = 16 | 32
"""Sub and Up of PNG, by libpng's numbers: what each row is tried with. Against all five, pictures take 0.53 to 0.87 of
the time of a processor and are 0 to 2 % larger, screens up to 5 %: measured with 15 pictures of 0.1 to 2 MP."""

_STORED = {"uint8": "uint8", "uint16": "uint16", "float32": "float"}


class EncodedPart(Struct, frozen=True):
    """A part of a file to write."""

    spec: oiio.ImageSpec
    array: Array


def write_picture(
    path: str | Path,
    layers: Mapping[str, Array],
    *,
    kinds: Mapping[str, Kind],
    precision: Precision = "half",
    compression: str = "zip",
    view: str = "",
    metadata: Mapping[str, Any] | None = None,
    encoding: Encoding | None = None,
    frame: int = 1,
    frames: Mapping[str, PixelRectangle] | None = None,
    sandbox: Sandbox,
) -> None:
    """Write [h, w, c] or [h, w] arrays; the ending of the name decides the format.

    EXR: linear; one layer has plain channels (RGBA; Z or Y; XYZW), several become parts whose channels are
    `name.R` and so on, "" staying plain. Color is stored in `precision` (beyond the range of half: clamped),
    data always as float and never with a lossy `compression`. HDR: linear RGB of the first Image.
    PNG, JPEG, TIFF, WebP, DPX: the first Image seen through `view` at 8 bits (DPX 10), 16 in PNG, TIFF and DPX with
    `precision="float"`, alpha straight and only where something is transparent; JPEG and DPX show it over black.
    Without an Image, the first Field as gray: its number times the largest integer. An `encoding` says more than a
    view: see there.
    Where the encoding dithers, `frame` chooses the pattern.
    `frames` says where the frame (the display window) lies in arrays that have more pixels than it: EXR keeps them all,
    other formats hold the frame.
    `metadata` is kept as far as the format can: all of it in EXR, text in PNG.

    Raises:
        UsageError: unknown ending, compression, view or color space, or layers that such a file cannot hold.
        OutputError: the file could not be written; an older one is still there.
    """
    layers = {name: array if array.ndim == 3 else array[..., None] for name, array in layers.items()}
    encoding, metadata, frames = encoding or Encoding(view), metadata or {}, frames or {}
    sizes = {name: frames[name][2:] if name in frames else array.shape[1::-1] for name, array in layers.items()}
    format = _check_layers(path, {name: kinds[name] for name in layers}, sizes, compression, encoding)
    if format == "openexr":
        parts = encode_exr_parts(layers, kinds, precision, compression, encoding, frames)
    else:
        layer_name = choose_shown_layer(path, {name: kinds[name] for name in layers})
        is_data, array = not kinds[layer_name].is_color, layers[layer_name]
        array = cut_to_frame(array, frames.get(layer_name))
        parts = [_encode_picture(array, is_data, frame, format, precision, compression, encoding)]
    for part in parts:
        add_metadata(part.spec, metadata if part is parts[0] else {}, format)
    room = sum(part.array.nbytes for part in parts) + sum(len(str(value)) for value in metadata.values())
    write_atomically(path, _make_encoder(path, format, parts), room, sandbox=sandbox)


def cut_to_frame(array: Array, frame: PixelRectangle | None) -> Array:
    """The frame of a picture of which more pixels are given; None for all of them."""
    if frame is None:
        return array
    x, y, width, height = frame
    return array[y : y + height, x : x + width]


def _set_windows(spec: oiio.ImageSpec, frame: PixelRectangle) -> None:
    """Make the frame the display window, which begins at 0, and all pixels the data window."""
    x, y, width, height = frame
    spec.x, spec.y = -x, -y
    spec.full_x, spec.full_y, spec.full_width, spec.full_height = 0, 0, width, height


def holds_light(path: str | Path) -> bool:
    """True for a format that stores light as it is. All others, videos too, show color through a view."""
    return _FORMATS.get(Path(path).suffix.casefold()) in _LIGHT_FORMATS


def stores_halves(path: str | Path, kind: Kind, *, precision: Precision, encoding: Encoding) -> bool:
    """True if `write` stores the numbers of a layer unchanged, except for rounding to half floats."""
    return _is_stored_as_half(kind, precision) and not encoding.space and Path(path).suffix.casefold() == ".exr"


def check_destination(
    path: str | Path,
    kinds: Mapping[str, Kind],
    sizes: Mapping[str, Size],
    *,
    compression: str = "zip",
    view: str = "",
    encoding: Encoding | None = None,
    sandbox: Sandbox,
) -> None:
    """Raise the errors of `write` before anything is rendered, except for a full disk."""
    _check_layers(path, kinds, sizes, compression, encoding or Encoding(view))
    check_writable(path, sandbox=sandbox)


def _check_layers(
    path: str | Path, kinds: Mapping[str, Kind], sizes: Mapping[str, Size], compression: str, encoding: Encoding
) -> str:
    """The format, if the file can hold layers of these kinds and sizes. Raises UsageError."""
    format = _choose_format(Path(path))
    if not kinds:
        raise UsageError(f"{path}: there is nothing to write: the graph has no outputs")
    encoding.check_names()
    choices = _COMPRESSIONS.get(format, (compression,))
    if compression not in choices:
        close_names = find_near_names(compression.casefold(), choices)
        hint = f"did you mean '{close_names[0]}'? Choose" if close_names else "choose"
        raise UsageError(f"{path}: there is no compression '{compression}': {hint} from {', '.join(choices)}")
    if format != "openexr":
        choose_shown_layer(path, kinds)
    elif len(set(sizes.values())) > 1:
        sizes_text = ", ".join(f"'{name}' {width}x{height}" for name, (width, height) in sizes.items())
        raise UsageError(
            f"{path}: one EXR holds layers of one size, but there are {sizes_text}: write them to several files"
        )
    return format


def _choose_format(path: Path) -> str:
    ending = path.suffix.casefold()
    if ending in _FORMATS:
        return _FORMATS[ending]
    reason = f"cannot write '{ending}' files" if ending else "its name has no ending that says what to write"
    raise UsageError(f"{path}: {reason}: use one of {', '.join(_FORMATS)}")


def encode_exr_parts(
    layers: Mapping[str, Array],
    kinds: Mapping[str, Kind],
    precision: Precision,
    compression: str,
    encoding: Encoding,
    frames: Mapping[str, PixelRectangle] = MappingProxyType({}),
) -> list[EncodedPart]:
    """The parts of an EXR that holds these layers, and their numbers."""
    parts: list[EncodedPart] = []
    for name, array in layers.items():
        color = kinds[name].is_color
        half = _is_stored_as_half(kinds[name], precision)
        height, width, count = array.shape
        spec = oiio.ImageSpec(width, height, count, "half" if half else "float")
        prefix = f"{name}." if name and len(layers) > 1 else ""
        spec.channelnames = tuple(prefix + letter for letter in _channel_names(name, kinds[name], count))
        spec.alpha_channel = 3 if color and count == 4 else -1
        spec.attribute("compression", "zip" if compression in _EXR_LOSSY and not color else compression)
        _tag_color(spec, encoding, color)
        if len(layers) > 1:
            spec.attribute("oiio:subimagename", name or "rgba")
        if color:
            array = encoding.to_numbers(array)
        if half:
            array = to_half(array)
        if name in frames:
            _set_windows(spec, frames[name])
        parts.append(EncodedPart(spec, np.ascontiguousarray(array)))
    return parts


def _is_stored_as_half(kind: Kind, precision: Precision) -> bool:
    return precision == "half" and kind.is_color


def _tag_color(spec: oiio.ImageSpec, encoding: Encoding, color: bool) -> None:
    """Describe the numbers in an EXR header.

    OpenImageIO translates "oiio:ColorSpace" into colorInteropID by a config, which it takes 30 to 50 ms to load. Names
    that need no translation are written directly, which gives the same bytes.
    """
    name = encoding.header_space if color else "data"
    spec.attribute("colorInteropID", name)
    if not color or encoding.is_plain:
        return
    spec.attribute("oiio:ColorSpace", name)
    if encoding.header_chromaticities:
        spec.attribute("chromaticities", oiio.TypeDesc("float[8]"), encoding.header_chromaticities)


def _channel_names(name: str, kind: Kind, count: int) -> str:
    if kind.is_color:
        return "RGBA"[:count] if count > 2 else "YA"[:count]
    if kind is Kind.VECTOR:
        return "XYZW"[:count]
    return "Z" if is_depth(name) else "Y"


def choose_shown_layer(path: str | Path, kinds: Mapping[str, Kind]) -> str:
    """The layer that a format without layers shows: the first color layer, else the first field."""
    candidates = [name for name in kinds if kinds[name].is_color]
    candidates = candidates or [name for name in kinds if kinds[name] is not Kind.VECTOR]
    if not candidates:
        raise UsageError(f"{path}: vectors are data, not a picture: write them to an .exr file")
    return candidates[0]


def _encode_picture(
    array: Array,
    is_data: bool,
    frame: int,
    format: str,
    precision: Precision,
    compression: str,
    encoding: Encoding,
) -> EncodedPart:
    """The picture of a format that holds no layers. Data keeps its numbers in all of them.

    Alpha is left out where the format has none, and where its number is the largest everywhere and says nothing. One
    channel is written as gray in three: not all of these formats have pictures of one channel.
    """
    if array.shape[2] < 3:
        array = array[..., :1].repeat(3, axis=2)
    # Colors of an opaque picture need not be divided by its alpha, so it is looked at before they are encoded.
    array = array[..., :3] if format in ("hdr", "jpeg", "dpx") else _drop_opaque_alpha(array, 1.0)
    deep = precision == "float" and format in ("png", "tiff", "dpx")
    if format == "hdr":
        light = array if is_data else encoding.to_radiance(array)
        array = np.nan_to_num(np.maximum(light, 0.0), nan=0.0).astype(np.float32)
    else:
        array = encoding.to_codes(array, 16 if deep else 10 if format == "dpx" else 8, is_data=is_data, frame=frame)
        array = _drop_opaque_alpha(array, np.iinfo(array.dtype).max)  # a blurred alpha is 1 but for its last digits
    spec = oiio.ImageSpec(array.shape[1], array.shape[0], array.shape[2], _STORED[array.dtype.name])
    if format == "tiff":
        spec.attribute("compression", compression)
    if format == "png":
        spec.attribute("png:compressionLevel", _PNG_LEVEL)
        spec.attribute("png:filter", _PNG_FILTERS)
    if format == "jpeg":
        spec.attribute("compression", "jpeg:95")
        spec.attribute("jpeg:subsampling", "4:4:4")
    if format == "dpx":
        spec.attribute("oiio:BitsPerSample", 16 if deep else 10)
    elif format != "hdr":
        _tag_display_space(spec, format, "" if is_data else choose_png_space(encoding.display_space))
        spec.attribute("oiio:UnassociatedAlpha", 1)
    if format == "png" and not is_data and encoding.display_space != SRGB:
        spec.attribute(COLOR_TAG, encoding.display_space)
    return EncodedPart(spec, np.ascontiguousarray(array))


def _drop_opaque_alpha(array: Array, largest: float) -> Array:
    """The array without its alpha where that is the largest number everywhere."""
    is_opaque = array.shape[2] == 4 and bool((array[..., 3] == largest).all())
    return array[..., :3] if is_opaque else array


def _tag_display_space(spec: oiio.ImageSpec, format: str, name: str) -> None:
    """Describe the codes in the header of a format for displays; "" for data. As `_tag_color`, it spares a config for
    sRGB: PNG and WebP take it for granted, JPEG and TIFF store the number that Exif has for it."""
    if name != SRGB:
        spec.attribute("oiio:ColorSpace", name)
    elif format in ("jpeg", "tiff"):
        spec.attribute("Exif:ColorSpace", 1)


def _make_encoder(path: str | Path, format: str, parts: Sequence[EncodedPart]) -> Callable[[str], None]:
    def encode(file: str) -> None:
        output, first = open_encoder(path, format), parts[0].spec
        succeeded = (
            output.open(file, tuple(part.spec for part in parts)) if len(parts) > 1 else output.open(file, first)
        )
        for index, part in enumerate(parts):
            succeeded = succeeded and (index == 0 or output.open(file, part.spec, "AppendSubimage"))
            succeeded = succeeded and output.write_image(part.array)
        message = output.geterror()
        if not (output.close() and succeeded):
            raise encoder_error(path, message or output.geterror())

    return encode


def open_encoder(path: str | Path, format: str) -> oiio.ImageOutput:
    """The writer of a format. Raises OutputError if there is none."""
    output = oiio.ImageOutput.create(format)
    if output is None:
        reason = oiio.geterror().strip().partition("\n")[0] or f"this OpenImageIO has no encoder for {format}"
        if has_memory_limit():
            reason = "there is not enough memory (ulimit -v)"
        raise OutputError(f"{path}: cannot be written: {reason}")
    return output


def encoder_error(path: str | Path, message: str) -> OutputError:
    """The complaint of an encoder that could not write a file."""
    lines = message.strip().splitlines()
    return OutputError(f"{path}: cannot be written: {lines[0] if lines else 'the encoder gave no reason'}")
