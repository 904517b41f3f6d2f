"""What the file browser uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.preferences import PreferenceStore
    from ...authoring.session import Session
    from ..shared.dialogs import Dialogs
    from ..toolkit.services import Services


class BrowserContext(PanelContext, frozen=True):
    """The collaborators of the file browser."""

    session: Session
    store: PreferenceStore
    dialogs: Dialogs

    @classmethod
    def compose(cls, services: Services) -> BrowserContext:
        """Pick what the panel uses."""
        return cls(services.interface, services.log, services.session, services.store, services.dialogs)
