"""The pen: what of splines is selected on the picture, and what is being drawn."""

from __future__ import annotations

from collections.abc import Mapping, Set

from halation.nodes import Row
from msgspec import Struct, field

from .geometry import Point

_NONE: tuple[str, Set[int]] = ("", frozenset())


class SplinePen(Struct):
    """The state of drawing splines with the mouse."""

    is_drawing: bool = False
    """True while clicks on the picture set points."""
    shape: str = ""
    """The points that grow with each click, as `node.value.shape.points`; "" before the first one."""
    pending: Row | None = None
    """The point that is set when the mouse button is released."""
    selection: tuple[str, Set[int]] = _NONE
    """The selected points: those of a shape as `node.value.shape.points`, and their numbers."""
    lasso: list[Point] = field(default_factory=list[Point])
    """The line that is drawn around points, as fractions of the picture."""
    ripples: bool = False
    """True if an edit of points at a frame is made at all of their keys."""
    singly: bool = False
    """True if an edit of points that have keys sets keys of these points alone."""
    copied: Mapping[int, Row] = field(default_factory=dict[int, Row])
    """The points that were copied, by their numbers."""

    def begin(self) -> None:
        """Start a new shape."""
        self.is_drawing, self.shape, self.pending, self.selection = True, "", None, _NONE

    def find_points(self, points: str) -> Set[int]:
        """The numbers of the selected points among these; none if those of another shape are selected."""
        return self.selection[1] if self.selection[0] == points else frozenset()

    def end(self) -> None:
        """Stop drawing; the shape stays as it is."""
        self.is_drawing, self.shape, self.pending = False, "", None
