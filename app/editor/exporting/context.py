"""What the export dialog uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.session import Session
    from ..shared.dialogs import Dialogs
    from ..toolkit.services import Services


class ExportContext(PanelContext, frozen=True):
    """The collaborators of the dialog."""

    session: Session
    dialogs: Dialogs

    @classmethod
    def compose(cls, services: Services) -> ExportContext:
        """Pick what the dialog uses."""
        return cls(services.interface, services.log, services.session, services.dialogs)
