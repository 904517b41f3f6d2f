"""What noisy lights share: a filter guided by variance, and pictures at several sizes to take samples from."""

from __future__ import annotations

from typing import Any

from .._declare import Draw, Drawn, Image, Pixels, Size, Vector

LIGHT = Vector(width=4)

SPREAD = Vector(width=3)
"""The variance, the width of the blur in pixels, and the roughness: see shaders/lib/denoise.glsl."""

_LEVELS = 6
"""As PREFILTERED_LEVELS."""

_CONTRAST = 2.0
"""Standard deviations by which light may differ: of 1, 2, 4 and 10 this had the least error in a room with lamps."""


def prefilter(draw: Draw, id: str, image: Image) -> Drawn:
    """An image at several sizes in one picture, for shaders/lib/prefiltered.glsl, by functions of node `id`."""
    width, height = draw.size_of(image)
    halves: list[Drawn] = []
    sizes: list[Size] = []
    smaller: Pixels = image
    for level in range(1, _LEVELS + 1):
        sizes.append((-(-width // 2**level), -(-height // 2**level)))
        smaller = draw(f"{id}_half", image=smaller, size=sizes[-1], edge="black", result=LIGHT)
        halves.append(smaller)
    whole = (width + sizes[0][0], max(height, sum(down for _, down in sizes)))
    levels: dict[str, Any] = {f"half{level}": half for level, half in enumerate(halves, 1)}
    return draw(f"{id}_levels", image=image, **levels, size=whole, edge="black", result=LIGHT)


def denoise(
    draw: Draw,
    id: str,
    guide: Drawn,
    light: Drawn,
    spread: Drawn,
    rays: tuple[float, ...],
    count: int,
    strides: tuple[int, ...],
) -> Drawn:
    """Light without the noise of few samples, by functions of node `id`.

    The pattern of noise repeats after 4 x 4 pixels: the mean over one period removes most of it. The levels after it
    are steps of an a-trous filter, each with its samples farther apart, so that few samples cover a wide area. They do
    not mix light that differs by more than its variance (`spread`) explains.
    """
    light, spread = draw.several(
        f"{id}_period", (LIGHT, SPREAD), guide=guide, light=light, spread=spread, rays=rays, count=count
    )
    for stride in strides:
        light, spread = draw.several(
            f"{id}_level",
            (LIGHT, SPREAD),
            guide=guide,
            light=light,
            spread=spread,
            rays=rays,
            stride=stride,
            contrast=_CONTRAST,
        )
    return light
