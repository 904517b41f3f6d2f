"""Opens the window and runs it until it is closed."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from imgui_bundle import hello_imgui, immapp

from ... import document
from ...authoring.preferences import PreferenceStore, state_folder
from ...media.pictures.file_endings import is_picture
from ...resources.sandbox import Sandbox
from .opengl import has_visible_window
from .window import Window


def open_window(
    path: Path | None,
    bindings: Mapping[str, str],
    sandbox: Sandbox,
    lesson: str,
    *,
    version: tuple[int, int],
    on_shown: Callable[[], None],
) -> None:
    """Run the editor, on a lesson if its id is given. `on_shown` is called when its panels are seen for the first time.

    Raises DocumentError for a file that cannot be read, KeyboardInterrupt if it was interrupted.
    """
    if path is not None and not is_picture(path):
        document.load(path, sandbox=sandbox)  # what is wrong with it is told before a window flashes up
    state = state_folder()
    action = f"lesson.{lesson}" if lesson else ""
    window = Window(path, bindings, sandbox, first_action=action, version=version, state=state, on_shown=on_shown)
    keep_layout(window.params, state)
    separates = has_visible_window() and PreferenceStore(state).current.separate_windows
    window.params.imgui_window_params.enable_viewports = separates
    with _close_on_signals(window) as signals:
        run(window)
    if signal.SIGINT in signals:
        raise KeyboardInterrupt


def run(window: Window) -> None:
    """Run a window until it is closed. Raises the error if it cannot start, and errors outside of panels."""
    try:
        # Not `immapp.run`, which reads the sources of all loaded modules to see whether it is in a tutorial.
        immapp.immapp_cpp.run(window.params, immapp.AddOnsParams())
    except RuntimeError:
        # The library complains that nothing was drawn where a window ends before its first frame.
        if window.frames > 0 or not window.params.app_shall_exit:
            raise
    finally:
        window.close()
    if window.fault is not None:
        raise window.fault


def keep_layout(params: hello_imgui.RunnerParams, state: Path) -> None:
    """Save the layout of the panels, if the folder is writable: the library would end the program if it is not."""
    try:
        state.mkdir(parents=True, exist_ok=True)
    except OSError:
        params.ini_disable = True
        return
    params.ini_disable = not os.access(state, os.W_OK)
    params.ini_folder_type = hello_imgui.IniFolderType.absolute_path
    params.ini_filename = str(state / "layout.ini")


@contextmanager
def _close_on_signals(window: Window) -> Iterator[list[int]]:
    """Signals that ask the process to end close the window; unsaved work is offered at the next start.

    They are heard between two frames: an exception at any moment could cut a save in two.
    """
    received: list[int] = []

    def ask(number: int, _: object) -> None:
        received.append(number)
        window.params.app_shall_exit = True

    numbers = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = {number: signal.signal(number, ask) for number in numbers}
    try:
        yield received
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
