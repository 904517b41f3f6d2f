"""EXR files through OpenImageIO, as scripts in Python have them."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

Array = np.ndarray
THREADS = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def use_all_processors() -> None:
    """Let OpenImageIO use all processors for EXR too."""
    oiio.attribute("threads", THREADS)
    oiio.attribute("exr_threads", THREADS)


def read(path: Path, half: bool = False) -> Array:
    """The pixels as [height, width, channels] of float32, or of float16."""
    file = oiio.ImageInput.open(str(path))
    if file is None:
        raise OSError(oiio.geterror())
    pixels = file.read_image(0, 0, 0, file.spec().nchannels, "half" if half else "float")
    file.close()
    if pixels is None:
        raise OSError(f"{path}: {oiio.geterror()}")
    return pixels


def write(path: Path, pixels: Array, half: bool | None = None) -> None:
    """Write with zip compression; half floats if the array has them, or as `half` says."""
    if pixels.ndim == 2:
        pixels = pixels[..., None]
    half = pixels.dtype == np.float16 if half is None else half
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, "half" if half else "float")
    spec.attribute("compression", "zip")
    if channels > 1:
        spec.channelnames = tuple("RGBA"[:channels])
    file = oiio.ImageOutput.create(str(path))
    if not file or not file.open(str(path), spec) or not file.write_image(np.ascontiguousarray(pixels)):
        raise OSError(oiio.geterror())
    file.close()
