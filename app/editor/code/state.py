"""The state of the Code panel that other rooms read and set."""

from __future__ import annotations

from collections.abc import Callable

from msgspec import Struct


def _do_nothing() -> None:
    """Do nothing: there is no panel yet."""


class CodeState(Struct):
    """Requests to the Code panel, and what it shows."""

    focus: bool = False
    """True asks the panel to take the keyboard focus."""
    flush: Callable[[], object] = _do_nothing
    """Sets the typed text as code at once, instead of after a pause."""
    fault_path: str = ""
    """The path of the node whose error the panel showed in the last frame; other panels need not repeat it."""
    next_fault_path: str = ""
    """Becomes `fault_path` in the next frame: the panel sets it while it draws this one."""

    def begin_frame(self) -> None:
        """Call once a frame, before anything is drawn."""
        self.fault_path, self.next_fault_path = self.next_fault_path, ""
