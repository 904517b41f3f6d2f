"""An OpenGL context on a thread of its own, which compiles compute programs and runs none.

moderngl holds Python's lock while a driver compiles, so that only one thread would compile at a time. Functions that
are called through ctypes release it. The driver finishes a program when it is dispatched, for the formats of the images
that are bound then, so each program is dispatched: indirectly, with numbers of groups that are zero in a buffer. No
shader of it runs, and no uniform matters.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from functools import cache
from typing import Any

from ..device import ImageKind, ProgramVariant
from .warming import EGL_LIBRARY

_INT, _UINT, _POINTER = ctypes.c_int, ctypes.c_uint, ctypes.c_void_p

_OPENGL_API, _CONFIG = 0x30A2, (0x3033, 0x0001, 0x3040, 0x0008, 0x3038)
"""EGL_OPENGL_API; EGL_SURFACE_TYPE: EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE: EGL_OPENGL_BIT, EGL_NONE."""
_CONTEXT = (0x3098, 4, 0x30FB, 3, 0x30FD, 0x0001, 0x3038)
"""OpenGL 4.3 in the core profile: EGL_CONTEXT_MAJOR_VERSION, MINOR_VERSION, PROFILE_MASK, EGL_NONE."""

_COMPUTE_SHADER, _LINK_STATUS, _INDIRECT_BUFFER, _STATIC_DRAW = 0x91B9, 0x8B82, 0x90EE, 0x88E4
_TEXTURE_2D, _READ_ONLY, _WRITE_ONLY = 0x0DE1, 0x88B8, 0x88B9
_FORMATS = {
    (1, "f2"): 0x822D, (2, "f2"): 0x822F, (4, "f2"): 0x881A, (1, "f4"): 0x822E, (2, "f4"): 0x8230, (4, "f4"): 0x8814,
}  # fmt: skip
"""GL_R16F, GL_RG16F, GL_RGBA16F, GL_R32F, GL_RG32F, GL_RGBA32F."""

SIDES = {True: 16, False: 24}
"""The side of a picture by whether it stands for a power of two: drivers compile a program once for each."""


def find_display() -> int | None:
    """The EGL display of the context that is current on this thread; None where that was not opened through EGL."""
    try:
        egl = _load_egl()
    except OSError:
        return None
    return egl.eglGetCurrentDisplay()


class ThreadContext:
    """A context that is current on the thread that makes it. Raises OSError where the driver opens no second one."""

    def __init__(self, display: int) -> None:
        egl, self._display = _load_egl(), display
        config, count = ctypes.c_void_p(), _INT()
        egl.eglBindAPI(_OPENGL_API)
        egl.eglChooseConfig(display, (_INT * len(_CONFIG))(*_CONFIG), ctypes.byref(config), 1, ctypes.byref(count))
        self._context = egl.eglCreateContext(display, config, None, (_INT * len(_CONTEXT))(*_CONTEXT))
        if not count.value or not self._context or not egl.eglMakeCurrent(display, None, None, self._context):
            raise OSError("no second OpenGL context can be opened")
        self._textures: dict[tuple[ImageKind, int], int] = {}
        buffer = _UINT()
        self._call("glGenBuffers", 1, ctypes.byref(buffer))
        self._call("glBindBuffer", _INDIRECT_BUFFER, buffer)
        zeros = (_UINT * 3)()
        self._call("glBufferData", _INDIRECT_BUFFER, ctypes.c_size_t(12), ctypes.byref(zeros), _STATIC_DRAW)

    def compile(self, variant: ProgramVariant) -> bool:
        """Compile a program for images of these kinds; False where the driver refuses it."""
        shader, program, linked = self._call("glCreateShader", _COMPUTE_SHADER), self._call("glCreateProgram"), _INT()
        self._call("glShaderSource", shader, 1, (ctypes.c_char_p * 1)(variant.source.encode()), None)
        self._call("glCompileShader", shader)
        self._call("glAttachShader", program, shader)
        self._call("glLinkProgram", program)
        self._call("glGetProgramiv", program, _LINK_STATUS, ctypes.byref(linked))
        if linked.value:
            self._call("glUseProgram", program)
            self._bind(variant.textures, 0, _READ_ONLY)
            self._bind(variant.targets, len(variant.textures), _WRITE_ONLY)
            self._call("glDispatchComputeIndirect", ctypes.c_void_p(0))
            self._call("glUseProgram", 0)
        self._call("glDeleteProgram", program)
        self._call("glDeleteShader", shader)
        return bool(linked.value)

    def close(self) -> None:
        """Give the context back, with all that was created in it."""
        egl = _load_egl()
        egl.eglMakeCurrent(self._display, None, None, None)
        egl.eglDestroyContext(self._display, self._context)
        egl.eglReleaseThread()

    def _bind(self, kinds: Sequence[ImageKind], first: int, access: int) -> None:
        for unit, kind in enumerate(kinds, first):
            image_format = _FORMATS[kind.components, kind.depth]
            texture = self._textures.get((kind, unit)) or self._create_texture(kind, unit, image_format)
            self._call("glBindImageTexture", unit, texture, 0, 0, 0, access, image_format)

    def _create_texture(self, kind: ImageKind, unit: int, image_format: int) -> int:
        texture = _UINT()
        self._call("glGenTextures", 1, ctypes.byref(texture))
        self._call("glBindTexture", _TEXTURE_2D, texture)
        width, height = SIDES[kind.is_wide_power], SIDES[kind.is_high_power]
        self._call("glTexStorage2D", _TEXTURE_2D, 1, image_format, width, height)
        self._textures[kind, unit] = texture.value
        return texture.value

    def _call(self, name: str, *arguments: Any) -> int:
        return _load_function(name)(*arguments)


@cache
def _load_egl() -> Any:
    egl: Any = ctypes.CDLL(EGL_LIBRARY)
    egl.eglGetProcAddress.restype = egl.eglGetCurrentDisplay.restype = egl.eglCreateContext.restype = _POINTER
    egl.eglChooseConfig.argtypes = (_POINTER, _POINTER, _POINTER, _INT, _POINTER)
    egl.eglCreateContext.argtypes = egl.eglMakeCurrent.argtypes = (_POINTER,) * 4
    egl.eglDestroyContext.argtypes = (_POINTER,) * 2
    return egl


@cache
def _load_function(name: str) -> Any:
    """A function of OpenGL. Arguments are ints, or say themselves what they are."""
    return ctypes.CFUNCTYPE(_UINT)(_load_egl().eglGetProcAddress(name.encode()))
