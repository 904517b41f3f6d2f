"""What the actions of the Edit, View and Help menus use."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...authoring.preferences import PreferenceStore
    from ...authoring.session import Session
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import ElementView, SystemText
    from ..shared.window_commands import WindowCommands
    from ..toolkit.context import Interface
    from ..toolkit.services import Services


@dataclass(frozen=True)
class EditContext:
    """The collaborators of the Edit menu."""

    session: Session
    canvas: ElementView
    clipboard: SystemText
    dialogs: Dialogs

    @classmethod
    def compose(cls, services: Services, canvas: ElementView) -> EditContext:
        """Pick what the actions use."""
        return cls(services.session, canvas, services.clipboard, services.dialogs)


@dataclass(frozen=True)
class ViewSettingsContext:
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
