"""Catches errors of panels, so that one cannot end the program."""

from __future__ import annotations

import traceback
from collections.abc import Callable

from imgui_bundle import imgui

from ...language.translation import translate
from ..toolkit.labels import translate_label
from .editor import Editor


def draw_guarded(editor: Editor, name: str, draw: Callable[[], object]) -> bool:
    """Draw a panel; False if it failed: the stacks of the library are repaired, and Problems shows the error."""
    state = imgui.internal.ErrorRecoveryState()
    imgui.internal.error_recovery_store_state(state)
    try:
        draw()
    except Exception as error:
        _recover(state)
        if name not in editor.faults:
            editor.log.add(
                translate(
                    "the panel {name} failed ({kind}: {error}); the document is safe",
                    name=name,
                    kind=type(error).__name__,
                    error=error,
                ),
                "error",
                traceback.format_exc(),
            )
        editor.faults[name] = traceback.format_exc()
        return False
    editor.faults.pop(name, None)
    return True


def enable_error_recovery() -> None:
    """Let the window library close what a failed panel leaves open, instead of ending the program. Call it once."""
    io = imgui.get_io()
    io.config_error_recovery_enable_assert = io.config_error_recovery_enable_tooltip = False
    io.config_error_recovery_enable_debug_log = True  # one of the three has to be on


def _recover(state: imgui.internal.ErrorRecoveryState) -> None:
    """Close everything that was begun since. The library's warnings about it are off here, and stay on in tests."""
    io = imgui.get_io()
    strict = io.config_error_recovery_enable_assert
    enable_error_recovery()
    imgui.internal.error_recovery_try_to_recover_state(state)
    io.config_error_recovery_enable_assert = strict


def draw_failure(editor: Editor, name: str) -> None:
    """Draw the message in place of a failed panel."""
    imgui.text_wrapped(
        translate("{name} could not be drawn. The document is safe; Problems has the details.", name=name)
    )
    if imgui.button(translate_label("Try again")):
        editor.faults.pop(name, None)
