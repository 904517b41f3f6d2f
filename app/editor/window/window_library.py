"""Says which copy of the window library `glfw` loads: that of imgui-bundle, as two copies know nothing of each other.

To import imgui-bundle does this too, and takes a fifth of a second, before which no window could be shown. Where its
copy is not at its usual place, it is imported.
"""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec
from pathlib import Path

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


choose_window_library()
