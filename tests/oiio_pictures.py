"""Arrays for OpenImageIO, which many tests ask for a second opinion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio


def buffer(pixels: np.ndarray) -> oiio.ImageBuf:
    """[h, w, c] of float32 as an image whose fourth channel is alpha."""
    made = oiio.ImageBuf(oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], "float"))
    made.set_pixels(oiio.ROI.All, pixels)
    made.specmod().alpha_channel = 3
    return made


def stored(path: Path, array: np.ndarray, *, format: str = "half", tile: int = 0, **said: object) -> str:
    """A file of an array, by OpenImageIO."""
    spec = oiio.ImageSpec(array.shape[1], array.shape[0], array.shape[2], format)
    spec.tile_width = spec.tile_height = tile
    for name, item in said.items():
        spec.attribute(name, item)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec) and output.write_image(array) and output.close()
    return str(path)
