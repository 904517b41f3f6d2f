"""What the Animation panel uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.session import Session
    from ..shared.action import Actions
    from ..shared.protocols import SystemText
    from ..toolkit.services import Services
    from .state import CurvesState


class CurvesContext(PanelContext, frozen=True):
    """The collaborators of the Animation panel."""

    session: Session
    curves: CurvesState
    actions: Actions
    clipboard: SystemText

    @classmethod
    def compose(cls, services: Services, curves: CurvesState) -> CurvesContext:
        """Pick what the panel uses."""
        return cls(services.interface, services.log, services.session, curves, services.actions, services.clipboard)
