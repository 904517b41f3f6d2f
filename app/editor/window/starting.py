"""Starts the editor: shows a small window at once, and loads everything else behind it."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from threading import Thread

from ...resources.collection import pause_collection
from ...resources.sandbox import Sandbox
from .opengl import find_version, has_visible_window
from .splash import Splash


def start_editor(path: Path | None, bindings: Mapping[str, str], sandbox: Sandbox, lesson: str = "") -> None:
    """Run the editor, on a lesson if its id is given.

    Raises DeviceError where no window can be opened, DocumentError for a file that cannot be read, KeyboardInterrupt if
    it was interrupted.
    """
    splash = Splash() if has_visible_window() else None
    with pause_collection():
        loading = Thread(target=import_module, args=(".opening", __package__), name="loading", daemon=True)
        loading.start()  # most of a start are imports
        version = splash.version if splash is not None else find_version()
        if splash is not None:
            from .splash_text import follow_loading

            follow_loading(splash, loading)
        loading.join()
    from .opening import open_window

    try:
        open_window(path, bindings, sandbox, lesson, version=version, on_shown=splash.close if splash else lambda: None)
    finally:
        if splash is not None:
            splash.close()
