"""What a picture file holds, from its header alone."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import OpenImageIO as oiio
from halation.nodes import Kind, Size
from msgspec import Struct

from ..errors import InputError
from ..graph.frames import is_video
from ..resources.input_files import check_file, fingerprint
from .layers import ChannelPart, Layer, group_channels, match_layer

if TYPE_CHECKING:
    from ..graph import Input
    from .video import Facts

TAG = "halation:colorspace"
"""Names the color space in formats that have no word for it."""

LIMIT = "HALATION_MAX_PIXELS"
"""The environment variable for how many pixels a picture may have at most."""

_LONGEST_SIDE = 1 << 17
_MOST_PIXELS = 1 << 28
_BYTES = 4
_COPIES = 3
_CHANNELS = 4
"""How many numbers a pixel takes while it is converted: so many copies of so many channels."""

_DTYPES = {"half": "float16", "uint8": "uint8", "uint16": "uint16", "uint": "uint32"}
_BY_ROWS = ("openexr", "tiff")
"""Formats that need not be decoded from their beginning."""

_FAULTS = (
    ("subsampled", "stores color at a lower resolution than brightness, which cannot be read: save it as plain RGB"),
    ("not an openexr file", "is not an EXR file, whatever its name says: check what wrote it"),
    ("corrupt", "is cut short or damaged: copy or render it again"),
    ("end of file", "is cut short or damaged: copy or render it again"),
    ("exr_err_", "is cut short or damaged: copy or render it again"),
    ("permission", "may not be read: check its permissions"),
)


class ImageInfo(Struct, frozen=True):
    """The header of a file. `size` is the display window, upright; `fingerprint` changes when the file does.

    `by_rows`: rows of it can be read alone, since its pixels are stored upright, all of them, and not as a stream.
    """

    path: str
    size: Size
    layers: tuple[Layer, ...]
    fingerprint: str
    format: str
    by_rows: bool = False


def read_info(path: str | Path) -> ImageInfo:
    """Read the header.

    Raises:
        InputError: missing, empty, damaged, deep or not a picture.
    """
    if is_video(str(path)):
        return describe_video(read_video_info(path))
    with open_picture(path) as handle:
        return describe_picture(handle, str(path))


def read_video_info(path: str | Path) -> Facts:
    """What is known of a video. Raises InputError."""
    from .video import facts_of

    check_file(path)
    return facts_of(str(path), fingerprint(path))


def find_layer(header: ImageInfo, name: str) -> Layer:
    """The layer that `name` means: `Combined`, `ViewLayer.Combined`, `Z`, or one channel such as `Position.Z`.

    Letter case, blanks, `_` and `-` do not matter; "" is the first color layer.

    Raises:
        InputError: no layer, or more than one, answers to the name.
    """
    return match_layer(header.path, header.layers, name)


def choose_layer(header: ImageInfo, socket: Input) -> str:
    """The layer that an input asks for, if this file has it; a plain picture stands for any layer of color."""
    if not socket.layer or socket.kind is not Kind.IMAGE:
        return socket.layer
    try:
        find_layer(header, socket.layer)
    except InputError:
        return find_layer(header, "").name
    return socket.layer


@contextmanager
def open_picture(path: str | Path) -> Iterator[oiio.ImageInput]:
    """The open file; alpha is left as stored, because it must be applied to linear color."""
    file = check_file(path)
    wish = oiio.ImageSpec()
    wish.attribute("oiio:UnassociatedAlpha", 1)
    handle = None
    try:
        handle = oiio.ImageInput.open(str(file), wish)
        if handle is None:
            raise InputError(f"{path}: {describe_fault(oiio.geterror())}")
        yield handle
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: {describe_fault('corrupt')}") from error
    finally:
        if handle is not None:
            handle.close()


def describe_picture(handle: oiio.ImageInput, path: str) -> ImageInfo:
    """The header of an open file. Parts of another size (previews, pages) are left out."""
    main = handle.spec()
    size = _size(main)
    _check_size(size, path)
    parts: list[ChannelPart] = []
    index, whole = 0, True
    while handle.seek_subimage(index, 0):
        spec = handle.spec()
        if spec.deep:
            raise InputError(f"{path}: holds deep samples, which cannot be read: flatten it first")
        if _size(spec) == size:
            parts.append(_part(index, spec))
            whole = whole and _is_whole(spec)
        index += 1
    by_rows = whole and handle.format_name() in _BY_ROWS
    return ImageInfo(path, size, group_channels(parts), fingerprint(path), handle.format_name(), by_rows)


def describe_video(facts: Facts) -> ImageInfo:
    """A video as a picture of one layer, which is another one at every frame."""
    _check_size(facts.size, facts.path)
    names = ("R", "G", "B", "A") if facts.alpha else ("R", "G", "B")
    format = "uint8" if facts.bits == 8 else "uint16" if facts.bits < 32 else "float32"
    part = ChannelPart(0, "", names, (format,) * len(names), "")
    return ImageInfo(facts.path, facts.size, group_channels([part]), fingerprint(facts.path), f"video, {facts.codec}")


def _check_size(size: Size, path: str) -> None:
    said = os.environ.get(LIMIT, "")
    most = int(said) if said.isascii() and said.isdecimal() else _MOST_PIXELS
    if not all(0 < side <= _LONGEST_SIDE for side in size) or size[0] * size[1] > most:
        raise InputError(
            f"{path}: claims to be {size[0]}x{size[1]} pixels, more than can be read ({most:,} in all): if that is "
            f"right, set {LIMIT} to more"
        )


def machine_memory() -> float:
    """Bytes of memory that this machine has; infinite where the system does not say."""
    if not hasattr(os, "sysconf"):
        return math.inf
    there = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return there if there > 0 else math.inf


def check_memory(path: str, size: Size, channels: int) -> None:
    """Refuse what this machine cannot hold, before the system ends the process for it. Raises InputError."""
    there = machine_memory()
    need = size[0] * size[1] * _BYTES * (channels + _COPIES * _CHANNELS)
    if there < need:
        room, memory = need / 2**30, there / 2**30
        raise InputError(
            f"{path}: {size[0]}x{size[1]} pixels of {channels} channels take {room:.0f} GiB, and this machine has "
            f"{memory:.0f}: make it smaller first"
        )


def _part(index: int, spec: oiio.ImageSpec) -> ChannelPart:
    formats = spec.channelformats or (spec.format,) * spec.nchannels
    return ChannelPart(
        index,
        make_printable(spec.get_string_attribute("oiio:subimagename")),
        tuple(map(make_printable, spec.channelnames)),
        tuple(_DTYPES.get(str(item), "float32") for item in formats),
        read_color_tag(spec),
    )


def read_color_tag(spec: oiio.ImageSpec) -> str:
    """The color space that the header names, "data" for none at all, "" where it says nothing."""
    names = (TAG, "oiio:ColorSpace", "colorInteropID")
    return make_printable(next(filter(None, map(spec.get_string_attribute, names)), ""))


def make_printable(name: str) -> str:
    """A name that can be printed, whatever bytes were in the file."""
    return name.encode("utf-8", "replace").decode()


def _size(spec: oiio.ImageSpec) -> Size:
    width, height = spec.full_width or spec.width, spec.full_height or spec.height
    return (height, width) if spec.get_int_attribute("Orientation", 1) > 4 else (width, height)


def _is_whole(spec: oiio.ImageSpec) -> bool:
    """True if there are pixels for all of the display window and nothing else, and it is upright."""
    shown = (spec.full_x, spec.full_y, spec.full_width or spec.width, spec.full_height or spec.height)
    return (spec.x, spec.y, spec.width, spec.height) == shown and spec.get_int_attribute("Orientation", 1) == 1


def describe_fault(message: str) -> str:
    """OpenImageIO's complaint as the rest of a sentence that starts with the path."""
    for word, sentence in _FAULTS:
        if word in message.casefold():
            return sentence
    first = message.strip().splitlines()[0] if message.strip() else "no reason given"
    return f"is no picture that can be read ({first})"
