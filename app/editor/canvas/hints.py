"""What the canvas says while there is nothing else to look at: in an empty graph, and while a tool waits for a drag."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...language.translation import translate
from ..toolkit.keys import display_shortcut
from .view import Tool

if TYPE_CHECKING:
    from .context import CanvasContext


def hint_at_beginning(context: CanvasContext) -> tuple[str, ...]:
    """The lines of an empty graph."""
    keys = display_shortcut(context.actions.shortcut("node.add"))
    return (
        translate("An empty graph"),
        translate("{keys} adds a node", keys=keys),
        translate("Drop a picture or a graph file here"),
    )


def explain_tool(tool: Tool) -> str:
    """What a tool asks for."""
    if tool == "cut":
        return translate("Drag across links to cut them. Escape cancels.")
    return translate("Drag across links to put dots on them. Escape cancels.")
