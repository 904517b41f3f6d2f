import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    RGBA,
    Curve,
    Doc,
    Draw,
    Drawn,
    Edge,
    Filter,
    Fraction,
    Image,
    OutputSocket,
    Pixels,
    Points,
    Size,
    Slider,
    Trait,
    curve_at,
)

_NO_LIMIT = 65504.0
"""The largest half float: nothing that passes keep is brighter."""

_WHITE = (1.0, 1.0, 1.0, 1.0)

_OCTAVES = 4
"""Scatter shares light out over this many halvings of the radius, so that the glow's shape is the same at any size."""

_FAINTEST = 1e-12
"""No level counts for less, so that levels that all count for nothing are all alike instead."""

_SHARPNESS = 1.5
"""By how many square pixels the variance of a level of the pyramid is less than 1.5 times the square of its pixels."""

_LEVEL_REACH = 7
"""How far light reaches, in pixels of the smallest level: less than 3 on the way down and 4 on the way up, where each
level reads 3 pixels of the finer one and 2 of the coarser one."""


class Bloom(Filter):
    """Let bright light bleed over its surroundings, as in a lens or on film.

    The glow is made with a pyramid of smaller and smaller pictures, which are blurred on the way down and on the way up
    again (Jimenez 2014). So a larger radius hardly costs more. `out` is the picture with its glow, `glow` the glow
    alone. Without threshold, limit and firefly filter the glow is linear and loses no light. Alpha is kept.
    """

    aliases = (
        "glow", "soft glow", "glare", "fog glow", "halation", "exponential glow", "diffusion", "optical glow", "halo",
        "deep glow", "light bloom", "dreamy", "shine", "magic bloom",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT, Trait.NEEDS_HIGHLIGHTS)

    image = Image()
    radius: Annotated[
        float,
        Slider(0.0, 0.5, unit="height", minimum=0.0, maximum=1.0, doc="Standard deviation of the widest glow."),
    ] = 0.1
    scatter: Annotated[Fraction, Doc("How much light reaches wider levels: 0 gives a narrow glow, 1 a wide one.")] = 0.7
    levels: Annotated[
        Points,
        Curve(0.0, 2.0, minimum=0.0),
        Doc(
            "The weight of each width, in addition to scatter. The left is a sixteenth of the "
            "radius, the right the whole radius, in steps of a factor of 2. The sum of the "
            "weights stays."
        ),
    ] = (0.0, 1.0, 1.0, 1.0)
    tint: Annotated[RGBA, Doc("Color of the glow; white keeps that of the light.")] = _WHITE
    intensity: Annotated[
        float, Slider(0.0, 1.0, unit="ratio", minimum=0.0, doc="How much glow reaches the picture.")
    ] = 0.04
    mode: Annotated[
        Literal["mix", "add"], Doc("Mix moves light into the glow and keeps the sum; add puts the glow on top.")
    ] = "mix"
    threshold: Annotated[
        float, Slider(0.0, 10.0, unit="scene", minimum=0.0, doc="Only light above this luminance glows.")
    ] = 0.0
    knee: Annotated[Fraction, Doc("Softness of the threshold: the part of it over which light fades in.")] = 0.5
    limit: Annotated[
        float,
        Slider(
            1.0,
            1000.0,
            unit="scene",
            minimum=0.0,
            maximum=_NO_LIMIT,
            doc="The largest luminance that glows, to limit suns and noise; 65504 is no limit.",
        ),
    ] = _NO_LIMIT
    firefly: Annotated[
        bool,
        Doc(
            "Reduce the weight of single bright pixels, which would flicker (Karis 2013). Some of their light is lost, "
            "more of it in small pictures."
        ),
    ] = False
    exact: Annotated[
        bool,
        Doc(
            "Blur the narrowest parts of the glow as well, which are sharp without it. Then the glow has the same "
            "shape at every size of the picture, and takes a little longer."
        ),
    ] = False
    edge: Annotated[
        Literal["clamp", "reflect", "wrap", "panorama"],
        Doc("What lies outside the picture. Wrap and panorama leave no seam in pictures that go on."),
    ] = "clamp"

    out = OutputSocket()
    glow = OutputSocket()

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        light: Pixels = self.image
        if self.threshold > 0.0 or self.limit < _NO_LIMIT:
            light = draw.point("bloom_light", self.image, threshold=self.threshold, knee=self.knee, limit=self.limit)
        glow = self._spread_exactly(draw, light) if self.exact else self._spread_levels(draw, light)
        if self.tint != _WHITE:
            glow = draw.point("bloom_tint", glow=glow, tint=self.tint)
        out = draw.point("bloom", self.image, glow=glow, intensity=self.intensity, mode=self.mode)
        return {"out": out, "glow": glow}

    def _spread_levels(self, draw: Draw, light: Pixels) -> Drawn:
        """The glow of the pyramid alone. What would lie on levels finer than the picture stays on its finest one."""
        fine, amounts = self._find_amounts(self.radius)
        amounts[0] += sum(amount for amount, _ in fine)
        return self._spread(draw, light, draw.size, _find_shares(amounts), self.edge)

    def _spread_exactly(self, draw: Draw, light: Pixels) -> Drawn:
        """A glow whose levels are all as wide as their octaves: level l has a variance of 1.5 * 4^l square pixels.

        The pyramid leaves 1.5 square pixels out at each level, which is all of it at its finest, the picture itself. So
        its light is blurred by that before, and what lies on levels that are finer than pixels by their mean variance.
        """
        variance = self.radius * self.radius
        missing = min(variance, _SHARPNESS)
        fine, amounts = self._find_amounts(math.sqrt(variance - missing))
        soft = draw.blur(light, math.sqrt(missing), self.edge)
        glow = self._spread(draw, soft, draw.size, _find_shares(amounts), self.edge)
        finest = sum(amount for amount, _ in fine)
        if finest <= 0.0:
            return glow
        narrow = sum(amount * missing * 4.0**level for amount, level in fine) / finest
        share = finest / (finest + sum(amounts))
        return draw.point("bloom_fine", glow=glow, fine=draw.blur(light, math.sqrt(narrow), self.edge), share=share)

    def _spread(
        self, draw: Draw, light: Pixels, size: Size, shares: list[float], edge: Edge, first: bool = True
    ) -> Drawn:
        """The glow of a level's light: half the size, spread there by the levels below, and back.

        A picture that goes on outside does so at half the size too, if its halves are whole. At the first level where
        they are not, it is padded by all that the levels below can reach, and cut to its size again.
        """
        if edge != "clamp" and not _can_halve(size, edge):
            margin = _LEVEL_REACH * 2 ** len(shares)
            wide = (size[0] + 2 * margin, size[1] + 2 * margin)
            spread = self._spread(draw, draw.pad(light, (margin, margin), edge), wide, shares, "clamp", first)
            return draw.pad(spread, (-margin, -margin))
        half = ((size[0] + 1) // 2, (size[1] + 1) // 2)
        steady = self.firefly and first
        shrink = "bloom_shrink_steady" if steady else "bloom_shrink"
        below = draw(shrink, image=light, size=half, edge=edge, overlap=3)
        if len(shares) > 1:
            below = self._spread(draw, below, half, shares[1:], edge, first=False)
        overlap = {"image": 3, "level": 0}
        return draw("bloom_grow", image=below, level=light, size=size, edge=edge, overlap=overlap, share=shares[0])

    def _find_amounts(self, sigma: float) -> tuple[list[tuple[float, int]], list[float]]:
        """How much light lies on each level: on those finer than the picture, with their numbers, and on the others."""
        last, part = _levels(sigma)
        fine: list[tuple[float, int]] = []
        amounts: list[float] = []
        rest = 1.0
        for level in range(min(last - _OCTAVES, 0), last + 2):
            octave = last + part - level  # from the radius to how wide this level is, in halvings
            share = self.scatter ** min(max(_OCTAVES + 1.0 - octave, 0.0), 1.0) * (part if level == last else 1.0)
            here = rest if level == last + 1 else rest * (1.0 - share)
            amount = here * max(curve_at(self.levels, 1.0 - octave / _OCTAVES), _FAINTEST)
            if level < 0:
                fine.append((amount, level))
            else:
                amounts.append(amount)
            rest -= here
        return fine, amounts


def _can_halve(size: Size, edge: Edge) -> bool:
    """True if the picture at half the size goes on at the same places outside. Half a turn of a panorama must be whole
    pixels there too.
    """
    return size[0] % (4 if edge == "panorama" else 2) == 0 and size[1] % 2 == 0


def _levels(sigma: float) -> tuple[int, float]:
    """The last level to halve, and its share, such that the glow's standard deviation is `sigma` pixels.

    Going down from level l and back up adds 4^l (1.75 + 2.75) square pixels: 1.5 (4^n - 1) for n halvings.
    """
    variance = sigma * sigma
    last = int(math.log(1.0 + variance / 1.5, 4.0))
    return last, (variance - 1.5 * (4.0**last - 1.0)) / (4.5 * 4.0**last)


def _find_shares(amounts: list[float]) -> list[float]:
    """Of every level, the part of its glow that comes from the levels below it."""
    below = [sum(amounts[level:]) for level in range(len(amounts) + 1)]
    return [below[level + 1] / below[level] if below[level] > 0.0 else 1.0 for level in range(len(amounts) - 1)]
