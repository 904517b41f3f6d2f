import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    RGBA,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Fraction,
    Image,
    OutputSocket,
    Position,
    ProxyNote,
    Reach,
    Slider,
    Trait,
)

_NO_LIMIT = 65504.0
"""The largest half float: nothing that passes keep is brighter."""

_LEFT = 0.01
"""However long the beams and strong the decay, this much is left: of the way to the source, and of the weight."""


class SunBeams(Filter):
    """Make light shafts that fan out from a light: sun through leaves, windows or mist.

    Every pixel gathers the bright light between itself and the source, so that an object before the light makes a dark
    shaft (Mitchell 2007, "Volumetric Light Scattering as a Post-Process", GPU Gems 3). The light is the mean at the
    points `source + (pixel - source) shrink^n` with the weights `fade^n`, from n = 0 until `length` of the way is
    covered. Passes of four samples, each of which makes n four times as large (as Kawase 2003 does for streaks), give
    the whole sum. Samples are less than a pixel apart, and the cost grows only with the logarithm of their number.
    `glow` is the beams alone. Alpha is kept.
    """

    aliases = (
        "god rays", "godrays", "light rays", "rays", "cc light rays", "volume rays", "volumetric light",
        "crepuscular rays", "shine", "cc light burst", "light burst", "radial rays", "sunbeams",
    )  # fmt: skip
    traits = (Trait.NEEDS_SCENE_LIGHT,)
    proxy_notes = (ProxyNote(("glow",), "it interpolates many times, which softens it by pixels of the proxy"),)

    image = Image()
    mask = Field(1.0, doc="Where light may come from: the sky, a window.")
    source: Annotated[Position, Doc("Where the light is; it may lie outside the picture.")] = (0.694, 0.063)
    radius: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="height",
            minimum=0.0,
            maximum=16.0,
            doc="Only light this near to the source makes beams; beyond, it fades out over the same "
            "distance. If large, all light makes beams.",
        ),
    ] = 0.06
    length: Annotated[
        Fraction,
        Slider(
            0.0,
            1.0,
            unit="ratio",
            minimum=0.0,
            maximum=1.0,
            doc="How far a pixel gathers light, as a part of the distance to the source.",
        ),
    ] = 0.93
    decay: Annotated[
        Fraction,
        Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="How much light is lost over that distance."),
    ] = 0.8
    intensity: Annotated[
        float,
        Slider(
            0.0, 4.0, unit="ratio", minimum=0.0, doc="How bright the beams are, relative to the light that they gather."
        ),
    ] = 0.3
    tint: Annotated[RGBA, Doc("Color of the beams; white keeps that of the light.")] = (1.0, 1.0, 1.0, 1.0)
    threshold: Annotated[
        float, Slider(0.0, 10.0, unit="scene", minimum=0.0, doc="Only light above this luminance makes beams.")
    ] = 1.5
    knee: Annotated[Fraction, Doc("Softness of the threshold: the part of it over which light fades in.")] = 0.5
    limit: Annotated[
        float,
        Slider(
            1.0,
            1000.0,
            unit="scene",
            minimum=0.0,
            maximum=_NO_LIMIT,
            doc="The largest luminance that makes beams, to limit suns and noise; 65504 is no limit.",
        ),
    ] = 50.0
    quality: Annotated[
        Literal["full", "half", "quarter"],
        Doc("The size at which beams are made. Smaller ones are softer, and 4 or 16 times as fast."),
    ] = "full"

    out = OutputSocket()
    glow = OutputSocket()

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        factor = {"full": 1, "half": 2, "quarter": 4}[self.quality]
        size = (-(-draw.size[0] // factor), -(-draw.size[1] // factor))
        source = (self.source[0] * draw.size[0] / factor, self.source[1] * draw.size[1] / factor)
        beams = draw.point(
            "sun_beams_light",
            self.image,
            self.mask,
            source=self.source,
            radius=self.radius,
            threshold=self.threshold,
            knee=self.knee,
            limit=self.limit,
        )
        if factor > 1:
            beams = draw("sun_beams_shrink", image=beams, size=size, overlap=Reach.block(factor, factor), factor=factor)
        samples = _samples(source, size, self.length)
        shrink, fade = max(1.0 - self.length, _LEFT), max(1.0 - self.decay, _LEFT)
        # The longest steps first: they magnify, and what is magnified loses little to the bilinear samples after.
        stride = samples
        while stride > 1:
            stride //= 4
            beams = draw(
                "sun_beams_pass",
                image=beams,
                size=size,
                edge="black",
                source=source,
                shrink=shrink ** (stride / samples),
                fade=fade ** (stride / samples),
            )
        if factor > 1:
            beams = draw(
                "sun_beams_enlarge", image=beams, size=draw.size, overlap=Reach.within(factor, factor, 1), factor=factor
            )
        glow = draw.point("sun_beams_glow", self.image, beams=beams, tint=self.tint)
        return {"out": draw.point("sun_beams", self.image, glow=glow, intensity=self.intensity), "glow": glow}


def _samples(source: tuple[float, float], size: tuple[int, int], length: float) -> int:
    """How many, a power of four, so that they are less than a pixel apart even for the farthest corner."""
    far = math.hypot(*(max(abs(at), abs(side - at)) for at, side in zip(source, size, strict=True)))
    apart = -far * math.log(max(1.0 - length, _LEFT))
    return 4 ** max(math.ceil(math.log(max(apart, 1.0), 4.0)), 1)
