"""How the window looks: its theme, its scale, its language and its title follow what the user chose."""

from __future__ import annotations

from typing import Any

from imgui_bundle import glfw_utils, hello_imgui, imgui

import glfw  # isort: skip

from ...language.translation import language, use_language
from ..theme import style
from ..theme.palette import Palette
from .editor import Editor


class Appearance:
    """What was applied last, so that only changes are applied."""

    def __init__(self) -> None:
        self._styled: tuple[Palette, float, tuple[float, ...]] | None = None
        self._title = ""

    def follow(self, editor: Editor) -> bool:
        """Apply what the user chose; True if the language is another one than in the last frame."""
        likes = editor.store.current
        imgui.get_io().config_input_text_cursor_blink = not likes.reduced_motion
        scale = likes.ui_scale or hello_imgui.dpi_window_size_factor()
        # The host scales the style too: behind the first frame, and where the window moves to another display.
        if self._styled != (editor.palette, scale, style.measure_style()):
            style.apply(editor.palette, scale)
            self._styled = (editor.palette, scale, style.measure_style())
        session = editor.session
        title = f"{'* ' if session.dirty else ''}{session.name} - Halation"
        if title != self._title:
            self._title = title
            glfw.set_window_title(find_host(), title)
        before = language()
        use_language(likes.language)
        return language() != before


def find_host() -> Any:
    """The window itself; the types of its library are wrong about it."""
    return glfw_utils.glfw_window_hello_imgui()
