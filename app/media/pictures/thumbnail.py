"""Small pictures of files, for dialogs and lists."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from halation.nodes import Kind

from ...color.display import NO_VIEW, to_display
from ...color.transforms import Array, quantize
from ...errors import InputError
from ...resources.atomic_write import write_atomically
from ...resources.input_files import check_file
from ...resources.sandbox import Sandbox
from ..info import read_info
from ..layers import find_layer
from ..pixels import read_layer


def read_thumbnail(path: str | Path, width: int, height: int, sandbox: Sandbox) -> Array:
    """The first color layer within `width` x `height` pixels over black, as [h, w, 3] of uint8, sRGB.

    Floating-point color is shown through the default view, encoded pictures are shown unchanged. The numbers of data
    are gray: 0 is black and 1 is white.

    Raises:
        InputError: as `media.read`.
    """
    layer = find_layer(read_info(path, sandbox=sandbox), "")
    pixels = read_layer(path, "", Kind.IMAGE, sandbox=sandbox).array
    step = max(1, min(pixels.shape[1] // (2 * width), pixels.shape[0] // (2 * height)))
    small = shrink_to_fit(pixels[::step, ::step, :3], width, height)
    if layer.is_data:
        return quantize(np.nan_to_num(small, nan=0.0), 8)
    return to_display(small, "" if layer.format.startswith("float") else NO_VIEW)


def shrink_to_fit(pixels: Array, width: int, height: int) -> Array:
    """Pixels within `width` x `height`, each the mean of those that it stands for, as float32. Few stay as they are."""
    small = np.ascontiguousarray(pixels, dtype=np.float32)
    scale = min(width / small.shape[1], height / small.shape[0], 1.0)
    if scale == 1.0:
        return small
    across, down = (max(1, round(side * scale)) for side in (small.shape[1], small.shape[0]))
    return resize_by_area(small, across, down)


def resize_by_area(pixels: Array, width: int, height: int) -> Array:
    """Pixels in exactly this size, as float32: each is the mean of those that it stands for."""
    source = oiio.ImageBuf(np.ascontiguousarray(pixels, dtype=np.float32))
    resized = oiio.ImageBufAlgo.resize(source, filtername="box", roi=oiio.ROI(0, width, 0, height))
    return np.asarray(resized.get_pixels(oiio.FLOAT), np.float32)


def load_thumbnail(path: str | Path, sandbox: Sandbox) -> Array:
    """The bytes of an 8-bit RGB file, [h, w, 3] of uint8. Raises InputError."""
    picture = oiio.ImageBuf(str(check_file(path, sandbox)))
    pixels = picture.get_pixels(oiio.UINT8) if picture.read() else None
    if pixels is None or pixels.shape[2] != 3:
        picture.geterror()
        raise InputError(f"{path}: is not a picture of 8 bits with three channels, as thumbnails are")
    return np.asarray(pixels)


def save_thumbnail(path: str | Path, pixels: Array, sandbox: Sandbox) -> None:
    """Write [h, w, 3] of uint8 as PNG, or as JPEG by the ending. Raises OutputError."""
    height, width = pixels.shape[:2]
    format = "jpeg" if Path(path).suffix == ".jpg" else "png"

    def encode(name: str) -> None:
        output = oiio.ImageOutput.create(format)
        if output is not None and output.open(name, oiio.ImageSpec(width, height, 3, "uint8")):
            output.write_image(np.ascontiguousarray(pixels))
            output.close()

    write_atomically(path, encode, pixels.nbytes, sandbox=sandbox)
