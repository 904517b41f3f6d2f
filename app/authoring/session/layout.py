"""Where elements lie."""

from __future__ import annotations

from collections.abc import Iterable

from ...errors import GraphError
from ..edits import align, arranging, elements, naming
from ..edits.elements import Place, Sizes
from .state import State


class Layout(State):
    """Moving, lining up and arranging; no pixel of a picture changes."""

    def position(self, key: str) -> Place:
        """Where an element lies. Raises GraphError if there is none."""
        if key not in self.positions:
            raise GraphError(f"there is no '{key}' on the canvas")
        return self.positions[key]

    def move(self, keys: Iterable[str], dx: float, dy: float, merge: str = "") -> None:
        """Move elements by a distance; equal `merge` tokens in a row make one step."""
        spots = {key: self.position(key) for key in keys}
        self._place(
            f"Move {naming.describe_elements(spots)}", {key: (x + dx, y + dy) for key, (x, y) in spots.items()}, merge
        )

    def place_at(self, key: str, x: float, y: float, merge: str = "") -> None:
        """Put an element somewhere."""
        self.position(key)
        self._place(f"Move {key}", {key: (x, y)}, merge)

    def align(self, side: str, sizes: Sizes | None = None) -> None:
        """Line up the selection: `left`, `right`, `top`, `bottom`, `center x`, `center y`, or `distribute x` or `y`."""
        some = [key for key in self.elements if key in self.selection]
        self._place(f"Align {side}", align.align_elements(self.graph, some, side, self.positions, sizes))

    def arrange(self, sizes: Sizes | None = None) -> None:
        """Lay out the selection, or everything if less than two nodes are selected."""
        some = {key for key in self.selection if elements.can_be_linked(key, self.graph)}
        graph = arranging.arrange(self.graph, some if len(some) > 1 else None, self.positions, sizes)
        self.edit("Arrange", graph)

    def _place(self, label: str, places: dict[str, Place], merge: str = "") -> None:
        self.edit(label, elements.with_places(self.graph, places), merge=merge)
