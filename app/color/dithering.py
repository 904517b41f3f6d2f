"""Dithers colors before they are rounded to 8 or 10 bits, so that a dark ramp has a fine grain instead of bands.

A threshold per pixel decides which of the two nearest codes a number becomes, so that the mean over some pixels is the
number. The thresholds are blue noise (void and cluster, Ulichney 1993): the grain has no coarse parts that an eye or a
scaled copy could show. It is the table of the nodes `dither` and `blue_noise`.

Uniform thresholds are used, not triangular ones. Triangular ones (TPDF) would make the variance of the grain the same
for all numbers, but they are twice as wide: they change numbers that are exact codes, and their grain is stronger.
Here a picture for a screen, which holds exact codes, must come back bit by bit.
"""

from __future__ import annotations

import re
from functools import cache

import numpy as np
from halation import shaders

from .transforms import Array

_SIDE = 64
"""Pixels of a side of the table in lib/blue_noise.glsl, which has 64 x 64 ranks of 8 bits."""
_STRENGTH = 0.9
"""The range of thresholds in codes. With 1, rounding errors would change exact codes: pixels of 16 bits between passes
are off by at most 0.042 codes (the rounding of half floats through the sRGB curve), so 0.05 codes on both sides stay
free. The mean is then off by at most 0.05 codes, and the noise of a block of 16 x 16 pixels adds 0.02: measured."""

_GOLDEN = (0.7548776662466927, 0.5698402909980532)
"""Steps of the R2 sequence (Roberts 2018): the starts of any number of frames are spread evenly over the table."""

_PLANE_STARTS = ((0, 0), (48, 36), (32, 8))
"""Where the tables of three planes start, right and down: as in the node `blue_noise`, they are not correlated."""


def make_dither(width: int, height: int, frame: int, plane: int = 0) -> Array:
    """What is added to numbers in codes before they are rounded, [height, width] of float32 within -0.45..0.45.

    It is the same whenever the frame is rendered, and differs from frame to frame.
    """
    left, top = (
        int(frame * step % 1.0 * _SIDE) + start for step, start in zip(_GOLDEN, _PLANE_STARTS[plane], strict=True)
    )
    rows, columns = (np.arange(top, top + height) % _SIDE, np.arange(left, left + width) % _SIDE)
    return _read_table()[rows[:, None], columns]


@cache
def _read_table() -> Array:
    """The thresholds of the shader library, [64, 64], around 0."""
    text = (shaders.folder() / "lib" / "blue_noise.glsl").read_text(encoding="utf-8")
    words = np.array([int(word, 16) for word in re.findall(r"0x([0-9a-f]{8})u", text)], "<u4")
    ranks = words.view(np.uint8).reshape(_SIDE, _SIDE)
    return ((ranks + 0.5) / 256.0 - 0.5).astype(np.float32) * np.float32(_STRENGTH)
