"""Lists of named items, such as shapes and strokes, that are worked on in the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...graph import Port, Unknown, signature

if TYPE_CHECKING:
    from halation.nodes import Items

    from .context import ViewerContext


def find_item_lists(context: ViewerContext, declared: Items) -> tuple[Port, ...]:
    """The values of the active node that hold such items; none while handles are hidden."""
    session = context.session
    item = session.graph.nodes.get(session.active)
    if not context.viewer.has_gizmos or item is None or isinstance(item, Unknown):
        return ()
    values = signature(item).values.items()
    return tuple(Port(session.active, name) for name, value in values if value.items is declared)


def find_item_list(context: ViewerContext, declared: Items) -> Port | None:
    """The first of these values, or None."""
    return next(iter(find_item_lists(context, declared)), None)
