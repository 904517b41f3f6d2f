"""The panel that the keyboard led to: keys go there, wherever the pointer rests, until the mouse is used again."""

from __future__ import annotations

from imgui_bundle import imgui

from ..shared.window_commands import PanelTitle

_STILL = 3.0
"""Pixels that a mouse may move while nobody holds it."""


class WalkedPanel:
    """Follows Ctrl+Tab, which leads from panel to panel; to be asked once in each frame."""

    def __init__(self) -> None:
        self._is_choosing = False
        self._panel: PanelTitle | None = None
        self._rest = (0.0, 0.0)

    def follow(self) -> PanelTitle | None:
        """The panel that was chosen last; None once the mouse has been moved or pressed."""
        context, mouse = imgui.get_current_context(), imgui.get_io().mouse_pos
        was_choosing, self._is_choosing = self._is_choosing, context.nav_windowing_target is not None
        if was_choosing and not self._is_choosing and context.nav_window is not None:
            name = context.nav_window.root_window.name.rpartition("###")[2]
            self._panel = next((title for title in PanelTitle if title == name), None)
            self._rest = mouse.x, mouse.y
        has_moved = abs(mouse.x - self._rest[0]) + abs(mouse.y - self._rest[1]) > _STILL
        if has_moved or any(map(imgui.is_mouse_down, range(3))):
            self._panel = None
        return self._panel
