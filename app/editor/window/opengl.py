"""Which OpenGL a window can have."""

from __future__ import annotations

import os
import warnings

from imgui_bundle import hello_imgui  # noqa: F401  (first: both must use the same window library)

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


def best_version() -> tuple[int, int]:
    """The newest OpenGL of ours that a window here can have. Raises DeviceError.

    A refused version would spoil every later attempt of the window library in this process, so a hidden window is
    asked first.
    """
    visible = has_visible_window()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if not (glfw.init() if visible else needs_no_display()):
            raise DeviceError(_NO_WINDOW)
        try:
            version = next(filter(_opens, _VERSIONS), None)
        finally:
            glfw.default_window_hints()
            glfw.terminate()
    if version is None:
        raise DeviceError(
            translate(
                "no window with OpenGL 4.1 can be opened here: {advice}; 'halation render' may still work",
                advice=suggest_driver(),
            )
        )
    if not visible:
        needs_no_display()
    return version


def needs_no_display() -> bool:
    """The next window is drawn like any other, but shown nowhere; False if that is not possible here."""
    glfw.init_hint(glfw.PLATFORM, glfw.PLATFORM_NULL)
    if not glfw.init():
        return False
    glfw.window_hint(glfw.CONTEXT_CREATION_API, glfw.EGL_CONTEXT_API)
    return True


def _opens(version: tuple[int, int]) -> bool:
    glfw.window_hint(glfw.VISIBLE, False)
    glfw.window_hint(glfw.CONTEXT_VERSION_MAJOR, version[0])
    glfw.window_hint(glfw.CONTEXT_VERSION_MINOR, version[1])
    glfw.window_hint(glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE)
    glfw.window_hint(glfw.OPENGL_FORWARD_COMPAT, True)
    window = glfw.create_window(16, 16, "", None, None)
    if not window:
        return False
    glfw.destroy_window(window)
    return True
