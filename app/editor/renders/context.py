"""What the Renders panel uses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.services.coloring import Coloring
    from ...authoring.services.exporting import Exports
    from ...authoring.services.preferences import Store
    from ...authoring.session import Session
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import Clipboard, PlayedSpan
    from ..workflows.flipbook import FlipbookPlayer


@dataclass(frozen=True)
class RendersContext(PanelContext):
    """The collaborators of the Renders panel."""

    session: Session
    exports: Exports
    store: Store
    timeline: PlayedSpan
    dialogs: Dialogs
    clipboard: Clipboard
    coloring: Coloring
    flipbooks: FlipbookPlayer
