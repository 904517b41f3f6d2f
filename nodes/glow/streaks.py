import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import RGBA, Dial, Doc, Draw, Drawn, Filter, Fraction, Image, OutputSocket, ProxyNote, Slider, Trait

_NO_LIMIT = 65504.0
"""The largest half float: nothing that passes keep is brighter."""

_LEFT = 0.01
"""How much of a streak's light is left at its length."""

_BEYOND = 1.5
"""Streaks are drawn on to this many lengths, where a thousandth is left, so that no end shows."""

_WAVELENGTHS = (611.0, 549.0, 464.0)
"""Dominant wavelengths of the primaries of Rec.709, in nanometers."""


class Streaks(Filter):
    """Draw long straight streaks from bright light, as star filters, aperture blades and anamorphic lenses do.

    Along an arm the light fades by the same factor from pixel to pixel, to a hundredth at `length`. Passes of four
    samples, each pass with four times the distance between samples (Kawase 2003, "Frame Buffer Postprocessing Effects
    in DOUBLE-S.T.E.A.L."), give exactly that sum, so that the cost grows only with the logarithm of the length. `glow`
    is the streaks alone: the light is shared between the arms, and its sum stays. An arm that is neither on an axis nor
    on a diagonal is softer by about a pixel, because it is interpolated. Two arms at 0 degrees are the streak of an
    anamorphic lens. Alpha is kept.
    """

    aliases = (
        "anamorphic flare", "glint", "light streaks", "blue streak", "horizontal flare", "lens flare", "highlight",
        "anamorphic streak", "light sweep",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT, Trait.NEEDS_HIGHLIGHTS)
    proxy_notes = (ProxyNote(("glow",), "the average of several pixels exceeds a threshold less often"),)

    image = Image()
    arms: Annotated[
        int,
        Slider(
            2, 16, unit="count", minimum=1, maximum=16, doc="An aperture of n blades has n arms, or 2 n if n is odd."
        ),
    ] = 6
    length: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="height",
            minimum=0.0,
            maximum=4.0,
            doc="The distance at which a hundredth of an arm's light is left.",
        ),
    ] = 0.4
    angle: Annotated[
        float,
        Slider(-180.0, 180.0, unit="deg", doc="Where the first arm points: 0 is right, 90 is up."),
        Dial("counterclockwise"),
    ] = 15.0
    dispersion: Annotated[
        float,
        Slider(
            0.0,
            4.0,
            unit="ratio",
            minimum=0.0,
            maximum=8.0,
            doc="How much farther red reaches than blue. 1 is that of diffraction, in proportion to the wavelength.",
        ),
    ] = 1.5
    intensity: Annotated[
        float, Slider(0.0, 4.0, unit="ratio", minimum=0.0, doc="How much of the bright light goes into the streaks.")
    ] = 0.5
    tint: Annotated[RGBA, Doc("Color of the streaks; white keeps that of the light.")] = (1.0, 1.0, 1.0, 1.0)
    threshold: Annotated[
        float, Slider(0.0, 10.0, unit="scene", minimum=0.0, doc="Only light above this luminance makes streaks.")
    ] = 2.0
    knee: Annotated[Fraction, Doc("Softness of the threshold: the part of it over which light fades in.")] = 0.5
    limit: Annotated[
        float,
        Slider(
            1.0,
            1000.0,
            unit="scene",
            minimum=0.0,
            maximum=_NO_LIMIT,
            doc="The largest luminance that makes streaks, to limit suns and noise; 65504 is no limit.",
        ),
    ] = 200.0
    quality: Annotated[
        Literal["full", "half", "quarter"],
        Doc("The size at which streaks are made. Smaller ones are softer, and 4 or 16 times as fast."),
    ] = "half"
    edge: Annotated[
        Literal["black", "clamp"],
        Doc(
            "What lies outside the picture. Black: no light. Clamp would draw broad streaks from lights on the border."
        ),
    ] = "black"

    out = OutputSocket()
    glow = OutputSocket()

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        factor = {"full": 1, "half": 2, "quarter": 4}[self.quality]
        size = (-(-draw.size[0] // factor), -(-draw.size[1] // factor))
        light = draw.point("streaks_light", self.image, threshold=self.threshold, knee=self.knee, limit=self.limit)
        if factor > 1:
            light = draw("streaks_shrink", image=light, size=size, edge=self.edge, overlap=2 * factor, factor=factor)
        star = self._arm(draw, light, 0, self.length / factor)
        for arm in range(1, self.arms):
            star = draw.point("streaks_add", star=star, arm=self._arm(draw, light, arm, self.length / factor))
        if factor > 1:
            star = draw("streaks_enlarge", image=star, size=draw.size, overlap=3, factor=factor)
        glow = draw.point("streaks_glow", self.image, star=star, share=1.0 / self.arms, tint=self.tint)
        return {"out": draw.point("streaks", self.image, glow=glow, intensity=self.intensity), "glow": glow}

    def _arm(self, draw: Draw, light: Drawn, arm: int, length: float) -> Drawn:
        turn = self.angle + 2.0 * math.pi * arm / self.arms
        # A pixel finds its light where the arm came from.
        back = (-math.cos(turn), math.sin(turn))
        lengths = [length * (wave / _WAVELENGTHS[1]) ** self.dispersion for wave in _WAVELENGTHS]
        stride = 1
        while stride < _BEYOND * max(lengths):
            fade = tuple(_LEFT ** (stride / max(reach, 1e-3)) for reach in lengths)
            light = draw(
                "streaks_pass",
                image=light,
                edge=self.edge,
                size=light.size,
                overlap=_far(back, 3 * stride),
                stride=_times(back, stride),
                fade=fade,
            )
            stride *= 4
        return light


def _times(vector: tuple[float, float], factor: float) -> tuple[float, float]:
    return vector[0] * factor, vector[1] * factor


def _far(vector: tuple[float, float], factor: float) -> tuple[int, int]:
    """How many pixels away samples lie that many steps along a vector."""
    return math.ceil(abs(vector[0]) * factor) + 1, math.ceil(abs(vector[1]) * factor) + 1
