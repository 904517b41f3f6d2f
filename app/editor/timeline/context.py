"""What the timeline uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.preview import Preview
    from ...authoring.session import Session
    from ..shared.action import Actions
    from ..shared.stage import DocumentStage
    from ..toolkit.services import Services
    from .state import TimelineState


class TimelineContext(PanelContext, frozen=True):
    """The collaborators of the timeline."""

    stage: DocumentStage
    timeline: TimelineState
    preview: Preview
    actions: Actions
    items: dict[str, str]
    """The name of the selected item of each value with named items, such as lights."""

    @property
    def session(self) -> Session:
        """The document, or the flipbook that is shown in its place."""
        return self.stage.session

    @classmethod
    def compose(cls, services: Services, timeline: TimelineState) -> TimelineContext:
        """Pick what the panel uses."""
        return cls(
            services.interface,
            services.log,
            services.stage,
            timeline,
            services.preview,
            services.actions,
            services.items,
        )
