"""Which elements have a place for a picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...authoring.edits.elements import Sizes
from .layout import HEADER, PAD, PICTURE

if TYPE_CHECKING:
    from .context import CanvasContext


@dataclass
class ThumbnailSlots:
    """Those that had a picture once: its place stays, and what it shows is dimmed while it is out of date.

    No picture is ever computed for its own sake, so nodes that became part of a larger step never have one; they look
    whole without.
    """

    _of: tuple[object, ...] = ()
    _paths: frozenset[str] = frozenset()
    _keys: frozenset[str] = frozenset()

    def of(self, context: CanvasContext) -> frozenset[str]:
        """Keys of those at the session's place; the same object while they stay the same."""
        wanted, paths = context.store.current.thumbnails, context.preview.thumbnails
        place = context.session.place
        if self._of != (wanted, place) or self._paths is not paths:
            self._of, self._paths = (wanted, place), paths
            prefix = "".join(f"{id}/" for id in place)
            inside = (path.removeprefix(prefix) for path in paths if path.startswith(prefix))
            self._keys = frozenset(key for key in inside if "/" not in key) if wanted else frozenset()
        return self._keys


def with_room(context: CanvasContext) -> Sizes:
    """The sizes of all elements as if every open node had its picture: room for those that come later."""
    sizes = context.canvas.sizes or {}
    if not context.store.current.thumbnails:
        return sizes
    known, nodes = ThumbnailSlots().of(context), context.session.graph.nodes
    return {
        key: (width, height + PICTURE + PAD / 2)
        if key in nodes and key not in known and height > HEADER
        else (width, height)
        for key, (width, height) in sizes.items()
    }
