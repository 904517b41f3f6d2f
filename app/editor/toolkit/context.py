"""The base of panel contexts: what every panel uses."""

from __future__ import annotations

from msgspec import Struct, field

from ...authoring.log import Log
from ...authoring.preferences import PreferenceStore
from ..shared.window_commands import PanelTitle
from ..theme.fonts import Fonts
from ..theme.palette import PALETTES, Palette
from .places import Rect


class Interface(Struct):
    """How the window looks, where its widgets are, and whether the user drags a value in it."""

    store: PreferenceStore
    fonts: Fonts | None = None
    places: dict[str, Rect] = field(default_factory=dict[str, Rect])
    """Where widgets were drawn last, by name: for tests and hints."""
    pointed_panel: PanelTitle | None = None
    """The panel that keys go to: the one under the pointer, or the one that Ctrl+Tab led to since it moved."""
    walked_panel: PanelTitle | None = None
    """The panel that Ctrl+Tab led to, until the mouse moves or is pressed."""
    dragging: bool = False
    """True while the user drags a value: pictures may be coarse until the mouse button is released."""

    @property
    def palette(self) -> Palette:
        """The colors of the theme that the user chose."""
        return PALETTES[self.store.current.theme]


class PanelContext(Struct, frozen=True):
    """The base of what panels receive: each panel adds the collaborators that it uses, and no others."""

    interface: Interface
    log: Log

    @property
    def palette(self) -> Palette:
        """The colors of the theme."""
        return self.interface.palette

    @property
    def places(self) -> dict[str, Rect]:
        """Where widgets were drawn last, by name."""
        return self.interface.places

    @property
    def fonts(self) -> Fonts | None:
        """The fonts; None until the window has loaded them."""
        return self.interface.fonts
