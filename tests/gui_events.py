"""Runs the real editor on events as the window system sends them, which may all come between two frames.

The test engine moves a keyboard of its own, behind the queue of the window; here the queue itself is fed.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any

from gui_driver import headless
from halation.editor.window.opening import run
from halation.editor.window.window import Window

import glfw  # isort: skip
from imgui_bundle import glfw_utils  # isort: skip

Script = Generator[Callable[[], bool], None, None]
"""Acts between frames, and waits until what it yields is true."""

LIMIT = 4000
"""Frames after which what never became true fails a test."""

_MODIFIERS = {
    "Ctrl": (glfw.KEY_LEFT_CONTROL, glfw.MOD_CONTROL),
    "Shift": (glfw.KEY_LEFT_SHIFT, glfw.MOD_SHIFT),
    "Alt": (glfw.KEY_LEFT_ALT, glfw.MOD_ALT),
}


class Keyboard:
    """A keyboard and a mouse whose events the window gets in its next frame."""

    def __init__(self, window: Window) -> None:
        self._window = window
        self._is_in_window = False

    @property
    def is_idle(self) -> bool:
        """True if the window has taken every event."""
        return not self._window._input

    def press(self, chord: str) -> None:
        """Press and release a chord such as `Ctrl+S`."""
        *modifiers, name = chord.split("+")
        key = getattr(glfw, f"KEY_{name.upper()}")
        bits = 0
        for modifier in modifiers:
            code, bit = _MODIFIERS[modifier]
            self._window._input.add_key(code, 0, glfw.PRESS, bits)
            bits |= bit
        self._window._input.add_key(key, 0, glfw.PRESS, bits)
        if len(name) == 1 and not bits:
            self._window._input.add_text(ord(name.lower()))
        self._window._input.add_key(key, 0, glfw.RELEASE, bits)
        for modifier in modifiers:
            code, bit = _MODIFIERS[modifier]
            self._window._input.add_key(code, 0, glfw.RELEASE, bits)
            bits &= ~bit

    def type(self, text: str) -> None:
        """Press the keys of a text."""
        for letter in text:
            key = ord(letter.upper())
            self._window._input.add_key(key, 0, glfw.PRESS, 0)
            self._window._input.add_text(ord(letter))
            self._window._input.add_key(key, 0, glfw.RELEASE, 0)

    def move(self, x: float, y: float) -> None:
        """Move the mouse."""
        host: Any = glfw_utils.glfw_window_hello_imgui()
        address = int(ctypes.cast(host, ctypes.c_void_p).value or 0)
        if not self._is_in_window:  # else the interface library asks for the place, and gets the last one
            self._window._input.add_entry(address, 1)
            self._is_in_window = True
        self._window._input.add_position(address, x, y)

    def click(self, button: int = 0, count: int = 1) -> None:
        """Click where the mouse is."""
        for _ in range(count):
            self._window._input.add_button(button, glfw.PRESS, 0)
            self._window._input.add_button(button, glfw.RELEASE, 0)

    def drag(self, *points: tuple[float, float]) -> None:
        """Drag with the left button from the first point through the others, all of it between two frames."""
        self.move(*points[0])
        self._window._input.add_button(0, glfw.PRESS, 0)
        for point in points[1:]:
            self.move(*point)
        self._window._input.add_button(0, glfw.RELEASE, 0)


def play(script: Callable[[Window, Keyboard], Script], folder: Path, path: Path | None = None) -> Window:
    """Open the editor, run a script between its frames, and close it."""
    window = headless(folder, path)
    before, steps = window.params.callbacks.post_new_frame, script(window, Keyboard(window))
    question: list[Callable[[], bool]] = [lambda: window.frames > 8]

    def frame() -> None:
        assert window.frames < LIMIT, "this never became true"
        if question[0]():  # the places of the last frame are forgotten below
            try:
                question[0] = next(steps)
            except StopIteration:
                window.editor.commands.closing = True
        before()

    window.params.callbacks.post_new_frame = frame
    window.params.fps_idling.enable_idling = False
    run(window)
    return window
