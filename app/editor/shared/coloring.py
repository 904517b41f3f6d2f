"""How the colors of what is open are managed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from halation.nodes import ColorSettings

from ...graph import color_settings

if TYPE_CHECKING:
    from ..window.editor import Editor


def coloring(editor: Editor) -> ColorSettings:
    """The settings of the open document, or of the built-in config where its own cannot be read."""
    return editor.viewer.coloring.of(color_settings(editor.session.root))
