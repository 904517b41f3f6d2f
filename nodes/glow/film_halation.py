import math
from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Literal

from .._declare import RGBA, Doc, Draw, Drawn, Filter, Fraction, Image, OutputSocket, Slider, Trait

_NO_LIMIT = 65504.0
"""The largest half float: nothing that passes keep is brighter."""

_SMOOTH = 2.0
"""The sigma of the narrowest blur that a smaller size must still have, in its pixels: then its grid is not seen in the
picture that is enlarged by tents. Chosen by judgement."""

_INDEX = 1.48
"""Refractive index of cellulose triacetate."""

_CRITICAL = math.asin(1.0 / _INDEX)
"""Light that meets the back of the base at less than this angle, 42.5 degrees, mostly leaves the film."""

_STRAIGHT = ((_INDEX - 1.0) / (_INDEX + 1.0)) ** 2
"""What is reflected of light that meets the back at a right angle (Fresnel)."""

_LOST = 0.416
"""What leaves the film of light that enters the base in all directions (Lambert): sin^2 of the critical angle, less the
Fresnel reflection within it."""

_SIGMAS = (0.22, 0.33, 0.5, 0.74, 1.11, 1.67, 2.5, 3.76)
"""The Gaussians that the halo is mixed from, in thicknesses of the light's way: twice that of the base."""


_VISIBLE_SIGMAS = 4.0
"""How far a Gaussian is seen, as blurs cut it off: 6e-5 of its light lies beyond."""


