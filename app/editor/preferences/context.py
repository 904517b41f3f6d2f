"""What the Preferences dialog uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.preferences import PreferenceStore
    from ...authoring.recovery.recovery import RecoveryFile
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import SystemText
    from ..toolkit.services import Services


class PreferencesContext(PanelContext, frozen=True):
    """The collaborators of the Preferences dialog."""

    store: PreferenceStore
    actions: Actions
    dialogs: Dialogs
    recovery: RecoveryFile
    clipboard: SystemText

    @classmethod
    def compose(cls, services: Services) -> PreferencesContext:
        """Pick what the panel uses."""
        return cls(
            services.interface,
            services.log,
            services.store,
            services.actions,
            services.dialogs,
            services.recovery,
            services.clipboard,
        )
