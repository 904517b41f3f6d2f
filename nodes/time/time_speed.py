import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Field, Filter, Image, OutputSocket, Slider, Trait, Vector


class TimeSpeed(Filter):
    """Play faster, slower or backward: by a speed, or by keys that say which frame is shown when.

    By speed, the frame that is shown is `pivot + speed (frame - pivot)`. For a speed that changes, set keys on `source`
    instead, as in a time remap: the steeper the curve, the faster.
    """

    aliases = (
        "retime", "time warp", "timewarp", "time stretch", "time stretcher", "speed", "slow motion", "fast forward",
        "time remap", "time remapping", "reverse", "kronos", "oflow", "optical flow", "frame rate", "posterize time",
        "time curve", "time lapse", "speed ramp", "frame range",
    )  # fmt: skip
    traits = (Trait.KEEPS_NON_FINITE,)

    image = Image((0.0, 0.0, 0.0, 0.0))
    field = Field(0.0)
    vector = Vector(0.0, width=4)
    mode: Annotated[Literal["speed", "source"], Doc("How the frame is chosen.")] = "speed"
    speed: Annotated[
        float,
        Slider(
            -4.0,
            4.0,
            unit="ratio",
            minimum=-1000.0,
            maximum=1000.0,
            doc="By speed: 2 is twice as fast, 0.5 slow motion, below 0 backward.",
        ),
    ] = 0.5
    pivot: Annotated[int, Slider(1, 240, unit="count", doc="By speed: the frame that does not move.")] = 1
    source: Annotated[
        float,
        Slider(
            1.0, 240.0, unit="count", minimum=-1e6, maximum=1e6, doc="By source: the frame that is shown now, for keys."
        ),
    ] = 1.0
    between: Annotated[
        Literal["nearest", "blend"],
        Doc("Between two frames of a picture, show the nearest one or dissolve. Fields and vectors are never mixed."),
    ] = "nearest"

    out = OutputSocket(Image())
    field_out = OutputSocket(Field())
    vector_out = OutputSocket(Vector(width=4))

    def times(self, frame: int) -> Mapping[str, tuple[int, ...]]:
        source_frame = self._source(frame)
        pair = (
            (math.floor(source_frame), math.ceil(source_frame))
            if self.between == "blend"
            else (_nearest(source_frame),)
        )
        return dict.fromkeys(self.inputs, (_nearest(source_frame),)) | {"image": tuple(dict.fromkeys(pair))}

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        source_frame = self._source(draw.frame)
        before, near, part = math.floor(source_frame), _nearest(source_frame), source_frame - math.floor(source_frame)
        if self.between == "blend" and part > 0.0:
            image = draw.point(
                "time_speed_dissolve",
                before=draw.at(self.image, before),
                after=draw.at(self.image, before + 1),
                part=part,
            )
        else:
            image = draw.at(self.image, near)
        return {"out": image, "field_out": draw.at(self.field, near), "vector_out": draw.at(self.vector, near)}

    def _source(self, frame: int) -> float:
        source_frame = self.pivot + self.speed * (frame - self.pivot) if self.mode == "speed" else self.source
        return round(source_frame, 6)  # 0.1 times 10 is a whole frame


def _nearest(frame: float) -> int:
    """Halves go to the later frame."""
    return math.floor(frame + 0.5)
