"""Rectangles, discs and tubes of light: what shaders/lib/area_light.glsl reads of them."""

from __future__ import annotations

import math

from .._declare import Light, LightKind

AREA_KINDS = (LightKind.RECTANGLE, LightKind.DISC, LightKind.TUBE)
"""The kinds in the order of their numbers in GLSL."""


def pack_area_light(light: Light, gain: float) -> tuple[float, ...]:
    """A light as four texels: its place, its radiance and its two half axes, and a fourth number of each.

    That of the place is the reach, that of the radiance the number of the kind; those of the axes are their lengths.
    The radiance is the intensity divided by the area that the light shows to what is straight in front of it.
    """
    (along, width), (across, height) = ((axis, math.hypot(*axis)) for axis in light.half_axes)
    area = (math.pi if light.kind is LightKind.DISC else 4.0) * width * height
    red, green, blue = (gain * light.gain * part / area for part in light.color)
    kind = float(AREA_KINDS.index(light.kind))
    return (*light.place, max(light.reach, 0.0), red, green, blue, kind, *along, width, *across, height)
