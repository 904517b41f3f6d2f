"""What the window *Match* uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.session import Session
    from ..shared.dialogs import Dialogs
    from ..toolkit.services import Services


class MatchContext(PanelContext, frozen=True):
    """The collaborators of the window."""

    session: Session
    dialogs: Dialogs

    @classmethod
    def compose(cls, services: Services) -> MatchContext:
        """Pick what the window uses."""
        return cls(services.interface, services.log, services.session, services.dialogs)
