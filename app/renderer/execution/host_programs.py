"""The programs that passes run on the processor, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from ...color.reduction import reduce_colors
from ...media.denoising import denoise

Array = np.ndarray
Settings = Mapping[str, str | float | bool]
ProgressReport = Callable[[float], bool]
"""Receives the part that is done, 0 to 1. False asks the program to stop: then its picture is not used."""

HOST_PROGRAMS: Mapping[str, Callable[[Mapping[str, Array], Settings, ProgressReport], Array]] = MappingProxyType(
    {"open_image_denoise": denoise, "reduce_colors": reduce_colors}
)
"""Each makes a picture, [height, width, channels] of float32, of pictures by name."""
