"""Starts the editor: shows a small window at once, and loads everything else behind it."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from threading import Thread

from ...resources.collection import keep_for_ever, pause_collection
from ...resources.sandbox import Sandbox
from .opengl import find_version, has_visible_window
from .splash import Splash

_INTERVAL = 0.0005
"""Seconds after which a thread that loads lets this one draw: with the usual 0.005 each call waits as long."""


def start_editor(path: Path | None, bindings: Mapping[str, str], sandbox: Sandbox, lesson: str = "") -> None:
    """Run the editor, on a lesson if its id is given.

    Raises DeviceError where no window can be opened, DocumentError for a file that cannot be read, KeyboardInterrupt if
    it was interrupted.
    """
    with pause_collection(), _short_turns():
        loading = Thread(target=_load, name="loading", daemon=True)
        loading.start()  # most of a start are imports
        splash = Splash() if has_visible_window() else None
        version = splash.version if splash is not None else find_version()
        if splash is not None:
            from .splash_text import follow_loading

            follow_loading(splash, loading)
        loading.join()
        keep_for_ever()
    from .opening import open_window

    try:
        open_window(path, bindings, sandbox, lesson, version=version, on_shown=splash.close if splash else lambda: None)
    finally:
        if splash is not None:
            splash.close()


def _load() -> None:
    """Import everything. The library of the interface comes last: while it is loaded no other thread gets a turn."""
    for name in ("...authoring.session", "...authoring.preview", ".opening"):
        import_module(name, __package__)


@contextmanager
def _short_turns() -> Iterator[None]:
    """Threads take turns of `_INTERVAL` inside."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(_INTERVAL)
    try:
        yield
    finally:
        sys.setswitchinterval(interval)
