"""What panels and actions ask the window to do; it does so before the next frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum


class PanelTitle(StrEnum):
    """Titles of the panels that can be docked, as they stand on their tabs."""

    VIEWER = "Viewer"
    GRAPH = "Graph"
    ANIMATION = "Animation"
    CODE = "Code"
    PROBLEMS = "Problems"
    RENDERS = "Renders"
    LOG = "Log"
    INSPECTOR = "Inspector"
    SCOPES = "Scopes"
    HISTORY = "History"


@dataclass
class WindowCommands:
    """What the window is asked to do. Whoever serves a command takes it back."""

    closing: bool = False
    """True lets the window close."""
    resets_layout: bool = False
    saves_screenshot: bool = False
    panels: list[PanelTitle] = field(default_factory=list[PanelTitle])
    """Panels to show and to bring to the front."""

    def show_panel(self, title: PanelTitle) -> None:
        """Show a panel, in front of those in the same dock."""
        self.panels.append(title)

    def reset_layout(self) -> None:
        """Show all panels where they are at first."""
        self.resets_layout = True

    def save_screenshot(self) -> None:
        """Ask for a file, and write the window into it as a picture."""
        self.saves_screenshot = True

    def close(self) -> None:
        """Close the window; the user has agreed to lose what is not saved."""
        self.closing = True
