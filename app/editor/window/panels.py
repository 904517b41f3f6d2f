"""Which panels there are, where they dock first, and what lies on top of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from ..browser.browser import FileBrowser
from ..canvas.canvas import Canvas
from ..code.panel import CodePanel
from ..command_palette.palette import CommandPalette
from ..curves.panel import Animation
from ..dialogs.about import About
from ..dialogs.cheat_sheet import CheatSheet
from ..dialogs.question import QuestionDialog
from ..history.panel import HistoryPanel
from ..inspector.inspector import Inspector
from ..log.panel import LogPanel
from ..log.toasts import Toasts
from ..preferences.dialog import PreferencesDialog
from ..problems.panel import Problems
from ..renders.panel import Renders
from ..start.screen import StartScreen
from ..viewer.scopes_panel import Scopes
from ..viewer.viewer import Viewer
from .editor import Editor


class Panel(Protocol):
    """Something that draws itself into the window it is given."""

    def draw(self, editor: Editor) -> None: ...


@dataclass(frozen=True)
class Docked:
    """A panel with its title and the dock it starts in. `bare` panels draw up to their borders."""

    title: str
    dock: str
    make: Callable[[], Panel]
    bare: bool = False


DOCKED = (
    Docked("Viewer", "MainDockSpace", Viewer, bare=True),
    Docked("Graph", "Lower", Canvas, bare=True),
    Docked("Animation", "Lower", Animation, bare=True),
    Docked("Code", "Lower", CodePanel),
    Docked("Problems", "Lower", Problems),
    Docked("Renders", "Lower", Renders),
    Docked("Log", "Lower", LogPanel),
    Docked("Inspector", "Right", Inspector),
    Docked("Scopes", "RightLower", Scopes),
    Docked("History", "RightLower", HistoryPanel),
)

STAGED = frozenset({"Viewer", "Timeline", "Scopes"})
"""What shows a flipbook in place of the document while one is open."""

OVERLAYS: tuple[tuple[str, Callable[[], Panel]], ...] = (
    ("Start", StartScreen),
    ("Shortcuts", CheatSheet),
    ("Preferences", PreferencesDialog),
    ("Command palette", CommandPalette),
    ("Files", FileBrowser),
    ("About", About),
    ("Question", QuestionDialog),
    ("Messages", Toasts),
)
