"""Letters by FreeType, as a second opinion: many times as large, and made smaller by their mean."""

from __future__ import annotations

from collections.abc import Iterable
from ctypes import POINTER, Structure, byref, c_ubyte, cast
from pathlib import Path

import freetype
import numpy as np
from freetype import raw
from freetype.ft_enums.ft_load_flags import FT_LOAD_FLAGS
from freetype.ft_enums.ft_pixel_modes import FT_PIXEL_MODES

MOST = 16384
"""Pixels of the longer side of what FreeType fills: it counts in bytes, and more of them only take memory."""


def draw_letters(
    font: Path, glyphs: Iterable[tuple[int, float, float]], em: float, size: tuple[int, int], weight: float = 0.0
) -> np.ndarray:
    """How much of each pixel glyphs cover, each by its number and the place of its origin in pixels, y down.

    Where two glyphs cover parts of a pixel, the larger part counts. A variable font with one axis has this `weight`.
    """
    face = freetype.Face(str(font))
    if weight:
        face.set_var_design_coords((weight,))
    scale = min(32, max(4, MOST // max(size)))
    width, height = size[0] * scale, size[1] * scale
    cover = np.zeros((size[1], size[0]), np.float64)
    for number, x, y in glyphs:
        face.load_glyph(number, FT_LOAD_FLAGS["FT_LOAD_NO_SCALE"])
        outline = face.glyph.outline._FT_Outline
        if not outline.n_points:
            continue
        unit = em / face.units_per_EM * scale * 64.0
        for place in range(outline.n_points):
            point = outline.points[place]
            point.x = round(point.x * unit + x * scale * 64.0)
            point.y = round(point.y * unit + (size[1] - y) * scale * 64.0)
        letter = _fill(outline, width, height).reshape(size[1], scale, size[0], scale).mean((1, 3)) / 255.0
        cover = np.maximum(cover, letter)
    return cover


def _fill(outline: Structure, width: int, height: int) -> np.ndarray:
    pixels = np.zeros((height, width), np.uint8)
    bitmap = raw.FT_Bitmap()
    bitmap.rows, bitmap.width, bitmap.pitch = height, width, width
    bitmap.num_grays, bitmap.pixel_mode = 256, FT_PIXEL_MODES["FT_PIXEL_MODE_GRAY"]
    bitmap.buffer = cast(pixels.ctypes.data, POINTER(c_ubyte))
    assert raw.FT_Outline_Get_Bitmap(freetype.get_handle(), byref(outline), byref(bitmap)) == 0
    return pixels
