"""Which elements have a place for a thumbnail."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from ...authoring.edits.element_id import ElementId
from ...authoring.edits.elements import Sizes
from .layout import HEADER, PAD, PICTURE

if TYPE_CHECKING:
    from .context import CanvasContext


class ThumbnailSlots(Struct):
    """The elements that have had a thumbnail: its place stays, and an outdated thumbnail is dimmed.

    No picture is ever computed for its own sake, so nodes that became part of a larger step never have one; they look
    whole without.
    """

    _inputs: tuple[object, ...] = ()
    _paths: frozenset[str] = frozenset()
    _keys: frozenset[ElementId] = frozenset()

    def list_elements(self, context: CanvasContext) -> frozenset[ElementId]:
        """These elements in the open group; the same object while nothing changes."""
        enabled, paths = context.store.current.thumbnails, context.preview.thumbnails
        place = context.session.place
        if self._inputs != (enabled, place) or self._paths is not paths:
            self._inputs, self._paths = (enabled, place), paths
            prefix = "".join(f"{id}/" for id in place)
            inside = (path.removeprefix(prefix) for path in paths if path.startswith(prefix))
            self._keys = frozenset(ElementId(key) for key in inside if "/" not in key) if enabled else frozenset()
        return self._keys


def reserve_pictures(context: CanvasContext) -> Sizes:
    """The sizes of all elements as if every open node had its picture: room for those that come later."""
    sizes = context.canvas.sizes or {}
    if not context.store.current.thumbnails:
        return sizes
    keys, nodes = ThumbnailSlots().list_elements(context), context.session.graph.nodes
    return {
        key: (width, height + PICTURE + PAD / 2)
        if key in nodes and key not in keys and height > HEADER
        else (width, height)
        for key, (width, height) in sizes.items()
    }
