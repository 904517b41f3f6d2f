"""What the Problems panel uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.preferences import PreferenceStore
    from ...authoring.preview import Preview
    from ...authoring.recovery.recovery import RecoveryFile
    from ...authoring.session import Session
    from ...watch.watching import FileWatcher
    from ..shared.protocols import ElementView, SystemText
    from ..toolkit.services import Services


class ProblemsContext(PanelContext, frozen=True):
    """The collaborators of the Problems panel."""

    session: Session
    preview: Preview
    canvas: ElementView
    clipboard: SystemText
    recovery: RecoveryFile
    watcher: FileWatcher
    store: PreferenceStore
    faults: dict[str, str]
    """Panels that failed, with the traceback."""

    @classmethod
    def compose(cls, services: Services, canvas: ElementView) -> ProblemsContext:
        """Pick what the panel uses."""
        return cls(
            services.interface,
            services.log,
            services.session,
            services.preview,
            canvas,
            services.clipboard,
            services.recovery,
            services.watcher,
            services.store,
            services.faults,
        )
