"""The color settings of the open document."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from halation.nodes import ColorSettings

from ...graph import color_settings

if TYPE_CHECKING:
    from ...authoring.preview.color_fallback import ColorFallback
    from ...authoring.session import Session


class ColorContext(Protocol):
    """The context of a panel that shows managed colors."""

    @property
    def session(self) -> Session: ...

    @property
    def coloring(self) -> ColorFallback: ...


def settings_in_use(context: ColorContext) -> ColorSettings:
    """The color settings of the document, or of the built-in config where its own cannot be read."""
    return context.coloring.resolve(color_settings(context.session.root))
