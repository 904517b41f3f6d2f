"""What the Preferences dialog uses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.services.preferences import Store
    from ...authoring.services.recovery import Recovery
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import Clipboard


@dataclass(frozen=True)
class PreferencesContext(PanelContext):
    """The collaborators of the Preferences dialog."""

    store: Store
    actions: Actions
    dialogs: Dialogs
    recovery: Recovery
    clipboard: Clipboard
