"""Pictures side by side under their names, to be compared at a glance."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import OpenImageIO as oiio

from .color import Array, decode_srgb, to_display

_GAP = 12
_LETTERS = 15
_BACK = 0.012
_INK = 0.6


def shown(array: Array, view: str = "") -> Array:
    """Scene-linear pixels as light of the display, [h, w, 3] of float32 within 0..1: what `sheet` takes.

    Raises:
        UsageError: unknown view.
    """
    return decode_srgb(np.clip(to_display(array, view, bits=32)[..., :3], 0.0, 1.0))


def sheet(pictures: Mapping[str, Array], columns: int = 4, width: int = 0) -> Array:
    """Light of the display, [h, w, 3] of float32; write it with the view `none`.

    `pictures` are such light too, by name and of one shape. They are shrunk to `width` pixels, if it is not 0.
    """
    pictures = {name: _resized(array, width or array.shape[1]) for name, array in pictures.items()}
    height, width = next(iter(pictures.values())).shape[:2]
    across, down = width + _GAP, height + 2 * _GAP + _LETTERS
    columns = min(columns, len(pictures))
    rows = -(-len(pictures) // columns)
    made = np.full((rows * down + _GAP, columns * across + _GAP, 3), _BACK, np.float32)
    places = [(_GAP + index // columns * down, _GAP + index % columns * across) for index in range(len(pictures))]
    for (top, left), array in zip(places, pictures.values(), strict=True):
        made[top : top + height, left : left + width] = array
    paper = oiio.ImageBuf(made)
    for (top, left), name in zip(places, pictures, strict=True):
        baseline = top + height + _LETTERS + 2
        oiio.ImageBufAlgo.render_text(paper, left, baseline, name.replace("_", " "), _LETTERS, "", (_INK,) * 3)
    return np.asarray(paper.get_pixels(oiio.FLOAT), np.float32)


def _resized(array: Array, width: int) -> Array:
    source = np.ascontiguousarray(array, dtype=np.float32)
    height = round(width * array.shape[0] / array.shape[1])
    if source.shape[:2] == (height, width):
        return source
    made = oiio.ImageBufAlgo.resize(oiio.ImageBuf(source), filtername="lanczos3", roi=oiio.ROI(0, width, 0, height))
    return np.clip(np.asarray(made.get_pixels(oiio.FLOAT), np.float32), 0.0, 1.0)
