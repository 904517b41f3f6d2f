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
    """The shape that grows with each click; "" before the first one."""
    pending: Row | None = None
    """The point that is set when the mouse button is released."""
    point: int = -1
    """The selected point of the selected shape; -1 for none."""

    def begin(self) -> None:
        """Start a new shape."""
        self.is_drawing, self.shape, self.pending, self.point = True, "", None, -1

    def end(self) -> None:
        """Stop drawing; the shape stays as it is."""
        self.is_drawing, self.shape, self.pending = False, "", None
