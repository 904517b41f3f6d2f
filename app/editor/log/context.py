"""What the Log panel and the toasts use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ..shared.protocols import SystemText
    from ..toolkit.services import Services


class LogContext(PanelContext, frozen=True):
    """The collaborators of the Log panel and the toasts."""

    clipboard: SystemText

    @classmethod
    def compose(cls, services: Services) -> LogContext:
        """Pick what the panel uses."""
        return cls(services.interface, services.log, services.clipboard)
