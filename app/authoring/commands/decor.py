"""Commands for frames, comments and dots: what makes a graph readable and changes no pixel."""

from __future__ import annotations

from ...errors import GraphError
from ...graph import Port
from ...language.translation import translate
from ..edits import decor, naming, routes
from ..edits.element_id import ElementId
from ..edits.elements import Place, Sizes, clean_text, list_decor
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited


class AddFrame(EditCommand[ElementId], frozen=True):
    """Add a frame around the selection, or at `at`; returns its id."""

    title: str = ""
    at: Place | None = None
    sizes: Sizes | None = None

    def apply(self, document: OpenDocument) -> Edited[ElementId]:
        around = () if self.at is not None else document.selection
        at = self.at or (0.0, 0.0)
        graph, frame = decor.add_frame(document.graph, around, document.positions, self.title, at, self.sizes)
        label = (
            translate("Frame {title}", title=self.title or naming.describe_elements(around))
            if around
            else translate("Add frame")
        )
        return Edited(label, frame, graph, (frame,))


class EditFrame(EditCommand[None], frozen=True):
    """Set the title or the display-referred color (0 to 1) of a frame; None leaves it."""

    frame: ElementId
    title: str | None = None
    color: tuple[float, float, float] | None = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        facts: dict[str, object] = {}
        if self.title is not None:
            facts["title"] = clean_text(self.title)
        if self.color is not None:
            facts["color"] = tuple(round(float(part), 4) for part in self.color)
        graph = decor.set_facts(document.graph, self.frame, **facts)
        return Edited(translate("Edit frame"), None, graph, merge=self.merge)


class ResizeFrame(EditCommand[None], frozen=True):
    """Set the rectangle of a frame."""

    frame: ElementId
    x: float
    y: float
    width: float
    height: float
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = decor.set_box(
            decor.set_facts(document.graph, self.frame), self.frame, self.x, self.y, self.width, self.height
        )
        return Edited(translate("Resize frame"), None, graph, merge=self.merge)


class AddComment(EditCommand[ElementId], frozen=True):
    """Add a comment at a position; returns its id."""

    at: Place
    text: str = ""

    def apply(self, document: OpenDocument) -> Edited[ElementId]:
        graph, comment = decor.add_comment(document.graph, self.at, self.text)
        return Edited(translate("Add comment"), comment, graph, (comment,))


class EditComment(EditCommand[None], frozen=True):
    """Set the text of a comment."""

    comment: ElementId
    text: str
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = decor.set_facts(document.graph, self.comment, text=clean_text(self.text))
        return Edited(translate("Edit comment"), None, graph, merge=self.merge)


class ResizeComment(EditCommand[None], frozen=True):
    """Set the position and the width of a comment; its height follows from its text."""

    comment: ElementId
    x: float
    y: float
    width: float
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = decor.set_box(
            decor.set_facts(document.graph, self.comment), self.comment, self.x, self.y, self.width, 0.0
        )
        return Edited(translate("Resize comment"), None, graph, merge=self.merge)


class AddDot(EditCommand[ElementId], frozen=True):
    """Add a dot on the link to `target`; returns its id."""

    target: Port
    at: Place

    def apply(self, document: OpenDocument) -> Edited[ElementId]:
        graph, dot = routes.add_dot(document.graph, self.target, self.at)
        return Edited(translate("Add dot"), dot, graph, (dot,))


class JoinDot(EditCommand[None], frozen=True):
    """Route the link to `target` through a dot of another link from the same source."""

    dot: ElementId
    target: Port

    def apply(self, document: OpenDocument) -> Edited[None]:
        return Edited(translate("Join dot"), None, routes.join_dot(document.graph, self.dot, self.target))


class RemoveDot(EditCommand[None], frozen=True):
    """Remove a dot; its links go on."""

    dot: ElementId

    def apply(self, document: OpenDocument) -> Edited[None]:
        if self.dot not in list_decor(document.graph, "dot"):
            raise GraphError(translate("there is no dot '{name}'", name=self.dot.name))
        return Edited(translate("Remove dot"), None, routes.remove_dots(document.graph, [self.dot]))
