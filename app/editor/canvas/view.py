"""The view of the canvas, and requests to the canvas."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Literal

from msgspec import Struct

from ...authoring.edits.element_id import NO_ELEMENT, ElementId
from ...authoring.edits.elements import Sizes
from ...authoring.edits.pins import Pins

MIN_ZOOM, MAX_ZOOM = 0.08, 4.0

Tool = Literal["", "cut", "dot"]


class CanvasView(Struct):
    """Pan and zoom of the canvas. `center` is the canvas position in the middle of the panel."""

    center: tuple[float, float] = (0.0, 0.0)
    zoom: float = 1.0
    pending_fit: Collection[ElementId] | None = ()
    """Elements to fit into the view in the next frame: empty means all, None nothing."""
    least_zoom: float = MIN_ZOOM
    """The smallest zoom of the last fit."""
    pending_reveal: Collection[ElementId] = ()
    """Elements that must be in view in the next frame; the view moves no further than it needs to."""
    pointer: tuple[float, float] = (0.0, 0.0)
    """The canvas position under the mouse when it was last over the panel: where new things go."""
    sizes: Sizes | None = None
    """Width and height of elements as drawn last, in canvas units."""
    find_pins: Callable[[], Pins] = dict
    """How far below the tops of elements their sockets were drawn last, in canvas units; found when it is asked for."""
    hovered: bool = False
    """True while the mouse is over the canvas."""
    panning: bool = False
    """True while the view follows the mouse."""
    searching: bool = False
    """True asks the canvas to open the search at the pointer."""
    replacing: str = ""
    """A node to replace: the canvas opens the search for it."""
    tool: Tool = ""
    """What the next drag with the left button does instead of selecting: cut links, or put dots on them."""
    renaming: ElementId = NO_ELEMENT
    """An element to rename: the canvas opens a text field on it."""

    refusal: str = ""
    """Why the dragged link does not fit the socket under the pointer."""

    def fit(self, elements: Collection[ElementId] = (), least_zoom: float = MIN_ZOOM) -> None:
        """Fit the view to elements; none means all. Of what is too large for a zoom, the upper left part is shown."""
        self.pending_fit, self.least_zoom = elements, least_zoom

    def reveal(self, elements: Collection[ElementId]) -> None:
        """Move the view until elements can be seen."""
        self.pending_reveal = elements
