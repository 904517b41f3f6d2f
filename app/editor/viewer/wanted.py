"""What the viewer wants to be computed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...graph import INPUTS, Port
from .ground import depths

if TYPE_CHECKING:
    from ..editor import Editor

A, B = "A", "B"


def layer(name: str) -> str:
    """Under which name the values of a graph input are wanted."""
    return f"{INPUTS}.{name}"


def effective_scale(editor: Editor) -> float:
    """The chosen proxy, or a coarser one while a value is being dragged and pictures come too slowly."""
    viewer = editor.viewer
    return viewer.pace.at(viewer.proxy, editor.dragging and editor.store.now.proxy_while_dragging)


def wanted(editor: Editor) -> tuple[dict[str, Port], float]:
    """What panels show by name, as ports of the graph that one is in, and the scale to compute it at.

    That is A, B where it is compared with, every input of the graph while their values are shown, and what says how far
    away things are where a handle asks for that.
    """
    session, viewer = editor.session, editor.viewer
    sides = (A, B) if viewer.compares else (A,)
    found = {side: port for side in sides if (port := session.viewed(side)) is not None}
    if viewer.table:
        found |= {layer(name): Port(INPUTS, name) for name in session.graph.inputs}
    return found | depths(editor), effective_scale(editor)
