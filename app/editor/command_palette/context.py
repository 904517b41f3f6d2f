"""What the command palette uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.session import Session
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import ElementView
    from ..toolkit.services import Services
    from ..workflows.documents import DocumentWorkflow


class PaletteContext(PanelContext, frozen=True):
    """The collaborators of the command palette."""

    session: Session
    actions: Actions
    canvas: ElementView
    dialogs: Dialogs
    documents: DocumentWorkflow

    @classmethod
    def compose(cls, services: Services, canvas: ElementView, documents: DocumentWorkflow) -> PaletteContext:
        """Pick what the panel uses."""
        return cls(
            services.interface, services.log, services.session, services.actions, canvas, services.dialogs, documents
        )
