"""Requests of panels and actions to the window, which serves them before the next frame."""

from __future__ import annotations

from enum import StrEnum
from typing import Literal

from msgspec import Struct, field

LayoutName = Literal["composite", "beside", "code", "animate", "review"]
"""Layouts of panels by what the user does; "beside" has the graph beside the viewer."""


class PanelTitle(StrEnum):
    """The titles of the panels, as on their tabs."""

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
    PASSES = "Passes"


class WindowCommands(Struct):
    """The open requests to the window, which removes each when it is served."""

    closing: bool = False
    """True lets the window close."""
    layout: LayoutName | None = None
    """The layout of panels to apply."""
    saves_screenshot: bool = False
    maximizes: PanelTitle | None = None
    """The panel that is to fill the window, or no longer."""
    maximizes_pointed: bool = False
    """True lets the panel under the pointer fill the window, or no longer."""
    toggles_full_screen: bool = False
    """True lets the viewer fill the screen, or no longer."""
    panels: list[PanelTitle] = field(default_factory=list[PanelTitle])
    """Panels to show and to bring to the front."""

    def show_panel(self, title: PanelTitle) -> None:
        """Show a panel, in front of those in the same dock."""
        self.panels.append(title)

    def apply_layout(self, name: LayoutName) -> None:
        """Move all panels to their places in a layout."""
        self.layout = name

    def maximize(self, title: PanelTitle) -> None:
        """Let a panel fill the window, or show the others again."""
        self.maximizes = title

    def maximize_pointed(self) -> None:
        """Let the panel under the pointer fill the window, or show the others again."""
        self.maximizes_pointed = True

    def toggle_full_screen(self) -> None:
        """Let the viewer fill the screen, without menus, or go back to the window."""
        self.toggles_full_screen = True

    def save_screenshot(self) -> None:
        """Ask for a file, and write the window into it as a picture."""
        self.saves_screenshot = True

    def close(self) -> None:
        """Close the window; the user has agreed to lose what is not saved."""
        self.closing = True
