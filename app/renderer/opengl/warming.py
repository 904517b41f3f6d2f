"""Loads the OpenGL driver and OpenImageIO on another thread: that takes most of the time of opening a device, and two
thirds of that of importing OpenImageIO.
"""

from __future__ import annotations

import ctypes
import os
import sys
import threading
from functools import cache
from importlib.machinery import EXTENSION_SUFFIXES
from importlib.util import find_spec
from pathlib import Path
from typing import Any

EGL_LIBRARY = "libEGL.so.1"
GL = "libGL.so.1"
_MOST_DEVICES = 32
"""Devices of EGL that are listed: far more than a machine has."""
_DEVICE = 0x313F
"""EGL_PLATFORM_DEVICE_EXT."""
_STRINGS = 25 << 20
"""Bytes of the table of strings that OpenImageIO makes when it is loaded, in 6,144 blocks."""
_LARGEST_BLOCK = 120 << 10
"""Bytes of a block that is part of a heap: from 128 KiB on, it would have a mapping of its own."""

_THREAD = "driver"


@cache
def warm() -> None:
    """Begin to load the driver of a context without a window on another thread, and then OpenImageIO, on Linux, once.

    It is only an optimization: opening a device and the import work without it, and only they report errors.
    """
    if sys.platform.startswith("linux"):
        spec = find_spec("OpenImageIO")
        pictures = Path(spec.origin).parent if spec is not None and spec.origin else Path()
        _set_import_variables(pictures)
        threading.Thread(target=_load, args=(pictures,), name=_THREAD, daemon=True).start()


def wait_for_driver() -> None:
    """Wait until the thread that loads the driver has ended, if there is one, so that no two threads are in EGL."""
    for thread in threading.enumerate():
        if thread.name == _THREAD:
            thread.join()


def _set_import_variables(pictures: Path) -> None:
    """Set the variables of the environment that numpy and OpenImageIO, in its folder, would set when they are imported.

    Drivers read the environment while they are loaded, and on Linux it may not be changed by another thread meanwhile.
    """
    os.environ.setdefault("OPENBLAS_MAIN_FREE", "1")
    if all((pictures / part).exists() for part in ("share", "bin", "lib")):  # as it asks itself
        os.environ.setdefault("OpenImageIO_ROOT", str(pictures))


def _load(pictures: Path) -> None:
    _load_driver()
    _load_openimageio(pictures)


def _load_openimageio(folder: Path) -> None:
    """Have the system load the library that Python will import. Python runs meanwhile, which it does not while it loads
    one itself.
    """
    dlopen = ctypes.CDLL(None).dlopen
    dlopen.argtypes, dlopen.restype = (ctypes.c_char_p, ctypes.c_int), ctypes.c_void_p
    for suffix in EXTENSION_SUFFIXES:
        if (file := folder / f"OpenImageIO{suffix}").exists():
            _make_room()
            dlopen(os.fsencode(file), sys.getdlopenflags())
            return


def _make_room() -> None:
    """Have the heap of this thread grow at once. It would ask the system for each page of OpenImageIO's strings, which
    takes a third of the time to load it: only the heap of the first thread grows by more than a page.

    Python's lock is kept: given up in hundreds of calls, it would be waited for as often.
    """
    library = ctypes.PyDLL(None)
    library.malloc.argtypes, library.malloc.restype = (ctypes.c_size_t,), ctypes.c_void_p
    library.free.argtypes, library.free.restype = (ctypes.c_void_p,), None
    blocks = [library.malloc(_LARGEST_BLOCK) for _ in range(_STRINGS // _LARGEST_BLOCK)]
    for block in reversed(blocks):
        library.free(block)


def _load_driver() -> None:
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
