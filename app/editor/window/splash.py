"""The small window that is there while the editor loads: a line grows in it.

It comes in two steps. The window opens with nothing but the line, by four functions of OpenGL, before anything large is
imported. What it says is drawn when the library of the interface is there.
"""

from __future__ import annotations

import ctypes
import sys
from threading import Thread
from typing import Any

from .opengl import open_hidden_window

import glfw  # isort: skip

SIZE = (420, 130)
GROUND, LINE = (0.114, 0.114, 0.125), (0.91, 0.514, 0.227)
"""Those of the dark theme, as files of preferences are not read yet."""
LINE_HEIGHT = 3.0
_LEAST = 0.02
"""The part of the line that is there from the start."""
_MODULES = 1300
"""About as many modules as the program has when the editor is loaded."""
_PAUSE = 0.03
"""Seconds between two pictures of the line."""
_COLOR_BUFFER_BIT, _SCISSOR_TEST = 0x4000, 0x0C11
_INTERVAL = 0.0005
"""Seconds after which the thread that loads lets this one draw: with the usual 0.005 each call waits as long."""


class Splash:
    """The window, with the beginning of its line. It stays until `close`, while another window comes up beside it.

    `version` is the OpenGL that it has, and that windows can have here. Raises DeviceError where none opens.
    """

    def __init__(self) -> None:
        self._window: Any
        self._window, self.version = open_hidden_window(SIZE, "Halation starts")
        left, top, width, height = glfw.get_monitor_workarea(glfw.get_primary_monitor())
        self._scale = 1.0 if sys.platform == "darwin" else glfw.get_monitor_content_scale(glfw.get_primary_monitor())[0]
        size = round(SIZE[0] * self._scale), round(SIZE[1] * self._scale)
        glfw.set_window_size(self._window, *size)
        glfw.set_window_pos(self._window, left + (width - size[0]) // 2, top + (height - size[1]) // 2)
        glfw.make_context_current(self._window)
        glfw.show_window(self._window)
        self._draw_line()

    def follow(self, loading: Thread) -> None:
        """Show how far a thread is that imports modules, until it ends."""
        before, interval = len(sys.modules), sys.getswitchinterval()
        sys.setswitchinterval(_INTERVAL)
        try:
            from .splash_text import SplashText

            text = SplashText(self._window, self._scale)
            while loading.is_alive():
                text.draw(max((len(sys.modules) - before) / (_MODULES - before), _LEAST))
                loading.join(_PAUSE)
            text.draw(1.0)
            text.close()
        finally:
            sys.setswitchinterval(interval)

    def close(self) -> None:
        """Close the window, once."""
        if self._window is not None:
            glfw.destroy_window(self._window)
            self._window = None

    def _draw_line(self) -> None:
        """Clear the window, and the beginning of the line."""
        width, height = glfw.get_framebuffer_size(self._window)
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
        functions["glScissor"](0, 0, round(width * _LEAST), round(height * LINE_HEIGHT / SIZE[1]))
        functions["glClearColor"](*LINE, 1.0)
        functions["glClear"](_COLOR_BUFFER_BIT)
        functions["glDisable"](_SCISSOR_TEST)
        glfw.swap_buffers(self._window)
