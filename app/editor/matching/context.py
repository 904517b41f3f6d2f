"""What the window *Match* uses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.session import Session
    from ..shared.dialogs import Dialogs
    from ..toolkit.services import Services


@dataclass(frozen=True)
class MatchContext(PanelContext):
    """The collaborators of the window."""

    session: Session
    dialogs: Dialogs

    @classmethod
    def compose(cls, services: Services) -> MatchContext:
        """Pick what the window uses."""
        return cls(services.interface, services.log, services.session, services.dialogs)
