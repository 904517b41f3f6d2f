"""Loads the largest library on another thread while Python imports modules.

The system takes 30 ms to load OpenImageIO, most of it without Python. A module of Python that is imported afterwards
finds the library loaded. It has to be over before the process forks, because the copy would keep the lock of the
loader, and before the environment changes, because libraries read it while they are loaded.
"""

from __future__ import annotations

import os
import sys
import threading
from importlib.machinery import EXTENSION_SUFFIXES
from importlib.util import find_spec
from pathlib import Path

_THREAD = "libraries"


def preload_libraries() -> None:
    """Begin to load OpenImageIO on another thread, on Linux. Without it, and without success, the import does all."""
    if sys.platform.startswith("linux"):
        threading.Thread(target=_load, name=_THREAD, daemon=True).start()


def wait_for_libraries() -> None:
    """Wait until the thread of `preload_libraries` has ended, if there is one."""
    for thread in threading.enumerate():
        if thread.name == _THREAD:
            thread.join()


def _load() -> None:
    """Call the loader of the system as a function of C: others run meanwhile, which `ctypes.CDLL(path)` prevents."""
    import ctypes

    package = find_spec("OpenImageIO")
    if package is None or package.origin is None:
        return
    library = Path(package.origin).with_name(f"OpenImageIO{EXTENSION_SUFFIXES[0]}")
    load = getattr(ctypes.CDLL(None), "dlopen", None)
    if load is not None and library.exists():
        load.restype, load.argtypes = ctypes.c_void_p, (ctypes.c_char_p, ctypes.c_int)
        load(os.fsencode(library), os.RTLD_NOW)
