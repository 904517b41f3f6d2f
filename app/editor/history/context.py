"""What the History panel uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.session import Session
    from ..toolkit.services import Services


class HistoryContext(PanelContext, frozen=True):
    """The collaborators of the History panel."""

    session: Session

    @classmethod
    def compose(cls, services: Services) -> HistoryContext:
        """Pick what the panel uses."""
        return cls(services.interface, services.log, services.session)
