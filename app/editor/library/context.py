"""What the dialog that saves a preset uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.library import PresetLibrary
    from ...authoring.preferences import PreferenceStore
    from ...authoring.session import Session
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import SnapshotSource
    from ..toolkit.services import Services


class PresetContext(PanelContext, frozen=True):
    """The collaborators of the dialog."""

    session: Session
    store: PreferenceStore
    library: PresetLibrary
    dialogs: Dialogs
    viewer: SnapshotSource

    @classmethod
    def compose(cls, services: Services, viewer: SnapshotSource) -> PresetContext:
        """Pick what the dialog uses."""
        return cls(
            services.interface,
            services.log,
            services.session,
            services.store,
            services.library,
            services.dialogs,
            viewer,
        )
