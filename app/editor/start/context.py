"""What the start screen uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.library import PresetLibrary
    from ...authoring.preferences import PreferenceStore
    from ...authoring.recovery.recovery import RecoveryFile
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..toolkit.services import Services
    from ..workflows.documents import DocumentWorkflow


class StartContext(PanelContext, frozen=True):
    """The collaborators of the start screen."""

    store: PreferenceStore
    library: PresetLibrary
    dialogs: Dialogs
    actions: Actions
    recovery: RecoveryFile
    documents: DocumentWorkflow

    @classmethod
    def compose(cls, services: Services, documents: DocumentWorkflow) -> StartContext:
        """Pick what the panel uses."""
        return cls(
            services.interface,
            services.log,
            services.store,
            services.library,
            services.dialogs,
            services.actions,
            services.recovery,
            documents,
        )
