from collections.abc import Mapping
from typing import Annotated

from .._declare import (
    RGBA,
    Doc,
    Draw,
    Drawn,
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

_FINEST = 4.0
"""Sigma of the sharpest ghosts in pixels: they are made at half the size, and the smallest is four times smaller."""

_VEIL = 0.15
"""Sigma of the veil, in heights. A choice."""


class Ghosts(Filter):
    """Add a lens flare: reflections between the lens elements, a halo, and dirt that lights up.

    A ghost is a picture of the bright light, out of focus and mostly flipped. Each ghost is magnified around the
    optical axis by a factor of its own. All ghosts have the same share of the light, so that a larger ghost is dimmer.
    The halo is the light, moved away from the axis by the radius of a ring (Chapman 2017, "Screen Space Lens Flare").
    The veil is light that is scattered over the whole lens. All of it is multiplied by the dirt, and fades out for
    lights that leave the picture. `glow` is the flare alone. Alpha is kept.
    """

    aliases = (
        "lens flare", "flare", "hot spot", "lens ghosts", "optical flares", "sun flare", "lens reflection",
        "lens reflections",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT, Trait.NEEDS_HIGHLIGHTS)
    proxy_notes = (ProxyNote(("glow",), "it interpolates many times, which softens it by pixels of the proxy"),)

    image = Image()
    dirt = Image(
        1.0,
        doc="A picture of the dirt on the front lens, by which the flare is multiplied. Without a"
        " link there are smudges.",
    )
    count: Annotated[int, Slider(0, 12, unit="count", minimum=0, maximum=12, doc="How many ghosts.")] = 7
    spread: Annotated[
        float,
        Slider(
            0.2,
            2.0,
            unit="ratio",
            minimum=0.05,
            maximum=8.0,
            doc="Factor on the size of the ghosts and on their distance from the axis.",
        ),
    ] = 1.0
    ghosts: Annotated[
        float, Slider(0.0, 0.2, unit="ratio", minimum=0.0, doc="How much of the bright light each ghost gets.")
    ] = 0.015
    halo: Annotated[
        float, Slider(0.0, 0.2, unit="ratio", minimum=0.0, doc="How much of the bright light goes into the halo.")
    ] = 0.015
    veil: Annotated[
        float,
        Slider(0.0, 0.2, unit="ratio", minimum=0.0, doc="How much of the bright light spreads over the whole lens."),
    ] = 0.04
    radius: Annotated[
        float,
        Slider(
            0.1, 0.8, unit="height", minimum=0.0, maximum=2.0, doc="Radius of the ring that a light on the axis makes."
        ),
    ] = 0.42
    softness: Annotated[
        float,
        Slider(
            0.0, 0.05, unit="height", minimum=0.0, maximum=0.5, doc="Standard deviation of the blur of ghosts and halo."
        ),
    ] = 0.015
    chromatic: Annotated[
        float,
        Slider(
            0.0,
            0.2,
            unit="ratio",
            minimum=0.0,
            maximum=0.9,
            doc="How much farther out red is than green, and green than blue.",
        ),
    ] = 0.03
    colors: Annotated[Fraction, Doc("How strongly each ghost is tinted by its own coating.")] = 0.6
    tint: Annotated[RGBA, Doc("Color of the flare; white keeps that of the light.")] = (1.0, 1.0, 1.0, 1.0)
    dirt_amount: Annotated[
        Fraction, Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="How much the dirt shows.")
    ] = 0.6
    center: Annotated[Position, Doc("The optical axis.")] = (0.5, 0.5)
    threshold: Annotated[
        float, Slider(0.0, 10.0, unit="scene", minimum=0.0, doc="Only light above this luminance is reflected.")
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
            doc="The largest luminance that is reflected, to limit suns and noise; 65504 is no limit.",
        ),
    ] = 200.0

    out = OutputSocket()
    glow = OutputSocket()

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Draw the flare at half the size: it is soft, and each of its pixels takes light from the whole picture."""
        half = (-(-draw.size[0] // 2), -(-draw.size[1] // 2))
        light = draw.point("ghosts_light", self.image, threshold=self.threshold, knee=self.knee, limit=self.limit)
        light = draw("ghosts_shrink", image=light, size=half, overlap=Reach.block(2, 2))
        center = (self.center[0] * draw.size[0] / 2.0, self.center[1] * draw.size[1] / 2.0)
        flare = draw(
            "ghosts_flare",
            image=draw.blur(light, max(self.softness, _FINEST) / 2.0, "black"),
            wide=draw.blur(light, _VEIL * half[1], "black"),
            size=half,
            edge="black",
            center=center,
            count=self.count,
            spread=self.spread,
            ghosts=self.ghosts,
            halo=self.halo,
            veil=self.veil,
            radius=self.radius / 2.0,
            chromatic=self.chromatic,
            colors=self.colors,
        )
        flare = draw("ghosts_enlarge", image=flare, size=draw.size, overlap=Reach.within(2, 2, 1))
        if draw.is_linked(self.dirt):
            dirt = draw.point("ghosts_dirt", self.image, dirt=self.dirt)
        else:
            dirt = draw.point("ghosts_smudges", self.image)
        glow = draw.point("ghosts_glow", self.image, flare=flare, dirt=dirt, amount=self.dirt_amount, tint=self.tint)
        return {"out": draw.point("ghosts", self.image, glow=glow), "glow": glow}
