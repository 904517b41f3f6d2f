"""The color settings of the open document."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from ...graph import color_settings

if TYPE_CHECKING:
    from ...authoring.preview.color_fallback import ColorFallback
    from ...authoring.session import Session
    from ...color.management import ColorManager


class ColorContext(Protocol):
    """The context of a panel that shows managed colors."""

    @property
    def session(self) -> Session: ...

    @property
    def coloring(self) -> ColorFallback: ...


def find_color_manager(context: ColorContext) -> ColorManager:
    """The color manager of the document; the built-in one if its config cannot be read."""
    return context.coloring.resolve(color_settings(context.session.root))
