"""The lamps of `deferred_lighting` as numbers of a script."""

from __future__ import annotations

import math
from typing import Any

from halation.nodes import LightKind, light_of
from halation.nodes.light._blackbody import blackbody_rec709

from ...errors import GraphError

_KNOWN = (LightKind.POINT, LightKind.SPOT, LightKind.SUN, LightKind.SPHERE)
"""Kinds of lights whose formulas scripts have: those of areas are integrals by a table."""

_LEAST_RADIUS = 1e-4
"""The least radius of a ball of light, as in the renderer: a point would be divided by."""


def list_lamps(node: Any, path: str) -> dict[str, Any]:
    """The lamps that shine, each as its kind and numbers, and how strong ambient light is: none beside solo lamps.

    Raises GraphError for a light that scripts do not know.
    """
    for name, item in node.lights.items():
        light = light_of(item)
        if light.on and light.kind not in _KNOWN:
            raise _refuse(path, f"its light '{name}' is a {light.kind}, and numpy text knows {', '.join(_KNOWN)} alone")
        if light.on and (light.shadow or light.matte or light.cookie):
            raise _refuse(
                path, f"its light '{name}' has a shadow, a matte or a cookie, and numpy text has none of them"
            )
    lights = node.list_lights()
    tints = [blackbody_rec709(light.temperature) if light.temperature else (1.0, 1.0, 1.0) for light in lights]
    lamps = tuple(
        (
            str(light.kind),
            light.place,
            light.aim,
            tuple(light.gain * part * shade for part, shade in zip(light.color, tint, strict=True)),
            max(light.reach, 0.0),
            max(light.size, _LEAST_RADIUS) if light.kind is LightKind.SPHERE else 0.0,
            math.radians(light.inner),
            math.radians(light.outer),
        )
        for light, tint in zip(lights, tints, strict=True)
    )
    return {"lamps": lamps, "ambient_intensity": 0.0 if any(light.solo for light in lights) else node.ambient_intensity}


def _refuse(path: str, fault: str) -> GraphError:
    return GraphError(f"node '{path}': {fault}: switch it off, or write it with --to glsl", node=path)
