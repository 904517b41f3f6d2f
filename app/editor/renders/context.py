"""What the Renders panel uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.preferences import PreferenceStore
    from ...authoring.preview.color_fallback import ColorFallback
    from ...authoring.render_queue.queue import RenderQueue
    from ...authoring.session import Session
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import PlayedSpan, SystemText
    from ..toolkit.services import Services
    from ..workflows.flipbook import FlipbookPlayer


class RendersContext(PanelContext, frozen=True):
    """The collaborators of the Renders panel."""

    session: Session
    exports: RenderQueue
    store: PreferenceStore
    timeline: PlayedSpan
    dialogs: Dialogs
    clipboard: SystemText
    coloring: ColorFallback
    flipbooks: FlipbookPlayer

    @classmethod
    def compose(cls, services: Services, timeline: PlayedSpan, flipbooks: FlipbookPlayer) -> RendersContext:
        """Pick what the panel uses."""
        return cls(
            services.interface,
            services.log,
            services.session,
            services.exports,
            services.store,
            timeline,
            services.dialogs,
            services.clipboard,
            services.coloring,
            flipbooks,
        )
