"""The list of panels with their first docks, and of dialogs on top of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from msgspec import Struct

from ..browser.browser import FileBrowser
from ..canvas.canvas import Canvas
from ..code.panel import CodePanel
from ..command_palette.palette import CommandPalette
from ..curves.panel import AnimationPanel
from ..dialogs.about import AboutDialog
from ..dialogs.cheat_sheet import CheatSheet
from ..dialogs.node_page import NodePage
from ..dialogs.panel_page import PanelPage
from ..dialogs.question import QuestionDialog
from ..exporting.dialog import ExportDialog
from ..history.panel import HistoryPanel
from ..inspector.inspector import Inspector
from ..library.dialog import PresetDialog
from ..log.panel import LogPanel
from ..log.toasts import Toasts
from ..matching.window import MatchWindow
from ..passes.panel import PassesPanel
from ..preferences.dialog import PreferencesDialog
from ..problems.panel import ProblemsPanel
from ..renders.panel import RendersPanel
from ..shared.window_commands import PanelTitle
from ..start.screen import StartScreen
from ..tutorials.coach import Coach
from ..viewer.scopes_panel import ScopesPanel
from ..viewer.viewer import Viewer
from .contexts import Contexts


class Panel(Protocol):
    """A panel: draws itself into the current window."""

    def draw(self) -> None: ...


class Docked(Struct, frozen=True):
    """A panel with its title and the dock it starts in. `bare` panels draw up to their borders."""

    title: PanelTitle
    dock: str
    make: Callable[[Contexts], Panel]
    bare: bool = False


DOCKED = (
    Docked(PanelTitle.VIEWER, "MainDockSpace", lambda contexts: Viewer(contexts.viewer), bare=True),
    Docked(PanelTitle.GRAPH, "Lower", lambda contexts: Canvas(contexts.canvas), bare=True),
    Docked(PanelTitle.ANIMATION, "Lower", lambda contexts: AnimationPanel(contexts.curves), bare=True),
    Docked(PanelTitle.CODE, "Lower", lambda contexts: CodePanel(contexts.code)),
    Docked(PanelTitle.PROBLEMS, "Lower", lambda contexts: ProblemsPanel(contexts.problems)),
    Docked(PanelTitle.RENDERS, "Lower", lambda contexts: RendersPanel(contexts.renders)),
    Docked(PanelTitle.LOG, "Lower", lambda contexts: LogPanel(contexts.log)),
    Docked(PanelTitle.INSPECTOR, "Right", lambda contexts: Inspector(contexts.inspector)),
    Docked(PanelTitle.SCOPES, "RightLower", lambda contexts: ScopesPanel(contexts.viewer)),
    Docked(PanelTitle.HISTORY, "RightLower", lambda contexts: HistoryPanel(contexts.history)),
    Docked(PanelTitle.PASSES, "RightLower", lambda contexts: PassesPanel(contexts.passes)),
)

OVERLAYS: tuple[tuple[str, Callable[[Contexts], Panel]], ...] = (
    ("Tutorial", lambda contexts: Coach(contexts.tutorials)),
    ("Start", lambda contexts: StartScreen(contexts.start)),
    ("Shortcuts", lambda contexts: CheatSheet(contexts.dialogs)),
    ("Node", lambda contexts: NodePage(contexts.dialogs)),
    ("Panel", lambda contexts: PanelPage(contexts.dialogs)),
    ("Preferences", lambda contexts: PreferencesDialog(contexts.preferences)),
    ("Export", lambda contexts: ExportDialog(contexts.exporting)),
    ("Match", lambda contexts: MatchWindow(contexts.matching)),
    ("Save as preset", lambda contexts: PresetDialog(contexts.presets)),
    ("Command palette", lambda contexts: CommandPalette(contexts.command_palette)),
    ("Files", lambda contexts: FileBrowser(contexts.browser)),
    ("About", lambda contexts: AboutDialog(contexts.dialogs)),
    ("Question", lambda contexts: QuestionDialog(contexts.dialogs)),
    ("Messages", lambda contexts: Toasts(contexts.log)),
)
