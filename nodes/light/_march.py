"""What rays march through: the picture of all surfaces of shaders/lib/march.glsl."""

import math
from typing import Any

from .._declare import Draw, Drawn, Pixels, Vector

_LEVELS = 3
"""How often cells of 4 x 4 are joined: a ray then crosses a picture of 1920 pixels in 30 of the largest cells."""


def surfaces(draw: Draw, depth: Pixels, owner: str, solid: tuple[float, ...] | None = None, **limits: Any) -> Drawn:
    """Every pixel as a small plane, and below them what cells of 4, 16 and 64 pixels hold.

    The owner's GLSL file has a function for each of the three draws, which calls the one of march.glsl. With `solid`,
    the rays of the camera, objects are as deep as they are wide, within the limits that the owner's draw takes: see
    shaders/lib/solid.glsl.
    """
    width, height = draw.size
    cells = [(-(-width // 4**level), -(-height // 4**level)) for level in range(1, _LEVELS + 1)]
    texels = Vector(width=4)
    planes = draw(f"{owner}_planes", depth=depth, edge="black", result=texels)
    if solid is not None:
        runs = draw(f"{owner}_neighbors", planes=planes, edge="black", result=texels, rays=solid)
        for doubling in range(math.ceil(math.log2(max(width, height)))):
            runs = draw(f"{owner}_runs", runs=runs, edge="black", result=texels, reach=2**doubling)
        planes = draw(f"{owner}_solid", planes=planes, runs=runs, edge="black", result=texels, rays=solid, **limits)
    bounds = draw(f"{owner}_bounds", planes=planes, edge="black", size=cells[0], result=texels)
    whole = (max(width, sum(across for across, _ in cells)), height + cells[0][1])
    return draw(f"{owner}_surfaces", planes=planes, bounds=bounds, edge="black", size=whole, result=texels)
