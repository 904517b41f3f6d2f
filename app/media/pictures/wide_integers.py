"""Converts integers of 24 and 32 bits to 0..1."""

from __future__ import annotations

import struct
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

Array = np.ndarray

_SAMPLE = 0x010203
"""A number with three different bytes."""


def scale_to_unit(block: Array, spec: oiio.ImageSpec) -> Array:
    """uint32 as OpenImageIO decodes them, as 0..1 in float32.

    Numbers of 24 bits are in the upper bytes. OpenImageIO 3.2 reverses their bytes on little-endian processors.
    """
    if spec.get_int_attribute("oiio:BitsPerSample", 32) == 24 and _reverses_bytes():
        low, middle, high = (block >> 24) & 0xFF, (block >> 16) & 0xFF, (block >> 8) & 0xFF
        block = (high << 24) | (middle << 16) | (low << 8) | high
    return (block / np.float64(2**32 - 1)).astype(np.float32)


@cache
def _reverses_bytes() -> bool:
    """True if this OpenImageIO reverses the bytes of 24-bit numbers: it is tested with a file of one known pixel."""
    entries = ((256, 1), (257, 1), (258, 24), (259, 1), (262, 1), (273, 8), (277, 1), (278, 1), (279, 3))
    table = b"".join(struct.pack("<HHIHH", tag, 3, 1, number, 0) for tag, number in entries)
    data = struct.pack("<I", _SAMPLE) + struct.pack("<H", len(entries)) + table + bytes(4)
    with tempfile.TemporaryDirectory(prefix="halation-") as folder:
        path = Path(folder, "pixel.tif")
        path.write_bytes(b"II*\0" + struct.pack("<I", 12) + data)
        picture = oiio.ImageInput.open(str(path))
        pixel = picture.read_image("uint") if picture else None
        oiio.geterror()
        return pixel is not None and int(np.asarray(pixel).ravel()[0]) >> 8 != _SAMPLE
