"""Tables of colors as pictures: the squares of a table side by side, as game engines read them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio

from ...color.transforms import Array
from ...errors import InputError, OutputError
from ...resources.atomic_write import write_atomically
from ...resources.input_files import check_file
from ...resources.sandbox import Sandbox

_LARGEST = 65535
"""The largest code of 16 bits."""
_OVERHEAD = 4096
"""Bytes that a PNG may take beyond its pixels, for the check of free space."""


def write_table_strip(path: str | Path, colors: Array, sandbox: Sandbox) -> None:
    """Write a table [red, green, blue, 3] of numbers from 0 to 1 as a PNG of 16 bits. Raises OutputError.

    Each square has one blue; red grows to the right, green downward. So Unreal and ReShade have it.
    """
    side = colors.shape[0]
    strip = colors.transpose(1, 2, 0, 3).reshape(side, side * side, 3)
    codes = np.rint(np.clip(strip, 0.0, 1.0) * _LARGEST).astype(np.uint16)

    def encode(name: str) -> None:
        buffer = oiio.ImageBuf(oiio.ImageSpec(side * side, side, 3, "uint16"))
        if not buffer.set_pixels(oiio.ROI(), codes) or not buffer.write(name, "uint16", "png"):
            raise OutputError(f"{path}: the picture cannot be written: {buffer.geterror()}")

    write_atomically(path, encode, codes.nbytes + _OVERHEAD, sandbox)


def read_table_strip(path: str | Path, sandbox: Sandbox) -> Array:
    """The table [red, green, blue, 3] in a strip. Raises InputError."""
    buffer = oiio.ImageBuf(str(check_file(path, sandbox)))
    pixels = buffer.get_pixels("float") if buffer.initialized else None
    if pixels is None:
        raise InputError(f"{path}: no picture of a table can be read: {buffer.geterror()}")
    side = pixels.shape[0]
    return np.asarray(pixels)[..., :3].reshape(side, side, side, 3).transpose(2, 0, 1, 3)