class FilmHalation(Filter):
    """Give bright light the red-orange halo that it has on film.

    Light that passes through the emulsion spreads in the film base, is reflected at its back and exposes the emulsion
    again from behind. It exposes mostly the red-sensitive layer, which lies deepest, less the green-sensitive one above
    it, and hardly the blue-sensitive one, which lies on top behind a yellow filter. Rays that are flatter than the
    critical angle, asin(1 / 1.48) for triacetate, are reflected completely. So the halo is brightest in a ring of
    radius `2 t tan(angle)`: 0.24 mm for a base of t = 0.13 mm, which is 0.015 of the 16 mm height of a Super 35 frame.

    Light that enters the base in all directions comes back as `b^2 / (pi (r^2 + b^2)^2)` with b = 2 t. The 42 percent
    that leave the film within the critical angle are subtracted as a narrow Gaussian, so that in the middle only the
    Fresnel reflection is left. Flat rays cross more emulsion, so that the upper layers get a smaller halo. An
    anti-halation backing (remjet) absorbs nearly all of this light; film without it glows. (Kodak, "The Essential
    Reference Guide for Filmmakers"; Mees and James, "The Theory of the Photographic Process".)

    The halo of a channel is `amount * color` times the light of the channel above the threshold, and is added to the
    picture. `glow` is the halo alone. Alpha is kept.
    """

    aliases = ("halation", "red glow", "film glow")
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT)

    image = Image()
    amount: Annotated[
        float,
        Slider(
            0.0,
            0.58,
            unit="ratio",
            minimum=0.0,
            maximum=16.0,
            doc="How much of the bright light comes back. 0: the backing absorbs all of it; 0.58: there is no backing.",
        ),
    ] = 0.2
    color: Annotated[RGBA, Doc("How much of that light the red, green and blue layers absorb.")] = (
        1.0,
        0.15,
        0.02,
        1.0,
    )
    radius: Annotated[
        float,
        Slider(
            0.0,
            0.06,
            unit="height",
            minimum=0.0,
            maximum=0.5,
            doc="Radius of the ring: 0.015 for Super 35, 0.032 for 16 mm film, 0.01 for a still of 24 x 36 mm.",
        ),
    ] = 0.015
    reach: Annotated[
        tuple[float, float, float],
        Slider(
            0.5,
            1.0,
            unit="ratio",
            minimum=0.5,
            maximum=1.0,
            doc="The radius of the halo in red, green and blue, as a part of the radius above.",
        ),
    ] = (1.0, 0.85, 0.7)
    threshold: Annotated[
        tuple[float, float, float],
        Slider(
            0.0,
            10.0,
            unit="scene",
            minimum=0.0,
            doc="Only light above this gets through the layers, in red, green and blue.",
        ),
    ] = (1.0, 1.0, 1.0)
    knee: Annotated[Fraction, Doc("Softness of the threshold: the part of it over which light fades in.")] = 0.5
    limit: Annotated[
        float,
        Slider(
            1.0,
            1000.0,
            unit="scene",
            minimum=0.0,
            maximum=_NO_LIMIT,
            doc="The largest light in a channel that comes back, to limit suns and noise; 65504 is no limit.",
        ),
    ] = 200.0
    edge: Annotated[
        Literal["clamp", "reflect", "wrap", "panorama"],
        Doc("What lies outside the picture. Wrap and panorama leave no seam in pictures that go on."),
    ] = "clamp"

    out = OutputSocket()
    glow = OutputSocket()

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        way = self.radius / math.tan(_CRITICAL)
        # Every Gaussian with its share in red, green and blue: layers that see the same halo have the same ones.
        gaussians: dict[float, list[float]] = {}
        for layer, reach in enumerate(self.reach):
            for sigma, share in _mixture(min(max(reach, 0.5), 1.0)):
                gaussians.setdefault(sigma, [0.0, 0.0, 0.0])[layer] += share
        factor = _factor(min(gaussians) * way)
        light = draw.point(
            "film_halation_light", self.image, threshold=self.threshold, knee=self.knee, limit=self.limit
        )
        margin = math.ceil(_VISIBLE_SIGMAS * max(gaussians) * way) if self.edge != "clamp" else 0
        if margin:
            light = draw.pad(light, (margin, margin), self.edge)
        full = draw.size_of(light)
        size = (-(-full[0] // factor), -(-full[1] // factor))
        if factor > 1:
            light = draw("film_halation_shrink", image=light, size=size, overlap=2 * factor, factor=factor)
        # What shrinking (a box) and enlarging (a tent) blur themselves.
        resampling_variance = (factor**2 - 1.0) / 12.0 + factor**2 / 6.0 if factor > 1 else 0.0
        halo = draw.point("film_halation_none", light=light)
        for sigma, share in gaussians.items():
            soft = draw.blur(light, math.sqrt(max((sigma * way) ** 2 - resampling_variance, 0.0)) / factor)
            halo = draw.point("film_halation_add", halo=halo, soft=soft, share=tuple(share))
        if factor > 1:
            halo = draw("film_halation_enlarge", image=halo, size=full, overlap=3, factor=factor)
        if margin:
            halo = draw.pad(halo, (-margin, -margin))
        glow = draw.point("film_halation_glow", self.image, halo=halo, amount=self.amount, color=self.color)
        return {"out": draw.point("film_halation", self.image, glow=glow), "glow": glow}


def _factor(sigma: float) -> int:
    """How much smaller the picture may be for a blur of `sigma` pixels and wider ones."""
    return next((factor for factor in (4, 2) if sigma >= _SMOOTH * factor), 1)


def _mixture(reach: float) -> list[tuple[float, float]]:
    """Sigmas and shares of the Gaussians that make a halo `reach` times as large. The shares add up to 1.

    `b^2 / (pi (r^2 + b^2)^2)` is a mixture of Gaussians whose variances v are distributed as exp(-b^2 / 2 v): each of
    ours stands for those around it.
    """
    precisions = [(reach / sigma) ** 2 for sigma in _SIGMAS]
    bounds = [0.0, *(math.exp(-0.5 * math.sqrt(a * b)) for a, b in pairwise(precisions)), 1.0]
    back = [above - below for below, above in pairwise(bounds)]
    # Taken off: as much as leaves the film, so narrow that in the middle only what is reflected straight stays.
    variance = 0.5 * _LOST / (1.0 - _STRAIGHT)
    lost = (1.0 - _STRAIGHT) * variance * sum(a * b for a, b in zip(back, precisions, strict=True))
    mixture = [(sigma, share / (1.0 - lost)) for sigma, share in zip(_SIGMAS, back, strict=True)]
    return [*mixture, (math.sqrt(variance) * reach, -lost / (1.0 - lost))]
