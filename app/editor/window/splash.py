"""The small window that is there while the editor loads: a line grows in it.

It opens with nothing but the beginning of the line, by a few functions of OpenGL, before anything large is imported.
The rest is drawn by `splash_text`, as soon as the library of the interface is there.
"""

from __future__ import annotations

import ctypes
import sys
from typing import Any

from .opengl import open_hidden_window

import glfw  # isort: skip

SIZE = (420, 130)
GROUND, LINE = (0.114, 0.114, 0.125), (0.91, 0.514, 0.227)
"""Those of the dark theme, as files of preferences are not read yet."""
LINE_HEIGHT = 3.0
LEAST = 0.02
"""The part of the line that is there from the start."""
_COLOR_BUFFER_BIT, _SCISSOR_TEST = 0x4000, 0x0C11


class Splash:
    """The window, with the beginning of its line. It stays until `close`, while another window comes up beside it.

    `window` is its handle, whose OpenGL is current, None when it is closed, and `scale` the content scale of its
    monitor; `version` is the OpenGL that it has, and that windows can have here. Raises DeviceError where none opens.
    """

    def __init__(self) -> None:
        self.window: Any
        self.window, self.version = open_hidden_window(SIZE, "Halation starts")
        left, top, width, height = glfw.get_monitor_workarea(glfw.get_primary_monitor())
        self.scale = 1.0 if sys.platform == "darwin" else glfw.get_monitor_content_scale(glfw.get_primary_monitor())[0]
        size = round(SIZE[0] * self.scale), round(SIZE[1] * self.scale)
        glfw.set_window_size(self.window, *size)
        glfw.set_window_pos(self.window, left + (width - size[0]) // 2, top + (height - size[1]) // 2)
        glfw.make_context_current(self.window)
        glfw.show_window(self.window)
        self._draw_line()

    def close(self) -> None:
        """Close the window, once."""
        if self.window is not None:
            glfw.destroy_window(self.window)
            self.window = None

    def _draw_line(self) -> None:
        """Clear the window, and the beginning of the line."""
        width, height = glfw.get_framebuffer_size(self.window)
        functions = {
            name: ctypes.cast(glfw.get_proc_address(name), ctypes.CFUNCTYPE(None, *kinds))
            for name, kinds in {
                "glClearColor": (ctypes.c_float,) * 4,
                "glClear": (ctypes.c_uint,),
                "glEnable": (ctypes.c_uint,),
                "glDisable": (ctypes.c_uint,),
                "glScissor": (ctypes.c_int,) * 4,
            }.items()
        }
        glfw.poll_events()
        functions["glClearColor"](*GROUND, 1.0)
        functions["glClear"](_COLOR_BUFFER_BIT)
        functions["glEnable"](_SCISSOR_TEST)
        functions["glScissor"](0, 0, round(width * LEAST), round(height * LINE_HEIGHT / SIZE[1]))
        functions["glClearColor"](*LINE, 1.0)
        functions["glClear"](_COLOR_BUFFER_BIT)
        functions["glDisable"](_SCISSOR_TEST)
        glfw.swap_buffers(self.window)
