"""Arrays for OpenImageIO, which many tests ask for a second opinion."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio


def buffer(pixels: np.ndarray) -> oiio.ImageBuf:
    """[h, w, c] of float32 as an image whose fourth channel is alpha."""
    made = oiio.ImageBuf(oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], "float"))
    made.set_pixels(oiio.ROI.All, pixels)
    made.specmod().alpha_channel = 3
    return made
