"""Light and fog of a scene, from its depth and normals."""

from __future__ import annotations

from typing import Literal

import numpy as np

from .cameras import camera_axes, camera_back, camera_rays
from .pixels import Array, dot, join, length, mix, rgb
from .places import shift_picture
from .render_layers import nearness, unit_normals


def view_rays(normal: Array, camera: Array | None) -> Array:
    """The vectors along which pixels are seen; without a camera, normals are in the axes of the view."""
    height, width = normal.shape[:2]
    return np.array([[[0.0, 0.0, -1.0]]]) if camera is None else camera_rays(camera, width, height)


def facing(normal: Array, camera: Array | None = None) -> Array:
    """How much surfaces face the camera: the cosine between the normal and the way to it.

    Where antialiasing has mixed several normals (it makes them shorter), the mean of the pixels around that show one
    surface.
    """
    unit, ray = unit_normals(normal), view_rays(normal, camera)
    here, clear = np.clip(-dot(unit, ray) / length(ray), 0.0, 1.0), (length(normal) >= 0.98) * 1.0
    around = [(right, down) for down in (-1, 0, 1) for right in (-1, 0, 1)]
    total = np.sum([shift_picture(clear * here, *step) for step in around], axis=0)
    count = np.sum([shift_picture(clear, *step) for step in around], axis=0)
    mean = np.where((clear > 0.0) | (count == 0.0), here, total / np.maximum(count, 1.0))
    return np.where(length(unit) > 0.0, mean, 0.0)


def rim_light(
    image: Array,
    normal: Array,
    color: tuple[float, ...],
    intensity: float,
    power: float,
    focus: float,
    angle: float,
    mask: Array | float = 1.0,
    camera: Array | None = None,
) -> tuple[Array, Array]:
    """Add light along rims, (1 - facing)^power, from all around or from one side: the picture, and the rim."""
    unit, ray, (right, down, _) = unit_normals(normal), view_rays(normal, camera), camera_axes(camera)
    away = 1.0 - facing(normal, camera)
    across = unit - ray * dot(unit, ray) / dot(ray, ray)  # the direction of the rim in the picture
    toward = dot(across, np.cos(angle) * right - np.sin(angle) * down) / np.maximum(length(across), 1e-6)
    rim = away**power * mix(1.0, 0.5 + 0.5 * np.clip(toward, -1.0, 1.0), focus)
    rim = np.where(length(unit) > 0.0, rim, 0.0)
    amount = rim * np.clip(mask, 0.0, 1.0) * np.clip(image[..., 3:], 0.0, 1.0)
    light = intensity * color[3] * rgb(color)
    return join(image[..., :3] + light * amount, image[..., 3:]), rim


def layer_of_fog(density: Array | float, way: Array, start: Array, end: Array) -> Array:
    """The optical depth of fog whose density falls as exp(-height), along a way between two heights (Wenzel 2006).

    It is the exact integral: the density at the lower height times the mean of exp(-x).
    """
    rise = np.minimum(np.abs(end - start), 80.0)
    small = rise < 0.05
    series = 1.0 - rise * (0.5 - rise * (1.0 / 6.0 - rise / 24.0))
    mean = np.where(small, series, (1.0 - np.exp(-rise)) / np.where(small, 1.0, rise))
    return density * way * np.exp(np.clip(-np.minimum(start, end), -80.0, 80.0)) * mean


def fog_on_ground(
    depth: Array,
    way: Array,
    density: Array | float,
    start: Array | float,
    base: Array | float,
    thickness: Array | float,
    axis: int,
    eye: Array | float,
    position: Array | None,
    camera: Array | None,
) -> Array:
    """The optical depth of a layer on the ground, along the rays of a camera or down to known places."""
    height, width = depth.shape[:2]
    there = nearness(depth) > 0.0
    if camera is not None:
        ray = camera_rays(camera, width, height)
        rise = ray[..., axis : axis + 1] / length(ray) / thickness
        first = (camera_back(camera)[axis, 3] - base) / thickness + start * rise
        above = density * np.exp(np.clip(-first, -80.0, 80.0)) / np.where(rise > 0.0, rise, 1.0)
        above = np.where(rise > 0.0, above, 1e10)
        return np.where(there, layer_of_fog(density, way, first, first + np.where(there, way, 0.0) * rise), above)
    if position is not None:
        first = np.subtract(eye, base) / thickness
        last = (np.where(there, position[..., axis : axis + 1], 0.0) - base) / thickness
        near = np.minimum(start / np.where(there, depth, 1e10), 1.0)
        return np.where(there, layer_of_fog(density, way, mix(first, last, near), last), density * way)
    return density * way


def fog(
    image: Array,
    depth: Array,
    mode: Literal["linear", "exponential", "exponential squared", "height"],
    color: tuple[float, ...],
    density: Array | float,
    start: Array | float,
    end: Array | float,
    base: Array | float,
    thickness: Array | float,
    up: str,
    eye: Array | float,
    sky: Array | float,
    alpha: str,
    sun: Array | float,
    sun_color: tuple[float, ...],
    sun_direction: tuple[float, ...],
    sun_focus: Array | float,
    position: Array | None = None,
    camera: Array | None = None,
) -> tuple[Array, Array]:
    """Add fog that hides more with the depth (the three kinds of fog of OpenGL), or a layer on the ground: the picture,
    and what fog hides. With a camera the distance is along its rays, and fog glows toward the sun.
    """
    ray = np.ones((1, 1, 3)) if camera is None else camera_rays(camera, depth.shape[1], depth.shape[0])
    there = nearness(depth) > 0.0
    far = np.where(there, depth * (1.0 if camera is None else length(ray)), 1e10)
    way = np.maximum(far - start, 0.0)
    if mode == "linear":
        hidden = np.where(there, np.clip(way / np.maximum(np.subtract(end, start), 1e-6), 0.0, 1.0), sky)
    else:
        thick = density * way
        if mode == "exponential squared":
            thick = thick**2
        if mode == "height":
            axis = 2 if up == "z" else 1
            thick = fog_on_ground(depth, way, density, start, base, thickness, axis, eye, position, camera)
        hidden = (1.0 - np.exp(-np.minimum(thick, 80.0))) * np.where(there, 1.0, sky)
    hidden = color[3] * hidden
    light = np.broadcast_to(rgb(color), (1, 1, 3))
    if camera is not None and any(sun_direction):
        along = dot(ray, np.divide(sun_direction, np.linalg.norm(sun_direction))) / length(ray)
        light = mix(light, rgb(sun_color), sun * np.where(along > 0.0, np.maximum(along, 0.0) ** sun_focus, 0.0))
    covered = np.clip(image[..., 3:], 0.0, 1.0) if alpha == "keep" else 1.0
    shown = image[..., 3:] if alpha == "keep" else image[..., 3:] * (1.0 - hidden) + hidden
    return join(image[..., :3] * (1.0 - hidden) + light * hidden * covered, shown), hidden
