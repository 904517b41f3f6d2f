"""Handles: positions of the active node that can be dragged on the picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from ...graph import Port, Unknown, signature
from .focus import is_idle
from .geometry import Point

if TYPE_CHECKING:
    from ...authoring.session import Session
    from .context import ViewerContext
    from .state import ViewerState


@dataclass(frozen=True)
class ViewerHandle:
    """A value that is a position, as a fraction of the picture."""

    port: Port
    at: Point


def handles(context: ViewerContext) -> tuple[ViewerHandle, ...]:
    """The handles of the active node that have an effect and are not linked; none while they are hidden."""
    session = context.session
    if not context.viewer.has_gizmos:
        return ()
    item = session.graph.nodes.get(session.active)
    if item is None or isinstance(item, Unknown):
        return ()
    free_handles: list[ViewerHandle] = []
    for name, value in signature(item).values.items():
        port = Port(session.active, name)
        if value.handle and session.graph.links.get(port) is None and not is_idle(session, port):
            x, y = cast("Point", session.time.evaluated_graph.value(port))
            free_handles.append(ViewerHandle(port, (x, y)))
    return tuple(free_handles)


def takes_position(session: Session, port: Port) -> bool:
    """True if the eyedropper picks a position for a value, not a color."""
    item = session.graph.nodes.get(port.node)
    value = None if item is None or isinstance(item, Unknown) else signature(item).values.get(port.socket)
    return value is not None and value.handle


def pixel_place(viewer: ViewerState) -> Point:
    """The middle of the pixel under the pointer, as a fraction of the picture."""
    assert viewer.pixel is not None
    (x, y), (width, height) = viewer.pixel, viewer.picture
    return round((x + 0.5) / max(width, 1), 5), round((y + 0.5) / max(height, 1), 5)
