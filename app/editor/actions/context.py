"""What the actions of the Edit, View and Help menus use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

if TYPE_CHECKING:
    from ...authoring.preferences import PreferenceStore
    from ...authoring.session import Session
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import ElementView, SystemText
    from ..shared.window_commands import WindowCommands
    from ..toolkit.context import Interface
    from ..toolkit.services import Services


class EditContext(Struct, frozen=True):
    """The collaborators of the Edit menu."""

    session: Session
    canvas: ElementView
    clipboard: SystemText
    dialogs: Dialogs

    @classmethod
    def compose(cls, services: Services, canvas: ElementView) -> EditContext:
        """Pick what the actions use."""
        return cls(services.session, canvas, services.clipboard, services.dialogs)


class ViewSettingsContext(Struct, frozen=True):
    """The collaborators of the View and Help menus."""

    session: Session
    store: PreferenceStore
    dialogs: Dialogs
    commands: WindowCommands
    interface: Interface

    @classmethod
    def compose(cls, services: Services) -> ViewSettingsContext:
        """Pick what the actions use."""
        return cls(services.session, services.store, services.dialogs, services.commands, services.interface)
