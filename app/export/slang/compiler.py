"""Slang, the shader compiler of Khronos, which translates to WGSL and HLSL. It is an extra, so it may be missing.

The Python package slangpy brings the library, but translates only for devices that the machine has; so its C interface
is called here (the functions beginning with `sp` in slang.h).
"""

from __future__ import annotations

import ctypes
import importlib.util
from functools import cache
from pathlib import Path
from typing import Any, Literal

from ...errors import UsageError

HOW_TO_INSTALL = "--to wgsl, reshade and unity need the Slang compiler: run pip install 'halation[wgsl]'"

Language = Literal["wgsl", "hlsl"]

_LIBRARIES = ("libslang-compiler.so*", "libslang-compiler*.dylib", "slang-compiler.dll")
_LANGUAGE_VERSION = 2025
"""SLANG_LANGUAGE_VERSION_2025: the spellings of this version stay valid in later ones."""
_GLSL = 3
"""SLANG_SOURCE_LANGUAGE_GLSL of slang.h."""
_TARGETS: dict[Language, int] = {"hlsl": 5, "wgsl": 28}
"""SLANG_HLSL and SLANG_WGSL of slang.h."""
_NO_LINES = 1
"""SLANG_LINE_DIRECTIVE_MODE_NONE of slang.h."""
_STAGES = {"vertex": 1, "fragment": 5}
"""SlangStage of slang.h."""


class _SessionOptions(ctypes.Structure):
    """SlangGlobalSessionDesc of slang.h."""

    _fields_ = (
        ("size", ctypes.c_uint32),
        ("api_version", ctypes.c_uint32),
        ("language_version", ctypes.c_uint32),
        ("reads_glsl", ctypes.c_bool),
        ("reserved", ctypes.c_uint32 * 16),
    )


def translate_by_slang(text: str, stage: str, language: Language) -> str:
    """A shader in another language. `text` is Slang with the spellings of GLSL, `stage` is fragment or vertex.

    Raises UsageError where Slang is missing, ValueError with Slang's words for what it cannot translate.
    """
    library, session = _open_session()
    request = ctypes.c_void_p(library.spCreateCompileRequest(session))
    try:
        library.spAddCodeGenTarget(request, _TARGETS[language])
        library.spSetTargetLineDirectiveMode(request, 0, _NO_LINES)
        unit = library.spAddTranslationUnit(request, _GLSL, None)
        library.spAddTranslationUnitSourceString(request, unit, b"shader", text.encode())
        library.spAddEntryPoint(request, unit, b"main", _STAGES[stage])
        if library.spCompile(request):
            raise ValueError(library.spGetDiagnosticOutput(request).decode(errors="replace").strip())
        return library.spGetEntryPointSource(request, 0).decode()
    finally:
        library.spDestroyCompileRequest(request)


@cache
def _open_session() -> tuple[Any, ctypes.c_void_p]:
    """The library, and its session, which has read the functions of GLSL. It stays open: opening takes 0.2 s."""
    library = _load_library()
    for name in ("spCreateCompileRequest",):
        getattr(library, name).restype = ctypes.c_void_p
    for name in ("spGetDiagnosticOutput", "spGetEntryPointSource"):
        getattr(library, name).restype = ctypes.c_char_p
    options = _SessionOptions(ctypes.sizeof(_SessionOptions), 0, _LANGUAGE_VERSION, True)
    session = ctypes.c_void_p()
    if library.slang_createGlobalSession2(ctypes.byref(options), ctypes.byref(session)):
        raise UsageError(f"the Slang compiler does not start; {HOW_TO_INSTALL}")
    return library, session


def _load_library() -> Any:
    package = importlib.util.find_spec("slangpy")  # importing it would open a graphics device
    folder = Path(package.origin).parent if package and package.origin else None
    files = [file for pattern in _LIBRARIES for file in sorted(folder.glob(pattern))] if folder else []
    if not files:
        raise UsageError(HOW_TO_INSTALL)
    try:
        return ctypes.CDLL(str(files[0]))
    except OSError as error:
        raise UsageError(f"{files[0].name} cannot be loaded: {error}; {HOW_TO_INSTALL}") from None
