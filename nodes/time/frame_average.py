import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Image, OutputSocket, Slider, Vector

Shape = Literal["box", "tent", "gaussian", "exponential"]

_SIGMAS = 3.0
"""Standard deviations of the Gaussian, and time constants of the exponential, to the end of the window."""


class FrameAverage(Filter):
    """Average several frames in linear light: less noise, and motion is blurred as by a long shutter.

    The weight of a frame depends on its distance from this one, as a part of the window: equal for all, falling
    linearly, a Gaussian that ends at 3 sigma, or an exponential that has fallen by e^3 at the end of the window. If a
    centered window has an even number of frames, the frames at its two ends count half. A shot that is rendered at N
    times its frame rate, averaged over N frames and played N times as fast, has the motion blur of a whole frame.
    """

    aliases = (
        "temporal denoise", "denoise", "temporal median", "average frames", "time average", "reduce noise",
        "remove noise", "noise reduction", "long exposure", "temporal blur", "time blur", "reduce grain",
        "remove grain", "median time",
    )  # fmt: skip

    image = Image()
    out = OutputSocket(follows="image")
    frames: Annotated[int, Slider(1, 16, unit="count", minimum=1, maximum=128, doc="How many frames.")] = 5
    weights: Annotated[Shape, Doc("How the weights of the frames fall with their distance.")] = "box"
    window: Annotated[
        Literal["centered", "trailing"],
        Doc("Centered: as many frames before this one as after it. Trailing: none after it."),
    ] = "centered"

    def identity(self) -> str | None:
        return "image" if self.frames == 1 else None

    def times(self, frame: int) -> Mapping[str, tuple[int, ...]]:
        return {"image": tuple(frame + offset for offset in self.share())}

    def passes(self, draw: Draw) -> Drawn:
        total: Drawn | None = None
        for offset, weight in self.share().items():
            image = draw.at(self.image, draw.frame + offset)
            if total is None:
                total = draw.point("frame_average_first", image=image, weight=weight, result=Vector(width=4))
            else:
                total = draw.point("frame_average_add", total=total, image=image, weight=weight, result=Vector(width=4))
        assert total is not None
        return draw.point("frame_average", total=total)

    def share(self) -> dict[int, float]:
        """What part of the result every frame is, by how many frames later it is."""
        if self.window == "trailing":
            weights = {-back: _weight(self.weights, back / self.frames) for back in range(self.frames)}
        else:
            reach = self.frames // 2
            weights = {
                offset: _weight(self.weights, 2.0 * abs(offset) / (self.frames + 1))
                * (0.5 if 2 * abs(offset) == self.frames else 1.0)
                for offset in range(-reach, reach + 1)
            }
        total = sum(weights.values())
        return {offset: weight / total for offset, weight in weights.items()}


def _weight(shape: Shape, away: float) -> float:
    """At a distance from this frame; from 1 on lies outside the window."""
    return {
        "box": 1.0,
        "tent": 1.0 - away,
        "gaussian": math.exp(-0.5 * (_SIGMAS * away) ** 2),
        "exponential": math.exp(-_SIGMAS * away),
    }[shape]
