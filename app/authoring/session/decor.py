"""Frames, comments and dots."""

from __future__ import annotations

from ...errors import GraphError
from ...graph import Port
from ..edits import decor, naming, routes
from ..edits.elements import Place, Sizes, clean_text, entries
from .state import State


class Decor(State):
    """What makes a graph readable and changes no pixel."""

    def add_frame(self, title: str = "", at: Place | None = None, sizes: Sizes | None = None) -> str:
        """A frame around the selection, or at `at`; returns its id."""
        around = () if at is not None else self.selection
        graph, id = decor.add_frame(self.graph, around, self.positions, title, at or (0.0, 0.0), sizes)
        self.edit(
            f"Frame {title or naming.describe_elements(around)}" if around else "Add frame", graph, (f"frames.{id}",)
        )
        return id

    def set_frame(
        self, id: str, title: str | None = None, color: tuple[float, float, float] | None = None, merge: str = ""
    ) -> None:
        """Set the title or the display-referred color (0 to 1) of a frame; None leaves it."""
        facts: dict[str, object] = {}
        if title is not None:
            facts["title"] = clean_text(title)
        if color is not None:
            facts["color"] = tuple(round(float(part), 4) for part in color)
        self.edit("Edit frame", decor.set_facts(self.graph, f"frames.{id}", **facts), merge=merge)

    def resize_frame(self, id: str, x: float, y: float, width: float, height: float, merge: str = "") -> None:
        """Give a frame another rectangle."""
        self._resize(f"frames.{id}", x, y, width, height, merge)

    def frame_members(self, id: str, sizes: Sizes | None = None) -> frozenset[str]:
        """The elements inside a frame."""
        return decor.find_frame_members(self.graph, id, self.positions, sizes)

    def add_comment(self, at: Place, text: str = "") -> str:
        """A comment at that place; returns its id."""
        graph, id = decor.add_comment(self.graph, at, text)
        self.edit("Add comment", graph, (f"comments.{id}",))
        return id

    def set_comment(self, id: str, text: str, merge: str = "") -> None:
        """Write something else in a comment."""
        self.edit("Edit comment", decor.set_facts(self.graph, f"comments.{id}", text=clean_text(text)), merge=merge)

    def resize_comment(self, id: str, x: float, y: float, width: float, merge: str = "") -> None:
        """Put a comment somewhere and make it as wide; it is as high as its text."""
        self._resize(f"comments.{id}", x, y, width, 0.0, merge)

    def add_dot(self, target: Port, at: Place) -> str:
        """A dot on the link that feeds `target`; returns its id."""
        graph, id = routes.add_dot(self.graph, target, at)
        self.edit("Add dot", graph, (f"dots.{id}",))
        return id

    def join_dot(self, id: str, target: Port) -> None:
        """Let the link that feeds `target` pass a dot of another link from the same source."""
        self.edit("Join dot", routes.join_dot(self.graph, id, target))

    def remove_dot(self, id: str) -> None:
        """Remove a dot; its links go on."""
        if id not in entries(self.graph, "dots"):
            raise GraphError(f"there is no dot '{id}'")
        self.edit("Remove dot", routes.remove_dots(self.graph, [id]))

    def _resize(self, key: str, x: float, y: float, width: float, height: float, merge: str) -> None:
        graph = decor.set_facts(self.graph, key)
        self.edit(f"Resize {key.partition('.')[0][:-1]}", decor.set_box(graph, key, x, y, width, height), merge=merge)
