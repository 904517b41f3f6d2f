"""One table of everything that can be done: menus, shortcuts, context menus and the command palette read it."""

from __future__ import annotations

from ..action import Action
from .animation import ANIMATION
from .code import CODE
from .documents import DOCUMENTS
from .edits import EDITS
from .flipbook import FLIPBOOK
from .graph import GRAPH
from .handles import HANDLES
from .playback import PLAYBACK
from .view import VIEW
from .viewer import VIEWER

__all__ = ["MENUS", "table"]

MENUS = ("File", "Edit", "Graph", "Viewer", "Time", "View", "Help")


def table() -> tuple[Action, ...]:
    """Every action, in the order of the menus."""
    return (*DOCUMENTS, *EDITS, *GRAPH, *CODE, *VIEWER, *FLIPBOOK, *HANDLES, *PLAYBACK, *ANIMATION, *VIEW)
