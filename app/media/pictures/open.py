"""Opens picture files, and reads size and layers from their headers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import OpenImageIO as oiio
from halation.nodes import Size

from ...errors import InputError
from ...resources.input_files import check_file, fingerprint
from ...resources.library_messages import quiet_libraries
from ...resources.library_names import name_for_library
from ...resources.machine import available_cores, has_memory_limit
from ...resources.picture import MAX_OVERSCAN, PixelRectangle
from ...resources.sandbox import Sandbox
from ..channels import ChannelPart, group_channels
from ..layers import ImageInfo
from ..limits import check_size

COLOR_TAG = "halation:colorspace"
"""The attribute that names the color space in formats without a field for it."""

_DTYPES = {
    "half": "float16",
    "uint8": "uint8",
    "uint16": "uint16",
    "uint": "uint32",
    "int8": "int8",
    "int16": "int16",
    "int": "int32",
}
MAX_PIXEL_ASPECT = 16.0
"""The largest pixel aspect ratio that is believed, and the inverse of the least: that of anamorphic film is 2, of the
video formats at most 2.13. OpenEXR allows a million. Chosen by judgement: a viewer could show nothing beyond."""

_BY_ROWS = ("openexr", "tiff")
"""Formats that can be decoded from any row."""

_FAULTS = (
    ("subsampled", "stores color at a lower resolution than brightness, which cannot be read: save it as plain RGB"),
    ("not an openexr file", "is not an EXR file, whatever its name says: check what wrote it"),
    ("corrupt", "is cut short or damaged: copy or render it again"),
    ("end of file", "is cut short or damaged: copy or render it again"),
    ("exr_err_", "is cut short or damaged: copy or render it again"),
    ("permission", "may not be read: check its permissions"),
)

# OpenImageIO follows OPENIMAGEIO_THREADS, but ignores which processors this process may use; OpenEXR ignores both.
# OpenEXR waits for ever where a limit of memory leaves no thread for it; -1 asks for none.
oiio.attribute("threads", min(available_cores(), oiio.get_int_attribute("threads")))
oiio.attribute("exr_threads", -1 if has_memory_limit() else oiio.get_int_attribute("threads"))


@contextmanager
def open_picture(path: str | Path, sandbox: Sandbox) -> Iterator[oiio.ImageInput]:
    """Open a file. Alpha is not applied to color, since it must be applied to linear color. Raises InputError."""
    file = check_file(path, sandbox=sandbox)
    settings = oiio.ImageSpec()
    settings.attribute("oiio:UnassociatedAlpha", 1)
    picture = None
    with name_for_library(file) as name, quiet_libraries():
        try:
            picture = oiio.ImageInput.open(name, settings)
            if picture is None:
                raise InputError(f"{path}: {describe_fault(oiio.geterror())}")
            yield picture
        except UnicodeDecodeError as error:
            raise InputError(f"{path}: {describe_fault('corrupt')}") from error
        finally:
            if picture is not None:
                picture.close()


def describe_picture(picture: oiio.ImageInput, path: str, sandbox: Sandbox) -> ImageInfo:
    """The header of an open file. Parts of another size (previews, pages) are left out. Raises InputError."""
    size, pixel_aspect = _upright_size(picture.spec()), read_pixel_aspect(picture.spec())
    check_size(path, size)
    parts: list[ChannelPart] = []
    windows: list[PixelRectangle] = []
    index, is_whole = 0, True
    while picture.seek_subimage(index, 0):
        spec = picture.spec()
        if spec.deep:
            raise InputError(f"{path}: holds deep samples, which cannot be read: flatten it first")
        if _upright_size(spec) == size:
            parts.append(_read_channels(index, spec))
            is_whole = is_whole and _is_whole(spec)
            # Of a picture that a camera turned, only the display window is read.
            windows.append(find_data_window(spec) if read_orientation(spec) == 1 else (0, 0, *size))
        index += 1
    picture.geterror()  # there is no further part
    format = picture.format_name()
    return ImageInfo(
        path,
        size,
        group_channels(parts),
        fingerprint(path, sandbox=sandbox),
        format,
        is_whole and format in _BY_ROWS,
        find_overscan(size, windows),
        pixel_aspect,
    )


def read_pixel_aspect(spec: oiio.ImageSpec) -> float:
    """The width of a pixel over its height, as the picture is shown upright; 1 for numbers that cannot be meant."""
    aspect = spec.get_float_attribute("PixelAspectRatio", 1.0)
    if not 1.0 / MAX_PIXEL_ASPECT <= aspect <= MAX_PIXEL_ASPECT:
        return 1.0
    return 1.0 / aspect if read_orientation(spec) > 4 else aspect


def read_orientation(spec: oiio.ImageSpec) -> int:
    """The orientation of the picture (TIFF 6.0, tag 274): 1 to 8; 1 is upright, also for invalid numbers."""
    orientation = spec.get_int_attribute("Orientation", 1)
    return orientation if 1 <= orientation <= 8 else 1


def read_color_tag(spec: oiio.ImageSpec) -> str:
    """The color space that the header names, "data" for data, "" if it names none."""
    names = (COLOR_TAG, "oiio:ColorSpace", "colorInteropID")
    return make_printable(next(filter(None, map(spec.get_string_attribute, names)), ""))


def make_printable(text: str) -> str:
    """A text of a header in printable characters, whatever bytes the file has."""
    return text.encode("utf-8", "replace").decode()


def describe_fault(message: str) -> str:
    """OpenImageIO's complaint as the rest of a sentence that starts with the path."""
    for word, sentence in _FAULTS:
        if word in message.casefold():
            return sentence
    first_line = message.strip().splitlines()[0] if message.strip() else "no reason given"
    return f"is no picture that can be read ({first_line})"


def _read_channels(index: int, spec: oiio.ImageSpec) -> ChannelPart:
    formats = spec.channelformats or (spec.format,) * spec.nchannels
    return ChannelPart(
        index,
        make_printable(spec.get_string_attribute("oiio:subimagename")),
        tuple(map(make_printable, spec.channelnames)),
        tuple(_DTYPES.get(str(format), "float32") for format in formats),
        read_color_tag(spec),
    )


def _upright_size(spec: oiio.ImageSpec) -> Size:
    """Width and height of the display window, upright."""
    width, height = spec.full_width or spec.width, spec.full_height or spec.height
    return (height, width) if read_orientation(spec) > 4 else (width, height)


def find_data_window(spec: oiio.ImageSpec) -> PixelRectangle:
    """The data window as it is stored, counted from the top left pixel of the display window."""
    return (spec.x - spec.full_x, spec.y - spec.full_y, spec.width, spec.height)


def find_overscan(size: Size, windows: Sequence[PixelRectangle]) -> PixelRectangle | None:
    """The smallest rectangle that holds the frame and data windows, as far as overscan goes; None for the frame."""
    width, height = size
    margin = math.ceil(MAX_OVERSCAN * height)
    left, top = (min(0, *(max(window[axis], -margin) for window in windows)) for axis in (0, 1))
    right, bottom = (
        max(side, *(min(window[axis] + window[axis + 2], side + margin) for window in windows))
        for axis, side in enumerate(size)
    )
    overscanned = (left, top, right - left, bottom - top)
    return None if overscanned == (0, 0, width, height) else overscanned


def _is_whole(spec: oiio.ImageSpec) -> bool:
    """True if the pixels fill exactly the display window, and it is upright."""
    display = (spec.full_x, spec.full_y, spec.full_width or spec.width, spec.full_height or spec.height)
    return (spec.x, spec.y, spec.width, spec.height) == display and read_orientation(spec) == 1
