from collections.abc import Mapping
from typing import Annotated

from .._declare import Draw, Drawn, Field, Image, OutputSocket, Slider, Temporal, Vector


class TemporalAccumulation(Temporal):
    """Remove the noise of traced light by the mean over frames, along the motion of surfaces.

    Each surface is found in the previous frame by its velocity, between pixels, among those that have its depth and
    normal; what was hidden there begins anew. A pixel counts its frames: the newest of n has the weight 1 / n, down to
    1 / `frames` (Schied et al. 2017, the temporal part of SVGF). For the noise of rays: reflections, occlusion, soft
    shadows. What moves otherwise than its surface, such as a mirrored object, is limited to the colors around, in the
    mean plus or minus `gamma` standard deviations (Salvi 2016).
    """

    aliases = (
        "svgf", "temporal filter", "temporal denoise", "reprojection", "accumulate frames", "temporal reprojection",
        "noise reduction",
    )  # fmt: skip

    image = Image(doc="The noisy light.")
    velocity = Vector(
        width=4,
        doc=(
            "Motion in pixels of the full-size picture, x right, y down: x and y since the "
            "previous frame. The rest is not used."
        ),
    )
    depth = Field(0.0, doc="Shows which surface was hidden in the previous frame.")
    normal = Vector(0.0, width=3, doc="In the world. Shows where surfaces of one depth meet.")
    frames: Annotated[
        int,
        Slider(1, 64, unit="count", minimum=1, maximum=4096, doc="Over how many frames the mean is taken at most."),
    ] = 16
    gamma: Annotated[
        float,
        Slider(
            0.0,
            4.0,
            unit="ratio",
            minimum=0.0,
            maximum=100.0,
            doc="How many standard deviations of the colors around the past may differ: less follows what moves by "
            "itself, more is smoother. 0: no limit.",
        ),
    ] = 2.0
    tolerance: Annotated[
        float,
        Slider(
            0.01,
            0.5,
            unit="ratio",
            minimum=0.0,
            maximum=1e6,
            doc="A pixel whose depth differs by more than this part shows another surface.",
        ),
    ] = 0.05
    angle: Annotated[
        float,
        Slider(
            0.0,
            90.0,
            unit="deg",
            minimum=0.0,
            maximum=180.0,
            doc="A pixel whose normal differs by more than this angle shows another surface.",
        ),
    ] = 25.0

    out = OutputSocket()
    count = OutputSocket(Field(doc="Of how many frames each pixel is the mean."))

    def times(self, frame: int) -> Mapping[str, tuple[int, ...]]:
        return {"depth": (frame, frame - 1), "normal": (frame, frame - 1)}

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Two pictures are remembered: the mean, and its number of frames."""
        vector = Vector(width=4)
        newest = draw.point("temporal_accumulation_newest", self.image, result=vector)
        first = draw.point("temporal_accumulation_first", self.image, result=Field())
        past, ages = draw.history(newest, "mean"), draw.history(first, "count")
        mean, count = newest, first
        if past != newest:
            mean, count = draw.several(
                "temporal_accumulation_mean",
                (vector, Field()),
                self.velocity,
                newest=newest,
                past=past,
                ages=ages,
                depth=draw.at(self.depth, draw.frame),
                depth_before=draw.at(self.depth, draw.frame - 1),
                normal=draw.at(self.normal, draw.frame),
                normal_before=draw.at(self.normal, draw.frame - 1),
                frames=self.frames,
                gamma=self.gamma,
                tolerance=self.tolerance if draw.is_linked(self.depth) else -1.0,
                angle=self.angle if draw.is_linked(self.normal) else -1.0,
            )
        draw.remember(mean, "mean")
        draw.remember(count, "count")
        return {"out": draw.point("temporal_accumulation", mean=mean), "count": count}
