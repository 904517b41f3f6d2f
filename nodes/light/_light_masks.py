"""What limits single lights: shadows of what the picture shows, and mattes. See shaders/lib/light_shadow.glsl."""

from __future__ import annotations

import math
from typing import Any

from .._declare import CameraModel, Draw, Drawn, Light, LightKind, Pixels, Socket, Vector
from ._area_lights import AREA_KINDS
from ._march import surfaces

BATCH = 4
"""Lights whose masks share a picture, one in each channel."""

_RAYS = 4
"""Rays from a pixel to a light with a size, as many as contact shadows take; 16 neighbors lend theirs."""

_KINDS = {LightKind.SUN: 0.0, LightKind.POINT: 1.0, LightKind.SPOT: 1.0, LightKind.SPHERE: 1.0, LightKind.DISC: 2.0}
"""The numbers of the shapes in GLSL."""

_RECTANGLE = 3.0
"""The number of all other shapes."""


def is_limited(light: Light) -> bool:
    """True for a light that does not light everything alike."""
    return light.shadow or light.matte != 0 or light.cookie != 0


def draw_masks(
    draw: Draw,
    lights: list[Light],
    pictures: dict[str, Pixels],
    camera: CameraModel | None,
    mattes: tuple[Socket, ...],
    reach: float,
    thickness: float,
) -> Drawn:
    """A picture with how much each of up to four lights reaches a pixel, 0 to 1. `pictures` are normals and depths.

    Without a camera nothing casts shadows.
    """
    open_lights: Drawn | tuple[float, ...] = (1.0,) * BATCH
    if camera is not None and any(light.shadow for light in lights):
        pictures = {
            "normal": pictures["normal"],
            "surfaces": surfaces(draw, pictures["depth"], "deferred_lighting", camera.inverse),
        }
        shapes = draw.table(tuple(part for light in lights for part in _pack_shape(light)), 3)
        texels = Vector(width=BATCH)
        view: dict[str, Any] = {"rows": camera.rows, "rays": camera.inverse}
        open_lights = draw(
            "deferred_lighting_open",
            **pictures,
            lamps=shapes,
            result=texels,
            **view,
            count=len(lights),
            reach=reach,
            thickness=thickness,
            samples=_RAYS,
        )
        if any(_is_soft(light) for light in lights):
            soft = tuple(float(_is_soft(light)) for light in lights) + (0.0,) * (BATCH - len(lights))
            open_lights = draw(
                "deferred_lighting_smooth", **pictures, open=open_lights, result=texels, **view, soft=soft
            )
    choices = tuple(float(light.matte) for light in lights) + (0.0,) * (BATCH - len(lights))
    return draw.point("deferred_lighting_limit", *mattes, open=open_lights, choices=choices, result=Vector(width=BATCH))


def _is_soft(light: Light) -> bool:
    """True for a light whose shadows have soft edges."""
    return light.shadow and (_find_radius(light) > 0.0 or light.kind in AREA_KINDS)


def _find_radius(light: Light) -> float:
    """The radius of a round light; of a sun that at a distance of 1."""
    return {LightKind.SUN: math.tan(light.angle / 2.0), LightKind.SPHERE: light.size}.get(light.kind, 0.0)


def _pack_shape(light: Light) -> tuple[float, ...]:
    """A light as three texels: place or direction and shape; a half axis and a radius; another one, and if it is soft.

    The shape of a light without shadows is -1.
    """
    place = tuple(-part for part in light.aim) if light.kind is LightKind.SUN else light.place
    along, across = light.half_axes
    shape = _KINDS.get(light.kind, _RECTANGLE) if light.shadow else -1.0
    return (*place, shape, *along, _find_radius(light), *across, float(_is_soft(light)))
