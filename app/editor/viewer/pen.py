"""The pen: what of splines is selected on the picture, and what is being drawn."""

from __future__ import annotations

from dataclasses import dataclass

from halation.nodes import Row


@dataclass
class SplinePen:
    """The state of drawing splines with the mouse."""

    is_drawing: bool = False
    """True while clicks on the picture set points."""
    shape: str = ""
    """The points that grow with each click, as `node.value.shape.points`; "" before the first one."""
    pending: Row | None = None
    """The point that is set when the mouse button is released."""
    selection: tuple[str, int] = ("", -1)
    """The selected point: the points as `node.value.shape.points`, and its number."""

    def begin(self) -> None:
        """Start a new shape."""
        self.is_drawing, self.shape, self.pending, self.selection = True, "", None, ("", -1)

    def find_point(self, points: str) -> int:
        """The number of the selected point among these points; -1 if it is one of another shape."""
        return self.selection[1] if self.selection[0] == points else -1

    def end(self) -> None:
        """Stop drawing; the shape stays as it is."""
        self.is_drawing, self.shape, self.pending = False, "", None
