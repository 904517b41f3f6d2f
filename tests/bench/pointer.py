"""The mouse and keys of an X display, as the window system sends them, and when: by the library of its XTEST extension.

A process per move, as xdotool is, would take the processor time that is measured.
"""

from __future__ import annotations

import ctypes
import ctypes.util
import time

LEFT, MIDDLE = 1, 2


class Pointer:
    """Moves the pointer of a display."""

    def __init__(self, display: str) -> None:
        self._x11 = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
        self._test = ctypes.CDLL(ctypes.util.find_library("Xtst") or "libXtst.so.6")
        self._x11.XOpenDisplay.restype = ctypes.c_void_p
        self._display = ctypes.c_void_p(self._x11.XOpenDisplay(display.encode()))
        assert self._display.value, f"there is no display {display}"

    def move(self, x: float, y: float) -> float:
        """Move to a place of the screen; returns when that was."""
        self._test.XTestFakeMotionEvent(self._display, 0, round(x), round(y), ctypes.c_ulong(0))
        self._x11.XFlush(self._display)
        return time.monotonic()

    def press(self, button: int, is_down: bool) -> None:
        """Press a button, or let it go."""
        self._test.XTestFakeButtonEvent(self._display, button, is_down, ctypes.c_ulong(0))
        self._x11.XFlush(self._display)

    def close(self) -> None:
        """Leave the display."""
        self._x11.XCloseDisplay(self._display)
