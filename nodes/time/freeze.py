from collections.abc import Mapping
from typing import Annotated

from .._declare import Draw, Drawn, Field, Filter, Image, OutputSocket, Slider, Trait, Vector


class Freeze(Filter):
    """Hold one frame, or every nth frame: animation on twos, the stutter of a slow camera.

    All that is linked upstream is held, whatever changes it over time.
    """

    aliases = (
        "frame hold", "framehold", "freeze frame", "hold frame", "still", "hold", "posterize time", "stop",
        "time freeze",
    )  # fmt: skip
    traits = (Trait.KEEPS_NON_FINITE,)

    image = Image((0.0, 0.0, 0.0, 0.0))
    field = Field(0.0)
    vector = Vector(0.0, width=4)
    frame: Annotated[int, Slider(1, 240, unit="count", doc="The frame that is held, or one of the held frames.")] = 1
    every: Annotated[
        int,
        Slider(
            0,
            12,
            unit="count",
            minimum=0,
            doc="0 holds one frame forever. Otherwise each held frame is shown for this many frames: 2 is on twos.",
        ),
    ] = 0

    out = OutputSocket(Image())
    field_out = OutputSocket(Field())
    vector_out = OutputSocket(Vector(width=4))

    def times(self, frame: int) -> Mapping[str, tuple[int, ...]]:
        return dict.fromkeys(self.inputs, (self._find_held_frame(frame),))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        outputs = {"out": self.image, "field_out": self.field, "vector_out": self.vector}
        return {name: draw.at(socket, self._find_held_frame(draw.frame)) for name, socket in outputs.items()}

    def _find_held_frame(self, frame: int) -> int:
        return self.frame + (frame - self.frame) // self.every * self.every if self.every else self.frame
