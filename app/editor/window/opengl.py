"""Which OpenGL a window can have."""

from __future__ import annotations

import os
import warnings
from typing import Any

from . import window_library  # noqa: F401  (first: it loads `glfw`)

import glfw  # isort: skip

from ...errors import DeviceError
from ...language.translation import mark, translate
from ...resources.machine import suggest_driver

_VERSIONS = ((4, 5), (4, 3), (4, 1))
"""With all that is used, with compute shaders, and what macOS has."""
_NO_WINDOW = mark(
    "no window can be opened here: the editor needs a display (over ssh, connect with -X); "
    "'halation render' works without one"
)


def has_visible_window() -> bool:
    """False where HALATION_WINDOW=none: windows are then opened without a display, for tests."""
    return os.environ.get("HALATION_WINDOW") != "none"


def open_hidden_window(size: tuple[int, int], title: str) -> tuple[Any, tuple[int, int]]:
    """A window that is not shown yet and has no frame, with the newest OpenGL of ours that a window here can have.

    Also returns that version, for the windows that follow: a refused one spoils every later attempt of the window
    library, so it begins anew after each. The library stays open. Raises DeviceError.
    """
    for version in _VERSIONS:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if not (glfw.init() if has_visible_window() else needs_no_display()):
                raise DeviceError(_NO_WINDOW)
            window = _create_window(size, title, version)
        if window:
            return window, version
        glfw.terminate()
    raise DeviceError(
        translate(
            "no window with OpenGL 4.1 can be opened here: {advice}; 'halation render' may still work",
            advice=suggest_driver(),
        )
    )


def find_version() -> tuple[int, int]:
    """The newest OpenGL of ours that a window here can have. Raises DeviceError."""
    window, version = open_hidden_window((16, 16), "")
    glfw.destroy_window(window)
    if not has_visible_window():
        needs_no_display()  # the hints of the window that was tried are gone
    return version


def needs_no_display() -> bool:
    """The next window is drawn like any other, but shown nowhere; False if that is not possible here."""
    glfw.init_hint(glfw.PLATFORM, glfw.PLATFORM_NULL)
    if not glfw.init():
        return False
    glfw.window_hint(glfw.CONTEXT_CREATION_API, glfw.EGL_CONTEXT_API)
    return True


def _create_window(size: tuple[int, int], title: str, version: tuple[int, int]) -> Any:
    """Create a hidden window without a frame. Returns a null pointer where there is no such OpenGL."""
    glfw.window_hint(glfw.VISIBLE, False)
    glfw.window_hint(glfw.DECORATED, False)
    glfw.window_hint(glfw.RESIZABLE, False)
    glfw.window_hint(glfw.FOCUS_ON_SHOW, False)
    glfw.window_hint(glfw.CONTEXT_VERSION_MAJOR, version[0])
    glfw.window_hint(glfw.CONTEXT_VERSION_MINOR, version[1])
    glfw.window_hint(glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE)
    glfw.window_hint(glfw.OPENGL_FORWARD_COMPAT, True)
    window = glfw.create_window(*size, title, None, None)
    glfw.default_window_hints()
    return window
