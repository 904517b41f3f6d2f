"""What the viewer and the scopes use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.background.render_overviews import RenderOverviews
    from ...authoring.preferences import PreferenceStore
    from ...authoring.preview import Preview
    from ...authoring.preview.color_fallback import ColorFallback
    from ...authoring.session import Session
    from ...renderer.viewing.display import Display
    from ...renderer.viewing.probe import PixelProbe
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import ElementView, PlayState, ReportedFault, SystemText
    from ..shared.stage import DocumentStage
    from ..toolkit.services import Services
    from .state import ViewerState


class ViewerContext(PanelContext, frozen=True):
    """The collaborators of the viewer and the scopes."""

    stage: DocumentStage
    viewer: ViewerState
    preview: Preview
    display: Display
    probe: PixelProbe
    store: PreferenceStore
    actions: Actions
    dialogs: Dialogs
    clipboard: SystemText
    timeline: PlayState
    canvas: ElementView
    code: ReportedFault
    renders: RenderOverviews
    coloring: ColorFallback
    items: dict[str, str]
    """The name of the selected item of each value with named items, such as lights."""

    @property
    def session(self) -> Session:
        """The document, or the flipbook that is shown in its place."""
        return self.stage.session

    @classmethod
    def compose(
        cls, services: Services, viewer: ViewerState, timeline: PlayState, canvas: ElementView, code: ReportedFault
    ) -> ViewerContext:
        """Pick what the panel uses."""
        return cls(
            services.interface,
            services.log,
            services.stage,
            viewer,
            services.preview,
            services.display,
            services.probe,
            services.store,
            services.actions,
            services.dialogs,
            services.clipboard,
            timeline,
            canvas,
            code,
            services.renders,
            services.coloring,
            services.items,
        )
