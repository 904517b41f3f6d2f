"""What the viewer and the scopes uses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.preview import Preview
    from ...authoring.services.coloring import Coloring
    from ...authoring.services.preferences import Store
    from ...authoring.services.renders import Renders
    from ...authoring.session import Session
    from ...renderer.viewing.display import Display
    from ...renderer.viewing.probe import Probe
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import Clipboard, CodeFault, ElementView, PlayState
    from ..shared.stage import Stage
    from .state import ViewerState


@dataclass(frozen=True)
class ViewerContext(PanelContext):
    """The collaborators of the viewer and the scopes."""

    stage: Stage
    viewer: ViewerState
    preview: Preview
    display: Display
    probe: Probe
    store: Store
    actions: Actions
    dialogs: Dialogs
    clipboard: Clipboard
    timeline: PlayState
    canvas: ElementView
    code: CodeFault
    renders: Renders
    coloring: Coloring
    lights: dict[str, int]
    """The light that is selected, by the value that lists it."""

    @property
    def session(self) -> Session:
        """The document, or the flipbook that is shown in its place."""
        return self.stage.session
