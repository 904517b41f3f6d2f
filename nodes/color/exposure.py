from typing import Annotated

from .._declare import Image, OutputSocket, Pointwise, Slider, Trait


class Exposure(Pointwise):
    """Brighten or darken in photographic stops: every stop doubles the light."""

    aliases = ("stops", "ev", "gain", "brightness", "expose", "exptool", "lighten", "darken", "multiply exposure")
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    out = OutputSocket(follows="image")
    stops: Annotated[float, Slider(-10.0, 10.0, unit="EV", doc="+1 doubles the light, -1 halves it.")] = 0.0

    def identity(self) -> str | None:
        return "image" if self.stops == 0.0 else None
