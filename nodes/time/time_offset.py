from collections.abc import Mapping
from typing import Annotated

from .._declare import Draw, Drawn, Field, Filter, Image, OutputSocket, Slider, Trait, Vector


class TimeOffset(Filter):
    """Show another frame: a later one above zero, an earlier one below.

    All that is linked upstream is computed at that frame: sequences, keys, expressions, noise, motion in a scene.
    """

    aliases = (
        "shift time", "slip", "delay", "offset", "time shift", "frame offset", "slip clip", "frame delay",
        "append clip", "time stretch offset", "time clip", "time machine",
    )  # fmt: skip
    traits = (Trait.KEEPS_NON_FINITE,)

    image = Image((0.0, 0.0, 0.0, 0.0))
    field = Field(0.0)
    vector = Vector(0.0, width=4)
    frames: Annotated[int, Slider(-24, 24, unit="count", doc="How many frames later; below 0 earlier.")] = 0

    out = OutputSocket(Image())
    field_out = OutputSocket(Field())
    vector_out = OutputSocket(Vector(width=4))

    def times(self, frame: int) -> Mapping[str, tuple[int, ...]]:
        return dict.fromkeys(self.inputs, (frame + self.frames,))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        outputs = {"out": self.image, "field_out": self.field, "vector_out": self.vector}
        return {name: draw.at(socket, draw.frame + self.frames) for name, socket in outputs.items()}
