"""A panel that fails must not take the program along."""

from __future__ import annotations

import traceback
from collections.abc import Callable

from imgui_bundle import imgui

from .editor import Editor


def draw_guarded(editor: Editor, name: str, draw: Callable[[], object]) -> bool:
    """Draw a panel; False if it failed. Then the stacks of the window library are put right, and Problems says why."""
    state = imgui.internal.ErrorRecoveryState()
    imgui.internal.error_recovery_store_state(state)
    try:
        draw()
    except Exception as error:
        _recover(state)
        if name not in editor.faults:
            editor.log.add(
                f"the panel {name} failed ({type(error).__name__}: {error}); the document is safe",
                "error",
                traceback.format_exc(),
            )
        editor.faults[name] = traceback.format_exc()
        return False
    editor.faults.pop(name, None)
    return True


def enable_error_recovery() -> None:
    """What a panel leaves open is closed for it, instead of ending the program; to be called once in a window."""
    io = imgui.get_io()
    io.config_error_recovery_enable_assert = io.config_error_recovery_enable_tooltip = False
    io.config_error_recovery_enable_debug_log = True  # one of the three has to be on


def _recover(state: imgui.internal.ErrorRecoveryState) -> None:
    """End all that was begun since. What is left open is no news here, though tests want to hear of it elsewhere."""
    io = imgui.get_io()
    strict = io.config_error_recovery_enable_assert
    enable_error_recovery()
    imgui.internal.error_recovery_try_to_recover_state(state)
    io.config_error_recovery_enable_assert = strict


def draw_failure(editor: Editor, name: str) -> None:
    """What a panel shows in place of itself."""
    imgui.text_wrapped(f"{name} could not be drawn. The document is safe; Problems has the details.")
    if imgui.button("Try again"):
        editor.faults.pop(name, None)
