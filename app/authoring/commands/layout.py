"""Commands that move, line up and arrange elements; no pixel of a picture changes."""

from __future__ import annotations

from collections.abc import Iterable

from ...language.translation import translate
from ..edits import align, arranging, elements, naming
from ..edits.element_id import ElementId
from ..edits.elements import Sizes
from ..edits.pins import Pins
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited


class MoveElements(EditCommand[None], frozen=True):
    """Move elements by a distance."""

    elements: Iterable[ElementId]
    dx: float
    dy: float
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        places = {key: document.position(key) for key in self.elements}
        moved = {key: (x + self.dx, y + self.dy) for key, (x, y) in places.items()}
        graph = elements.with_places(document.graph, moved)
        return Edited(
            translate("Move {elements}", elements=naming.describe_elements(places)), None, graph, merge=self.merge
        )


class PlaceElement(EditCommand[None], frozen=True):
    """Put an element somewhere."""

    element: ElementId
    x: float
    y: float
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        document.position(self.element)
        graph = elements.with_places(document.graph, {self.element: (self.x, self.y)})
        return Edited(translate("Move {element}", element=self.element), None, graph, merge=self.merge)


class AlignSelection(EditCommand[None], frozen=True):
    """Line up the selection: `left`, `right`, `top`, `bottom`, `center x`, `center y`, or `distribute x` or `y`."""

    side: str
    sizes: Sizes | None = None

    def apply(self, document: OpenDocument) -> Edited[None]:
        chosen = [key for key in document.elements if key in document.selection]
        places = align.align_elements(document.graph, chosen, self.side, document.positions, self.sizes)
        return Edited(
            translate("Align: {side}", side=translate(self.side, "alignment")),
            None,
            elements.with_places(document.graph, places),
        )


class ArrangeElements(EditCommand[None], frozen=True):
    """Lay out the selection, or everything if less than two nodes are selected."""

    sizes: Sizes | None = None
    pins: Pins | None = None

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        chosen = {key for key in document.selection if elements.can_be_linked(key, graph)}
        part = chosen if len(chosen) > 1 else None
        graph = arranging.arrange(graph, part, document.positions, self.sizes, self.pins)
        return Edited(translate("Arrange"), None, graph)
