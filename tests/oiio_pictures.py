"""Arrays for OpenImageIO, which many tests ask for a second opinion."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
from exr_files import create_output


def make_buffer(pixels: np.ndarray) -> oiio.ImageBuf:
    """[h, w, c] of float32 as an image whose fourth channel is alpha."""
    image = oiio.ImageBuf(oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], "float"))
    image.set_pixels(oiio.ROI.All, pixels)
    image.specmod().alpha_channel = 3
    return image


def write_with_attributes(
    path: Path, array: np.ndarray, *, format: str = "half", tile: int = 0, **attributes: object
) -> str:
    """A file of an array, by OpenImageIO."""
    spec = oiio.ImageSpec(array.shape[1], array.shape[0], array.shape[2], format)
    spec.tile_width = spec.tile_height = tile
    for name, item in attributes.items():
        spec.attribute(name, item)
    output = create_output(path)
    assert output.open(str(path), spec) and output.write_image(array) and output.close()
    return str(path)


def write_picture(
    path: Path,
    array: np.ndarray,
    *,
    format: str = "float",
    names: tuple[str, ...] = (),
    at: tuple[int, int] = (0, 0),
    display: tuple[int, int, int, int] | None = None,
    attributes: Mapping[str, Any] | None = None,
) -> Path:
    """Write [h, w, c]; `at` is where the data starts, `display` the display window as x, y, width, height."""
    height, width, channels = array.shape
    spec = oiio.ImageSpec(width, height, channels, format)
    spec.x, spec.y = at
    spec.full_x, spec.full_y, spec.full_width, spec.full_height = display or (0, 0, width, height)
    if names:
        spec.channelnames = names
        spec.alpha_channel = names.index("A") if "A" in names else -1
    for name, value in (attributes or {}).items():
        if isinstance(value, tuple):
            spec.attribute(name, value[0], value[1])
        else:
            spec.attribute(name, value)
    output = create_output(path)
    assert output.open(str(path), spec) and output.write_image(np.ascontiguousarray(array)) and output.close()
    return path
