"""How colors are managed, as far as the config that is wanted can be read."""

from __future__ import annotations

from dataclasses import dataclass

from halation.nodes import ColorSettings

from ...color.management import BUILT_IN, get_color_manager, mark_color_settings
from ...errors import HalationError

_BUILT_IN = ColorSettings(BUILT_IN)


@dataclass
class ColorFallback:
    """The last answer: a config that cannot be read is not tried again before it changes."""

    asked: tuple[ColorSettings, str] | None = None
    settings: ColorSettings = _BUILT_IN
    fault: str = ""
    """Why the built-in config stands in."""

    def resolve(self, color: ColorSettings) -> ColorSettings:
        """These settings, or those that stand in for them."""
        key = color, mark_color_settings(color)
        if key != self.asked:
            self.asked, self.settings, self.fault = key, color, ""
            manager = get_color_manager(color)
            try:
                if not manager.is_plain:
                    _ = manager.config, manager.working
            except HalationError as fault:
                self.settings, self.fault = _BUILT_IN, str(fault)
        return self.settings
