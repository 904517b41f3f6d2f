"""The pictures of frames that are played, as the viewer has drawn them: in the next loop they are only shown again.

To draw a picture through a view takes longer than all panels together where no GPU does it, and a loop shows the same
pictures again and again. So while frames are played or scrubbed, each has a slot of the display of its own. The display
itself draws a slot anew if something else than the frame has changed, such as the exposure.
"""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...renderer import Display

SHARE = 0.25
"""The part of the memory budget that drawn pictures may take: frames themselves take half of it."""

STILL = "viewer"
"""The slot of a picture that stands."""


class PlayedPictures:
    """Slots of the display by what they show; those that were not shown for longest are used again."""

    def __init__(self, display: Display) -> None:
        self._display = display
        self._slots: dict[object, str] = {}
        self._numbers = count()

    def choose_slot(self, contents: object, size: tuple[int, int], budget: int) -> str:
        """The slot for a picture of `size` pixels while frames are played; `budget` is all memory, in bytes."""
        slot = self._slots.pop(contents, None)
        if slot is None:
            most = max(int(budget * SHARE) // (4 * size[0] * size[1]), 1)
            while len(self._slots) > most:
                self._display.release_slot(self._slots.pop(next(iter(self._slots))))
            is_full = len(self._slots) == most
            slot = self._slots.pop(next(iter(self._slots))) if is_full else f"{STILL} {next(self._numbers)}"
        self._slots[contents] = slot
        return slot

    def clear(self) -> None:
        """Give all slots back."""
        for slot in self._slots.values():
            self._display.release_slot(slot)
        self._slots.clear()
