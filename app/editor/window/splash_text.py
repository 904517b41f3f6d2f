"""What the small window says while the editor loads, drawn by the library of the interface: `follow_loading`."""

from __future__ import annotations

import ctypes
import sys
from pathlib import Path
from threading import Thread

import imgui_bundle
from imgui_bundle import imgui

import glfw  # isort: skip

from ...language.translation import translate
from ...version import VERSION
from .splash import GROUND, LEAST, LINE, LINE_HEIGHT, SIZE, Splash

_FONTS = Path(imgui_bundle.__file__).parent / "assets" / "fonts" / "Roboto"
_TEXT, _DIM = (0.894, 0.894, 0.906), (0.69, 0.69, 0.718)
_MODULES = 1230
"""About as many modules as the program has when the editor is loaded."""
_PAUSE = 0.03
"""Seconds between two pictures of the line."""


def follow_loading(splash: Splash, loading: Thread) -> None:
    """Show how far a thread is that imports modules, until it ends."""
    before = len(sys.modules)
    text = _SplashText(splash)
    while loading.is_alive():
        text.draw(max((len(sys.modules) - before) / (_MODULES - before), LEAST))
        loading.join(_PAUSE)
    text.draw(1.0)
    text.close()


class _SplashText:
    """Draws name, version, and how far the line is. `close` ends the library."""

    def __init__(self, splash: Splash) -> None:
        self._window, self._scale = splash.window, splash.scale
        self._context = imgui.create_context()
        imgui.get_io().set_ini_filename("")
        address = ctypes.cast(self._window, ctypes.c_void_p).value
        imgui.backends.glfw_init_for_opengl(address or 0, False)
        imgui.backends.opengl3_init("#version 410")
        fonts = imgui.get_io().fonts
        self._regular = fonts.add_font_from_file_ttf(str(_FONTS / "Roboto-Regular.ttf"), 0.0)
        self._bold = fonts.add_font_from_file_ttf(str(_FONTS / "Roboto-Bold.ttf"), 0.0)

    def draw(self, share: float) -> None:
        """Draw it with `share` of the line, 0 to 1."""
        glfw.poll_events()
        imgui.backends.opengl3_new_frame()
        imgui.backends.glfw_new_frame()
        imgui.new_frame()
        canvas, scale = imgui.get_background_draw_list(), self._scale
        width, height = (side * scale for side in SIZE)
        margin, line = 28.0 * scale, LINE_HEIGHT * scale
        canvas.add_rect_filled((0.0, 0.0), (width, height), _pack(GROUND))
        canvas.add_text(self._bold, 30.0 * scale, (margin, 24.0 * scale), _pack(_TEXT), "Halation")
        version = translate("Version {version}", version=VERSION)
        canvas.add_text(self._regular, 15.0 * scale, (margin, 70.0 * scale), _pack(_DIM), version)
        canvas.add_rect_filled((0.0, height - line), (width * min(share, 1.0), height), _pack(LINE))
        imgui.render()
        imgui.backends.opengl3_render_draw_data(imgui.get_draw_data())
        glfw.swap_buffers(self._window)

    def close(self) -> None:
        """End the library's state of this window."""
        imgui.backends.opengl3_shutdown()
        imgui.backends.glfw_shutdown()
        imgui.destroy_context(self._context)


def _pack(color: tuple[float, float, float]) -> int:
    return imgui.get_color_u32((*color, 1.0))
