"""Lights as tables of numbers, and which of them reach which tile of the picture, for `deferred_lighting`."""

from __future__ import annotations

import math
from typing import Any

from .._declare import Draw, Drawn, Light, LightKind, Vector
from ._area_lights import AREA_KINDS, pack_area_light
from ._blackbody import blackbody_rec709

_ENDLESS = 1e18
"""A radius that holds every scene, and whose square a float of 32 bits can hold."""

_LEAST_SIZE = 1e-4
"""The least radius of a ball of light, in units of the scene: a point would be divided by."""

_LEAST_CONE = 1e-4
"""The least difference of the cosines of both cones of a spot, over which its light falls off: a sharp edge."""

_LARGER, _ROUNDING = 1.0001, 1e-6
"""What makes up for the rounding of floats, 6e-8: a part of the radius, and of the largest coordinate."""

TILE = 16
"""Pixels across a tile."""

FEW = 8
"""Up to so many lights, each pixel loops over all of them, and no tiles are made. A choice: in the preset night_relight
at 960x540, with a reach of 1, tiles take 0.93, 0.89, 0.79 and 0.68 of the time for 2, 4, 8 and 16 lights of the swarm;
lights that reach farther gain less."""

_BITS = 24
"""Lights to a channel of a texel: as many as a float holds exactly."""


def sort_lamps(draw: Draw, place: Drawn, lights: list[Light], gain: float) -> dict[str, Any]:
    """The lights without an area as a table, and the words of bits that say which of them reach which tile.

    A few lights are not sorted, nor lights without a reach: all of them are in every tile.
    """
    texels = max(1, -(-len(lights) // (4 * _BITS)))
    tiled = len(lights) > FEW and any(_ball(light)[3] < math.inf for light in lights)
    words = _sort_into_tiles(draw, place, lights, texels) if tiled else draw.table(_all(len(lights), texels), texels)
    return {"lights": tabulate_lights(draw, lights, gain), "words": words, "texels": texels, "tiled": tiled}


def tabulate_lights(draw: Draw, lights: list[Light], gain: float) -> Drawn:
    """Rows of numbers for GLSL, one for each light; the second texel of a row is a color. All are areas, or none.

    Temperatures become colors in GLSL, as only that knows the working space.
    """
    pack = pack_area_light if lights and lights[0].kind in AREA_KINDS else _pack_light
    rows = [pack(light, gain) for light in lights]
    width = len(rows[0]) // 4 if rows else 3
    table = draw.table(tuple(part for row in rows for part in row), width)
    if not any(light.temperature for light in lights):
        return table
    colors = [blackbody_rec709(light.temperature) if light.temperature else (1.0,) * 3 for light in lights]
    return draw(
        "deferred_lighting_tint",
        table=table,
        tints=draw.table(tuple(part for color in colors for part in (*color, 1.0)), 1),
        heated=draw.table(tuple(part for light in lights for part in (float(light.temperature > 0.0),) * 4), 1),
        size=(width, len(lights)),
        result=Vector(width=4),
    )


def _sort_into_tiles(draw: Draw, place: Drawn, lights: list[Light], texels: int) -> Drawn:
    """Which lights can reach which tile: see the GLSL."""
    width, height = (-(-length // TILE) for length in draw.size)
    low, high = (
        draw(
            "deferred_lighting_corner",
            place=place,
            size=(width, height),
            overlap=2 * TILE,
            result=Vector(width=4),
            side=side,
        )
        for side in (1.0, -1.0)
    )
    balls = draw.table(tuple(part for light in lights for part in _ball(light, _ENDLESS)), 1)
    return draw(
        "deferred_lighting_tile",
        low=low,
        high=high,
        balls=balls,
        size=(width * texels, height),
        result=Vector(width=4),
        count=len(lights),
        texels=texels,
    )


def _pack_light(light: Light, gain: float) -> tuple[float, ...]:
    """What the GLSL reads of a light, as three texels.

    The place, or the way to a sun; the reach, 0 for none. The color times the intensity; the radius, -1 for a sun. What
    takes the way to the light to a cosine between the cones of a spot.
    """
    kind = light.kind
    red, green, blue = (gain * light.gain * part for part in light.color)
    x, y, z = light.aim
    reach = 0.0 if kind is LightKind.SUN else max(light.reach, 0.0)
    size = max(light.size, _LEAST_SIZE) if kind is LightKind.SPHERE else -1.0 if kind is LightKind.SUN else 0.0
    cone = (0.0, 0.0, 0.0, 1.0)
    if kind is LightKind.SPOT:
        outer = math.cos(light.outer)
        scale = 1.0 / max(math.cos(min(light.inner, light.outer)) - outer, _LEAST_CONE)
        cone = (-x * scale, -y * scale, -z * scale, -outer * scale)
    place = (-x, -y, -z) if kind is LightKind.SUN else light.place
    return (*place, reach, red, green, blue, size, *cone)


def _ball(light: Light, endless: float = math.inf) -> tuple[float, float, float, float]:
    """A ball, middle and radius, in which all lies that a light can reach. A little larger, as floats are rounded."""
    if light.reach <= 0.0 or light.kind is LightKind.SUN:
        return (0.0, 0.0, 0.0, endless)
    along, radius = 0.0, light.reach
    if light.kind is LightKind.SPOT and light.outer < math.pi / 2:
        angle = light.outer
        along = radius / (2.0 * math.cos(angle)) if angle < math.pi / 4 else radius * math.cos(angle)
        radius = along if angle < math.pi / 4 else radius * math.sin(angle)
    x, y, z = (place + along * part for place, part in zip(light.place, light.aim, strict=True))
    return (x, y, z, _LARGER * radius + _ROUNDING * max(map(abs, (*light.place, x, y, z))))


def _all(count: int, texels: int) -> tuple[float, ...]:
    """The words of a tile that every light can reach."""
    lengths = (min(max(count - first, 0), _BITS) for first in range(0, 4 * _BITS * texels, _BITS))
    return tuple(float(2**length - 1) for length in lengths)
