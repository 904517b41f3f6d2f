"""Loads the window library: `glfw` with the copy of imgui-bundle, as two copies know nothing of each other.

To import imgui-bundle chooses it too, and takes a fifth of a second, before which no window could be shown. Where its
copy is not at its usual place, it is imported.
"""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import cast

_NAME = {"darwin": "libglfw.3.dylib", "win32": "glfw3.dll"}.get(sys.platform, "libglfw.so.3")


def choose_window_library() -> None:
    """Let `import glfw` load the copy of imgui-bundle, unless the environment names another one."""
    if "imgui_bundle" in sys.modules or os.environ.get("PYGLFW_LIBRARY"):
        return
    spec = find_spec("imgui_bundle")
    library = Path(spec.origin).with_name(_NAME) if spec is not None and spec.origin else None
    if library is not None and library.is_file():
        os.environ["PYGLFW_LIBRARY"] = str(library)
    else:
        import imgui_bundle  # noqa: F401


def import_window_library() -> None:
    """Import `glfw` without cffi, a compiler of C headers that it would import for functions of Vulkan: 25 ms."""
    is_hidden = "cffi" not in sys.modules
    if is_hidden:
        sys.modules["cffi"] = cast(ModuleType, None)  # what cannot be imported, until glfw has tried
    try:
        import glfw  # noqa: F401
    finally:
        if is_hidden:
            del sys.modules["cffi"]


choose_window_library()
import_window_library()
