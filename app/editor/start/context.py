"""What the start screen uses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.services.preferences import Store
    from ...authoring.services.recovery import Recovery
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..workflows.documents import DocumentWorkflow


@dataclass(frozen=True)
class StartContext(PanelContext):
    """The collaborators of the start screen."""

    store: Store
    dialogs: Dialogs
    actions: Actions
    recovery: Recovery
    documents: DocumentWorkflow
