"""The small window that is there while the editor loads: a line grows in it."""

from __future__ import annotations

import ctypes
import sys
from pathlib import Path
from threading import Thread
from typing import Any

import imgui_bundle
from imgui_bundle import imgui

import glfw  # isort: skip

from ...language.translation import translate
from ...version import VERSION
from .opengl import open_hidden_window

_SIZE = (420, 130)
_FONTS = Path(imgui_bundle.__file__).parent / "assets" / "fonts" / "Roboto"
_MODULES = 1300
"""About as many modules as the program has when the editor is loaded."""
_PAUSE = 0.03
"""Seconds between two pictures of the line."""

_GROUND, _TEXT, _DIM, _LINE = (0.114, 0.114, 0.125), (0.894, 0.894, 0.906), (0.69, 0.69, 0.718), (0.91, 0.514, 0.227)
"""Those of the dark theme, as files of preferences are not read yet."""


class Splash:
    """The window. It stays until `close`, with its last picture, while another window comes up beside it.

    `version` is the OpenGL that it has, and that windows can have here. Raises DeviceError where none opens.
    """

    def __init__(self) -> None:
        self._window: Any
        self._window, self.version = open_hidden_window(_SIZE, "Halation starts")
        left, top, width, height = glfw.get_monitor_workarea(glfw.get_primary_monitor())
        self._scale = 1.0 if sys.platform == "darwin" else glfw.get_monitor_content_scale(glfw.get_primary_monitor())[0]
        size = round(_SIZE[0] * self._scale), round(_SIZE[1] * self._scale)
        glfw.set_window_size(self._window, *size)
        glfw.set_window_pos(self._window, left + (width - size[0]) // 2, top + (height - size[1]) // 2)
        glfw.make_context_current(self._window)
        self._context = imgui.create_context()
        imgui.get_io().set_ini_filename("")
        address = ctypes.cast(self._window, ctypes.c_void_p).value
        imgui.backends.glfw_init_for_opengl(address or 0, False)
        imgui.backends.opengl3_init("#version 410")
        fonts = imgui.get_io().fonts
        self._text = fonts.add_font_from_file_ttf(str(_FONTS / "Roboto-Regular.ttf"), 0.0)
        self._bold = fonts.add_font_from_file_ttf(str(_FONTS / "Roboto-Bold.ttf"), 0.0)
        glfw.show_window(self._window)

    def follow(self, loading: Thread) -> None:
        """Show how far a thread is that imports modules, until it ends."""
        before = len(sys.modules)
        while loading.is_alive():
            self._draw((len(sys.modules) - before) / (_MODULES - before))
            loading.join(_PAUSE)
        self._draw(1.0)
        imgui.backends.opengl3_shutdown()
        imgui.backends.glfw_shutdown()
        imgui.destroy_context(self._context)

    def close(self) -> None:
        """Close the window, once."""
        if self._window is not None:
            glfw.destroy_window(self._window)
            self._window = None

    def _draw(self, share: float) -> None:
        glfw.poll_events()
        imgui.backends.opengl3_new_frame()
        imgui.backends.glfw_new_frame()
        imgui.new_frame()
        canvas, scale = imgui.get_background_draw_list(), self._scale
        width, height = (side * scale for side in _SIZE)
        margin, line = 28.0 * scale, 3.0 * scale
        canvas.add_rect_filled((0.0, 0.0), (width, height), _pack(_GROUND))
        canvas.add_text(self._bold, 30.0 * scale, (margin, 24.0 * scale), _pack(_TEXT), "Halation")
        below = (margin, 70.0 * scale)
        canvas.add_text(self._text, 15.0 * scale, below, _pack(_DIM), translate("Version {version}", version=VERSION))
        end = width * min(max(share, 0.02), 1.0)
        canvas.add_rect_filled((0.0, height - line), (end, height), _pack(_LINE))
        imgui.render()
        imgui.backends.opengl3_render_draw_data(imgui.get_draw_data())
        glfw.swap_buffers(self._window)


def _pack(color: tuple[float, float, float]) -> int:
    return imgui.get_color_u32((*color, 1.0))
