"""What the inspector uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.background.render_overviews import RenderOverviews
    from ...authoring.preview import Preview
    from ...authoring.preview.color_fallback import ColorFallback
    from ...authoring.session import Session
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import ElementView, PixelPicker, Player, SystemText
    from ..toolkit.services import Services


class InspectorContext(PanelContext, frozen=True):
    """The collaborators of the inspector."""

    session: Session
    preview: Preview
    actions: Actions
    dialogs: Dialogs
    clipboard: SystemText
    canvas: ElementView
    viewer: PixelPicker
    timeline: Player
    renders: RenderOverviews
    coloring: ColorFallback
    items: dict[str, str]
    """The name of the selected item of each value with named items, such as lights."""

    @classmethod
    def compose(
        cls, services: Services, canvas: ElementView, viewer: PixelPicker, timeline: Player
    ) -> InspectorContext:
        """Pick what the panel uses."""
        return cls(
            services.interface,
            services.log,
            services.session,
            services.preview,
            services.actions,
            services.dialogs,
            services.clipboard,
            canvas,
            viewer,
            timeline,
            services.renders,
            services.coloring,
            services.items,
        )
