"""The color management of the document, or the built-in one if its config cannot be read."""

from __future__ import annotations

from halation.nodes import ColorSettings
from msgspec import Struct

from ...color.management import BUILT_IN, ColorManager, get_color_manager
from ...errors import HalationError
from ...resources.sandbox import Sandbox

_BUILT_IN = ColorSettings(BUILT_IN)


class ColorFallback(Struct):
    """Caches the last result: an unreadable config is not tried again before it changes."""

    sandbox: Sandbox
    requested_manager: ColorManager | None = None
    manager: ColorManager | None = None
    fault: str = ""
    """Why the built-in config is used instead; "" if it is not."""

    def resolve(self, color: ColorSettings) -> ColorManager:
        """The color manager of these settings, or the built-in one if their config cannot be read."""
        manager = get_color_manager(color, self.sandbox)
        if self.manager is None or manager is not self.requested_manager:
            self.requested_manager, self.manager, self.fault = manager, manager, ""
            try:
                if not manager.is_plain:
                    _ = manager.config, manager.working
            except HalationError as fault:
                self.manager, self.fault = get_color_manager(_BUILT_IN, self.sandbox), str(fault)
        return self.manager
