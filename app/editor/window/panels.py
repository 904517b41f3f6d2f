"""Which panels there are, where they dock first, and what lies on top of them."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from ..editor import Editor


def _load(module: str, name: str) -> Any:
    """TEMPORARY while panels are being written."""
    try:
        return getattr(importlib.import_module(module, __package__), name)
    except Exception as error:
        why = f"{type(error).__name__}: {error}"

        class Missing:
            def draw(self, editor: Any) -> None:
                from imgui_bundle import imgui
                if module.startswith(("..canvas", "..viewer", "..inspector")):
                    imgui.text_wrapped(f"{name} is not there yet: {why}")
        return Missing


Canvas = _load("..canvas.canvas", "Canvas")
Inspector = _load("..inspector.inspector", "Inspector")
About = _load("..panels.about", "About")
FileBrowser = _load("..panels.browser", "FileBrowser")
CheatSheet = _load("..panels.cheat_sheet", "CheatSheet")
CommandPalette = _load("..panels.command_palette", "CommandPalette")
HistoryPanel = _load("..panels.history", "HistoryPanel")
LogPanel = _load("..panels.log", "LogPanel")
PreferencesDialog = _load("..panels.preferences", "PreferencesDialog")
Problems = _load("..panels.problems", "Problems")
QuestionDialog = _load("..panels.question", "QuestionDialog")
Renders = _load("..panels.renders", "Renders")
StartScreen = _load("..panels.start", "StartScreen")
Toasts = _load("..panels.toasts", "Toasts")
Scopes = _load("..viewer.scopes_panel", "Scopes")
Viewer = _load("..viewer.viewer", "Viewer")


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
    Docked("Inspector", "Right", Inspector),
    Docked("Scopes", "RightLower", Scopes),
    Docked("History", "RightLower", HistoryPanel),
    Docked("Problems", "RightLower", Problems),
    Docked("Renders", "RightLower", Renders),
    Docked("Log", "RightLower", LogPanel),
)

OVERLAYS: tuple[tuple[str, Callable[[], Panel]], ...] = (
    ("Start", StartScreen), ("Shortcuts", CheatSheet), ("Preferences", PreferencesDialog),
    ("Command palette", CommandPalette), ("Files", FileBrowser), ("About", About), ("Question", QuestionDialog),
    ("Messages", Toasts),
)
