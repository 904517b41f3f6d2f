"""One table of everything that can be done: menus, shortcuts, context menus and the command palette read it."""

from __future__ import annotations

from ..canvas.actions import GRAPH
from ..curves.actions import ANIMATION
from ..shared.action import Action
from ..timeline.actions import PLAYBACK
from ..viewer.actions import VIEWER
from ..viewer.handle_actions import HANDLES
from ..workflows.code_files import CODE
from ..workflows.documents import DOCUMENTS
from ..workflows.flipbook import FLIPBOOK
from .edits import EDITS
from .view import VIEW

__all__ = ["MENUS", "table"]

MENUS = ("File", "Edit", "Graph", "Viewer", "Time", "View", "Help")


def table() -> tuple[Action, ...]:
    """Every action, in the order of the menus."""
    return (*DOCUMENTS, *EDITS, *GRAPH, *CODE, *VIEWER, *FLIPBOOK, *HANDLES, *PLAYBACK, *ANIMATION, *VIEW)
