"""One table of everything that can be done: menus, shortcuts, context menus and the command palette read it."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

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

__all__ = ["ACTION_GROUPS", "MENUS", "ActionGroup", "table"]

MENUS = ("File", "Edit", "Graph", "Viewer", "Time", "View", "Help")

ActionGroup = Literal[
    "documents", "edits", "graph", "code", "viewer", "flipbook", "handles", "playback", "animation", "view"
]
"""Actions that work on the same collaborators."""

ACTION_GROUPS: Mapping[ActionGroup, tuple[Action, ...]] = MappingProxyType(
    {
        "documents": DOCUMENTS,
        "edits": EDITS,
        "graph": GRAPH,
        "code": CODE,
        "viewer": VIEWER,
        "flipbook": FLIPBOOK,
        "handles": HANDLES,
        "playback": PLAYBACK,
        "animation": ANIMATION,
        "view": VIEW,
    }
)
"""All actions, in the order of the menus."""


def table() -> tuple[Action, ...]:
    """Every action, in the order of the menus."""
    return tuple(action for group in ACTION_GROUPS.values() for action in group)
