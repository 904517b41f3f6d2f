"""Functions of OpenGL during which other threads of Python go on.

moderngl keeps Python's lock in every call. A software rasterizer computes a whole picture inside of one, and a GPU is
waited for in one: files would be neither decoded nor encoded meanwhile. Functions called through ctypes release it.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import moderngl


class OpenGLFunctions:
    """The slow functions of a context, which must be current on the calling thread."""

    def __init__(self, context: moderngl.Context) -> None:
        number = ctypes.c_uint
        self._use_program = _load(context, "glUseProgram", number)
        self._dispatch_compute = _load(context, "glDispatchCompute", number, number, number)
        self._finish = _load(context, "glFinish")

    def dispatch(self, program: moderngl.ComputeShader, groups: tuple[int, int, int]) -> None:
        """Run a compute program for so many groups."""
        self._use_program(program.glo)
        self._dispatch_compute(*groups)

    def finish(self) -> None:
        """Wait until the device has done everything."""
        self._finish()


def _load(context: moderngl.Context, name: str, *arguments: Any) -> Callable[..., None]:
    """A function at the address that the context's loader knows. One that a driver lacks is at 0, and never called."""
    loader = context.mglo._context  # glcontext's; the same in all versions that are allowed
    return ctypes.CFUNCTYPE(None, *arguments)(loader.load_opengl_function(name))
