"""What the panel of code is asked to do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


def _nothing() -> None:
    """There is no panel yet."""


@dataclass
class CodeState:
    """What others know of the panel of code."""

    focus: bool = False
    """True asks it to take the keyboard."""
    flush: Callable[[], object] = _nothing
    """Takes over what was typed last: it waits for a pause otherwise."""
    told: str = ""
    """The path of the node whose fault stood below its text in the last frame: other panels need not repeat it."""
    telling: str = ""
    """The same for this frame, as far as it is drawn."""

    def turn(self) -> None:
        """Call once a frame, before anything is drawn."""
        self.told, self.telling = self.telling, ""
