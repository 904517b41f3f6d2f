"""When the window draws although nobody touches it: while something works or moves, and when a thread has news.

Drawing a frame takes 65 ms of processor time where no GPU does it (llvmpipe, 1600x1000), so a window that draws twice a
second takes a seventh of a core. A window at rest waits for events instead. What does not come as an event of the
window system wakes it: changed files, and signals, which Python hears only when its main thread runs again.
"""

from __future__ import annotations

import os
import select
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import suppress

from imgui_bundle import imgui
from msgspec import Struct

import glfw  # isort: skip

from ...authoring.log import TOAST_SECONDS
from .editor import Editor
from .status import SECONDS

AT_REST = 0.125
"""Frames per second while nothing happens: the watch on other editors and the memory goes on."""

_BLINK = 3.0
"""Frames per second while a text cursor blinks, which it does every 0.6 s."""

_CHANGES = 4.0
"""Frames per second while numbers of a render change, or a message is about to go."""

_SOON = 10.0
"""Frames per second while a thread reads what is about to be shown."""

_SETTLING_RATE, _SETTLING_SECONDS, _SETTLING_FRAMES = 30.0, 1.0, 8
"""Frames per second after an event, for how many seconds, and at least how many of them. A dialog takes up to 5 frames
to be laid out (see `input_events`), and a tooltip waits 0.4 s for a mouse that rests."""

GRACE = 1.5
"""Seconds of drawing after the last picture: thumbnails, scopes and the search for NaN follow it."""

_LOOK = 0.25
"""Seconds between two looks for news: a delay that nobody notices after another program saved a file."""


def choose_idle_rate(editor: Editor) -> float:
    """How often the window draws while no event comes, in frames per second."""
    has_news = editor.dialogs.matches or "export" in editor.dialogs.open
    if editor.dialogs.browse is not None or editor.renders.is_busy or editor.preview.is_decoding or has_news:
        return _SOON
    newest = editor.log.entries[-1] if editor.log.entries else None
    if editor.exports.running or (newest and editor.log.age(newest) < max(SECONDS, TOAST_SECONDS) + 1.0):
        return _CHANGES
    return _BLINK if imgui.get_io().want_text_input else AT_REST


class Settling(Struct):
    """How often the window draws while what the last event changed finds its place.

    The library that hosts the window would do this itself, but it sees no events: they come from our queue.
    """

    _until: float = 0.0
    _frames: int = 0

    def choose_rate(self, has_event: bool, time_now: float) -> float:
        """Frames per second after a frame, which had events or not; 0 when all has settled."""
        if has_event:
            self._until, self._frames = time_now + _SETTLING_SECONDS, _SETTLING_FRAMES
        self._frames = max(self._frames - 1, 0)
        return _SETTLING_RATE if self._frames or time_now < self._until else 0.0


class FrameWaker:
    """Wakes a window that waits for events, from a thread: when `has_news`, and when a signal comes."""

    def __init__(self, has_news: Callable[[], bool]) -> None:
        self._has_news = has_news
        self._reader, self._writer = os.pipe()
        os.set_blocking(self._writer, False)
        self._signals = _redirect_signals(self._writer)
        self._ended = False
        self._thread = threading.Thread(target=self._run, name="waker", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop waking."""
        if self._ended:
            return
        self._ended = True
        if self._signals is not None:
            signal.set_wakeup_fd(self._signals)
        os.write(self._writer, b"\0")
        self._thread.join()
        os.close(self._reader)
        os.close(self._writer)

    def _run(self) -> None:
        while not self._ended:
            has_signal = self._wait()
            if not self._ended and (has_signal or self._has_news()):
                with suppress(glfw.GLFWError):
                    glfw.post_empty_event()

    def _wait(self) -> bool:
        """Wait for a while; True if a signal came."""
        if sys.platform == "win32":  # select takes only sockets there
            threading.Event().wait(_LOOK)
            return False
        readable, _, _ = select.select([self._reader], [], [], _LOOK)
        return bool(readable and os.read(self._reader, 64))


def _redirect_signals(writer: int) -> int | None:
    """Let signals be written to a pipe too; the file descriptor that got them before, None where that cannot be."""
    try:
        return signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    except (ValueError, OSError):  # only the main thread may, and a pipe will not do on Windows
        return None
