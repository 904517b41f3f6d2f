"""How lights throw pictures, their cookies: what shaders/lib/light_cookie.glsl reads of them."""

from __future__ import annotations

import math

from .._declare import Draw, Drawn, Light, LightKind

_CONE, _BEAM, _ROUND = 1.0, 2.0, 3.0
"""The numbers of the ways in GLSL: by a spot, by a sun, in all directions."""

_THROWS = {LightKind.SPOT: _CONE, LightKind.SUN: _BEAM, LightKind.POINT: _ROUND, LightKind.SPHERE: _ROUND}

_WIDEST = math.radians(89.0)
"""The widest half cone that a flat picture covers: that of 90 degrees would have no end."""


def tabulate_throws(draw: Draw, lights: list[Light]) -> Drawn:
    """Rows of numbers for GLSL, one for each light, all without an area."""
    return draw.table(tuple(part for light in lights for part in _pack_throw(light)) or (0.0,) * 16, 4)


def _pack_throw(light: Light) -> tuple[float, ...]:
    """A light as four texels: where it throws from and the way it does; to the left of the picture, and half the width
    there; up, and the number of the cookie; the direction.

    Half the width is that of the picture of a sun, and the tangent of half the cone of a spot.
    """
    left, up = light.sides
    way = _THROWS.get(light.kind, 0.0) if light.cookie else 0.0
    origin = (0.0, 0.0, 0.0) if light.kind is LightKind.SUN else light.place
    half = light.cookie_width / 2.0 if light.kind is LightKind.SUN else math.tan(min(light.outer, _WIDEST))
    return (*origin, way, *left, half, *up, float(light.cookie), *light.aim, 0.0)
