"""What the small dialogs use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.preview import Preview
    from ...authoring.preview.node_timer import NodeTimer
    from ...authoring.preview.value_strip import ValueStrip
    from ...authoring.session import Session
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import SystemText
    from ..toolkit.services import Services


class DialogContext(PanelContext, frozen=True):
    """The collaborators of the small dialogs."""

    session: Session
    preview: Preview
    dialogs: Dialogs
    actions: Actions
    clipboard: SystemText
    strip: ValueStrip
    node_timer: NodeTimer

    @classmethod
    def compose(cls, services: Services) -> DialogContext:
        """Pick what the panel uses."""
        return cls(
            services.interface,
            services.log,
            services.session,
            services.preview,
            services.dialogs,
            services.actions,
            services.clipboard,
            services.strip,
            services.node_timer,
        )
