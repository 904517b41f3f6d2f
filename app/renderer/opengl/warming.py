"""Loads the OpenGL driver on another thread, because that takes most of the time of opening a device."""

from __future__ import annotations

import ctypes
import os
import sys
import threading
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

EGL_LIBRARY = "libEGL.so.1"
GL = "libGL.so.1"
_MOST_DEVICES = 32
"""Devices of EGL that are listed: far more than a machine has."""
_DEVICE = 0x313F
"""EGL_PLATFORM_DEVICE_EXT."""


_THREAD = "driver"


@cache
def warm() -> None:
    """Begin to load the driver of a context without a window on another thread, on Linux, once.

    It is only an optimization: opening a device works without it, and only that reports errors.
    """
    if sys.platform.startswith("linux"):
        _set_import_variables()
        threading.Thread(target=_load, name=_THREAD, daemon=True).start()


def wait_for_driver() -> None:
    """Wait until the thread that loads the driver has ended, if there is one, so that no two threads are in EGL."""
    for thread in threading.enumerate():
        if thread.name == _THREAD:
            thread.join()


def _set_import_variables() -> None:
    """Set the variables of the environment that numpy and OpenImageIO would set when they are imported.

    Drivers read the environment while they are loaded, and on Linux it may not be changed by another thread meanwhile.
    """
    os.environ.setdefault("OPENBLAS_MAIN_FREE", "1")
    oiio = find_spec("OpenImageIO")
    folder = Path(oiio.origin).parent if oiio is not None and oiio.origin else Path()
    if all((folder / part).exists() for part in ("share", "bin", "lib")):  # as it asks itself
        os.environ.setdefault("OpenImageIO_ROOT", str(folder))


def _load() -> None:
    """Do what glcontext does first: choose a device and initialize it. EGL keeps that for all threads."""
    try:
        egl = ctypes.CDLL(EGL_LIBRARY)
    except OSError:
        return
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    query = _function(egl, b"eglQueryDevicesEXT", ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
    display_of = _function(
        egl, b"eglGetPlatformDisplayEXT", ctypes.c_void_p, ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p
    )
    place = os.environ.get("GLCONTEXT_DEVICE_INDEX", "0")
    devices = (ctypes.c_void_p * _MOST_DEVICES)()
    count = ctypes.c_int()
    if query is None or display_of is None or not place.isdecimal():
        return
    if query(len(devices), ctypes.byref(devices), ctypes.byref(count)) and int(place) < count.value:
        egl.eglInitialize.argtypes = (ctypes.c_void_p,) * 3
        egl.eglInitialize(display_of(_DEVICE, devices[int(place)], None), None, None)


def _function(egl: ctypes.CDLL, name: bytes, *types: Any) -> Any:
    """A function of an EGL extension by what it returns and takes; None if the driver does not have it."""
    address = egl.eglGetProcAddress(name)
    return ctypes.CFUNCTYPE(*types)(address) if address else None
