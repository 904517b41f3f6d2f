"""Open Image Denoise, which removes the noise of path tracers. It is an extra, so it may be missing."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import RenderError

Array = np.ndarray

HOW_TO_INSTALL = "denoising needs Open Image Denoise: run pip install 'halation[denoise]'"

_ProgressFunction = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_double)


@cache
def load_oidn() -> Any:
    """The module pyoidn, or None where it is not installed."""
    try:
        import pyoidn
    except ImportError:
        return None
    return pyoidn


def denoise(
    pictures: Mapping[str, Array], settings: Mapping[str, str | float | bool], report: Callable[[float], bool]
) -> Array:
    """The picture `color` without noise, guided by `albedo` and `normal` if they are there; alpha as it is.

    Guides that are noisy themselves are denoised first, as the manual of the library advises. Raises RenderError where
    the library is missing or fails.
    """
    library = load_oidn()
    if library is None:
        raise RenderError(HOW_TO_INSTALL)
    images = {name: np.ascontiguousarray(pixels[..., :3], np.float32) for name, pixels in pictures.items()}
    guides = [name for name in ("albedo", "normal") if name in images]
    noisy = bool(guides) and settings["guides"] == "noisy"
    steps = 1 + len(guides) if noisy else 1
    with library.Device(library.OIDN_DEVICE_TYPE_CPU) as device:
        device.commit()
        for step, name in enumerate(guides if noisy else ()):
            images[name] = _run_filter(library, device, {name: images[name]}, settings, _scale(report, step, steps))
        images = {name: images[name] for name in ("color", *guides)}
        cleaned = _run_filter(library, device, images, settings, _scale(report, steps - 1, steps))
    return np.concatenate([cleaned, pictures["color"][..., 3:].astype(np.float32)], axis=2)


def _scale(report: Callable[[float], bool], step: int, steps: int) -> Callable[[float], bool]:
    return lambda progress: report((step + progress) / steps)


def _run_filter(
    library: Any,
    device: Any,
    images: Mapping[str, Array],
    settings: Mapping[str, str | float | bool],
    report: Callable[[float], bool],
) -> Array:
    output, answers = np.zeros_like(next(iter(images.values()))), list[bool]()
    monitor = _ProgressFunction(lambda _, progress: answers.append(report(progress)) or answers[-1])
    oidn_filter = library.Filter(device, library.OIDN_FILTER_TYPE_RT)
    try:  # not `with`: it would swallow all exceptions
        for name, pixels in images.items():
            oidn_filter.set_image(name, pixels, library.OIDN_FORMAT_FLOAT3)
        oidn_filter.set_image("output", output, library.OIDN_FORMAT_FLOAT3)
        if "color" in images:
            oidn_filter.set_bool("hdr", bool(settings["hdr"]))
            oidn_filter.set_bool("cleanAux", len(images) > 1)
        oidn_filter.set_quality(getattr(library, f"OIDN_QUALITY_{str(settings['quality']).upper()}"))
        _watch_progress(library, oidn_filter, monitor)
        oidn_filter.commit()
        oidn_filter.execute()
    finally:
        oidn_filter.release()
    if (error := device.get_error()) is not None or not all(answers):
        raise RenderError(f"Open Image Denoise did not finish: {error or 'it was stopped'}")
    return output


def _watch_progress(library: Any, oidn_filter: Any, monitor: Any) -> None:
    """Let the library call `monitor`, which stops it by returning False. Its Python module cannot do that."""
    ffi = library.capi.oidn_ffi
    name = {"win32": "bin/OpenImageDenoise.dll", "darwin": "lib/libOpenImageDenoise.dylib"}
    path = Path(library.__file__).parent / "oidn" / name.get(sys.platform, "lib/libOpenImageDenoise.so")
    set_monitor = ctypes.CDLL(str(path)).oidnSetFilterProgressMonitorFunction
    set_monitor.argtypes = [ctypes.c_void_p, _ProgressFunction, ctypes.c_void_p]
    set_monitor.restype = None
    set_monitor(int(ffi.cast("uintptr_t", oidn_filter._filter)), monitor, None)
