"""Cameras, and what follows from depth, positions and normals.

A camera is a matrix [3, 4]: it takes a place in the world (x, y, z, 1) to (u d, v d, d). u and v are parts of the
picture from its top left, d is the planar depth, positive in front.
"""

from __future__ import annotations

import itertools

import numpy as np

from .pixels import Array, dot, length, smoothstep
from .places import grid, pixels_at, shift_picture
from .render_layers import FAR, nearness, unit_normals

NOTHING = 1e10  # the depth of the background


def camera(
    eye: tuple[float, ...],
    target: tuple[float, ...],
    focal: float,
    sensor: float,
    up: str,
    columns: int,
    rows: int,
) -> Array:
    """A camera at `eye` that has `target` in the middle; the field of view is 2 atan(sensor / (2 focal)) across."""
    across = focal / sensor
    forward = np.subtract(target, eye) / np.linalg.norm(np.subtract(target, eye))
    right = np.cross(forward, (0.0, 0.0, 1.0) if up == "z" else (0.0, 1.0, 0.0))
    if np.linalg.norm(right) < 1e-9:  # straight up or down
        right = np.cross(forward, (0.0, 1.0, 0.0))
    right = right / np.linalg.norm(right)
    down = np.cross(forward, right)
    axes = [across * right + 0.5 * forward, across * columns / rows * down + 0.5 * forward, forward]
    return np.array([[*axis, -np.dot(axis, eye)] for axis in axes])


def camera_back(camera: Array) -> Array:
    """The matrix that takes (u d, v d, d, 1) to a place in the world; its last column is the place of the camera."""
    turned = np.linalg.inv(camera[:, :3])
    return np.column_stack([turned, -turned @ camera[:, 3]])


def parts_of_picture(width: int, height: int) -> Array:
    """u and v of the centers of all pixels [height, width, 2]."""
    return grid(width, height) / (width, height)


def camera_rays(camera: Array, width: int, height: int) -> Array:
    """The vectors from the camera to the points at depth 1: their length is the ratio of distance to depth."""
    seen = np.concatenate([parts_of_picture(width, height), np.ones((height, width, 1))], axis=-1)
    return seen @ camera_back(camera)[:, :3].T


def is_place(position: Array) -> Array:
    """Where there is a surface, as a Field: renderers write the origin for the background."""
    return (np.isfinite(position).all(axis=-1) & (position != 0.0).any(axis=-1))[..., None]


def position_from_depth(depth: Array, camera: Array) -> Array:
    """The place of every pixel in the world, eye + depth ray; the origin on the background."""
    height, width = depth.shape[:2]
    there = nearness(depth) > 0.0
    place = camera_back(camera)[:, 3] + np.where(there, depth, 0.0) * camera_rays(camera, width, height)
    return np.where(there, place, 0.0)


def depth_from_position(position: Array, camera: Array) -> Array:
    """The depth of places along the axis of the camera; 1e10 on the background and behind it."""
    there = is_place(position)
    depth = np.where(there, position, 0.0) @ camera[2:, :3].T + camera[2, 3]
    return np.where(there & (depth > 0.0) & (depth < FAR), depth, NOTHING)


def slope_of_nearness(near: Array, right: int, down: int) -> Array:
    """The relative growth of nearness from one pixel to the next, on the side that shows the same surface.

    Nearness is linear on planes: where it bends far more on one side, that is another surface (Wu 2021).
    """
    here = np.where(near > 0.0, near, 1.0)
    first, second = (shift_picture(near, -step * right, -step * down, "black") for step in (1, 2))
    next_one, after = (shift_picture(near, step * right, step * down, "black") for step in (1, 2))
    bends, sides = [], []
    for beside, beyond in ((first, second), (next_one, after)):
        beside, beyond = np.minimum(beside / here, 1e9), np.minimum(beyond / here, 1e9)
        bend = np.where(beyond == 0.0, np.abs(beside - 1.0), np.abs(beyond - 2.0 * beside + 1.0))
        bends.append(bend + 1e-6)
        sides.append(beside)
    before = bends[0] / (bends[0] + bends[1])
    share = 0.5 * (smoothstep(0.1, 0.35, before) + smoothstep(0.65, 0.9, before))
    share = np.where(first <= 0.0, 1.0, share)
    share = np.where(next_one <= 0.0, 0.0, share)
    slope = (1.0 - sides[0]) * (1.0 - share) + (sides[1] - 1.0) * share
    return np.where((first <= 0.0) & (next_one <= 0.0), 0.0, slope)


def tangent_normals(depth: Array, camera: Array) -> Array:
    """Normals of the planes that touch the surface: on planes 1 / depth is linear in the picture."""
    height, width = depth.shape[:2]
    near, uv = nearness(depth), parts_of_picture(width, height)
    across, down = width * slope_of_nearness(near, 1, 0), height * slope_of_nearness(near, 0, 1)
    ahead = 1.0 - uv[..., :1] * across - uv[..., 1:] * down
    normal = -(across * camera[0, :3] + down * camera[1, :3] + ahead * camera[2, :3])
    return np.where(near > 0.0, normal / np.maximum(length(normal), 1e-30), 0.0)


def curvature_of_forms(across: Array, down: Array, turn_across: Array, turn_down: Array) -> tuple[Array, Array, Array]:
    """Twice the area times the mean curvature, the area squared, and whether there is any (do Carmo 1976).

    `across` and `down` are steps of the place on a surface, `turn_across` and `turn_down` those of its normal.
    """
    e, f, g = dot(across, across), dot(across, down), dot(down, down)
    area = e * g - f * f
    crossed = dot(turn_across, down) + dot(turn_down, across)
    return dot(turn_across, across) * g - crossed * f + dot(turn_down, down) * e, area, area > 1e-6 * e * g


def change_on_surface(depth: Array, normal: Array, camera: Array, right: int, down: int) -> tuple[Array, Array]:
    """How place and normal change from one neighbor to the other; one on another surface is left out.

    On the same surface, also across a crease, one of two points is close to the plane that touches the other.
    """
    height, width = depth.shape[:2]
    rays, back = camera_rays(camera, width, height), camera_back(camera)
    seen = np.where(np.isfinite(depth), depth, 0.0)
    place = seen * rays
    pace = back[:, 0] * right / width + back[:, 1] * down / height
    most = seen * np.linalg.norm(pace)
    way = turn = np.zeros_like(normal)
    for sign in (-1, 1):
        other = shift_picture(normal, sign * right, sign * down, "black")
        step = shift_picture(place, sign * right, sign * down, "black") - place
        near = np.minimum(np.abs(dot(step, normal)), np.abs(dot(step, other))) <= most
        there = near & (other != 0.0).any(axis=-1, keepdims=True)
        way, turn = way + sign * np.where(there, step, 0.0), turn + sign * np.where(there, other - normal, 0.0)
    return way, turn


def normal_from_depth(depth: Array, camera: Array, reach: float) -> tuple[Array, Array]:
    """Normals from depth, and the mean curvature: 1 / r on a ball, below 0 in hollows; 0 on the background."""
    normal, far = tangent_normals(depth, camera), max(round(reach), 1)
    across, turn_across = change_on_surface(depth, normal, camera, far, 0)
    down, turn_down = change_on_surface(depth, normal, camera, 0, far)
    bend, area, is_area = curvature_of_forms(across, down, turn_across, turn_down)
    size = dot(across, across) + dot(down, down)  # along one axis, where the other has no neighbor
    alone = (dot(across, turn_across) + dot(down, turn_down)) / np.where(size > 0.0, size, 1.0)
    mean = np.where(is_area, 0.5 * bend / np.where(is_area, area, 1.0), np.where(size > 0.0, alone, 0.0))
    return normal, np.where((normal != 0.0).any(axis=-1, keepdims=True), mean, 0.0)


def inside_picture(x: Array, y: Array, width: int, height: int) -> Array:
    """Where pixels are in the picture, as a Field."""
    return ((x >= 0) & (x < width) & (y >= 0) & (y < height))[..., None]


def is_gap(before: Array, here: Array, after: Array) -> Array:
    """Where a step is more than twice as long as both beside it: that across a fold is between those two in length."""
    before, after = (np.where(step < FAR, step, 0.0) for step in (before, after))
    return (here >= FAR) | (here > 2.0 * np.maximum(before, after))


def change_between_gaps(places: Array, normal: Array, right: int, down: int) -> tuple[Array, Array, Array]:
    """How place and normal change from one neighbor to the other, or from the pixel where a gap is between; and where.

    A neighbor whose normal is a mixture of several surfaces counts across a fold, but not beside a gap.
    """
    seven = [shift_picture(places, at * right, at * down, "black") for at in range(-3, 4)]
    steps = [np.where(is_place(a) & is_place(b), length(b - a), FAR) for a, b in itertools.pairwise(seven)]
    ends = [shift_picture(normal, sign * right, sign * down) for sign in (-1, 1)]
    mixed = [length(end) < 0.98 for end in ends]
    back = ~is_gap(*steps[1:4]) & ~(mixed[0] & is_gap(*steps[:3]))
    on = ~is_gap(*steps[2:5]) & ~(mixed[1] & is_gap(*steps[3:]))
    units = [
        np.where(there, unit_normals(end), unit_normals(normal)) for there, end in zip((back, on), ends, strict=True)
    ]
    way = np.where(on, seven[4], places) - np.where(back, seven[2], places)
    there = (units[0] != 0.0).any(axis=-1, keepdims=True) & (units[1] != 0.0).any(axis=-1, keepdims=True)
    return way, units[1] - units[0], there & np.where(length(normal) < 0.98, back & on, back | on)


def mean_of_places(places: Array, normal: Array, reach: int) -> Array:
    """The mean curvature of surfaces whose places are known, never across a gap in depth."""
    across, turn_across, is_across = change_between_gaps(places, normal, reach, 0)
    down, turn_down, is_down = change_between_gaps(places, normal, 0, reach)
    bend, area, is_area = curvature_of_forms(across, down, turn_across, turn_down)
    there = is_place(places) & (unit_normals(normal) != 0.0).any(axis=-1, keepdims=True) & is_across & is_down & is_area
    return np.where(there, 0.5 * bend / np.where(is_area, area, 1.0), 0.0)


def mean_of_normals(normal: Array, reach: int, axes: Array) -> Array:
    """The mean curvature from normals alone, as a camera sees them that is infinitely far away.

    `axes` are its directions to the right, down and forward; lengths are picture heights.
    """
    height, width = normal.shape[:2]
    right, down, forward = axes
    unit, (y, x) = unit_normals(normal), np.mgrid[:height, :width]
    steps, turns = [], []
    for way, (dx, dy) in ((right, (reach, 0)), (down, (0, reach))):
        ends, span = [], np.zeros((height, width, 1))
        for sign in (-1, 1):
            end = pixels_at(unit, x + sign * dx, y + sign * dy)
            there = inside_picture(x + sign * dx, y + sign * dy, width, height) & (end != 0.0).any(-1, keepdims=True)
            ends.append(np.where(there, end, unit))
            span = span + np.where(there, reach, 0)
        # A surface that is seen at a grazing angle is far longer than its picture, at most twenty times.
        on_surface = way - forward * (dot(unit, way) / np.minimum(dot(unit, forward), -0.05))
        steps.append(on_surface * span / height)
        turns.append(ends[1] - ends[0])
    bend, area, is_area = curvature_of_forms(*steps, *turns)
    there = (unit != 0.0).any(axis=-1, keepdims=True) & is_area
    return np.where(there, 0.5 * bend / np.where(is_area, area, 1.0), 0.0)


def camera_axes(camera: Array | None) -> Array:
    """The directions to the right, down and forward of a camera; of none, those of the picture."""
    if camera is None:
        return np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
    forward = camera[2, :3] / np.linalg.norm(camera[2, :3])
    sides = camera[:2, :3] - np.outer(camera[:2, :3] @ forward, forward)
    return np.array([*(sides / np.linalg.norm(sides, axis=1, keepdims=True)), forward])


def curvature(
    normal: Array,
    radius: float,
    reach: float,
    position: Array | None = None,
    depth: Array | None = None,
    camera: Array | None = None,
) -> tuple[Array, Array, Array]:
    """Ridges, cavities, and the mean curvature: half the trace of the shape operator."""
    far = max(round(reach), 1)
    if position is None and depth is not None and camera is not None:
        position = position_from_depth(depth, camera)
    if position is not None:
        mean = mean_of_places(position, normal, far)
    else:
        mean = mean_of_normals(normal, far, camera_axes(camera))
    return np.clip(mean * radius, 0.0, 1.0), np.clip(-mean * radius, 0.0, 1.0), mean


def motion_to(other: Array, camera: Array, depth: Array) -> Array:
    """The motion of what one camera sees to the picture of another, in pixels. The background is infinitely far."""
    height, width = depth.shape[:2]
    uv, near = parts_of_picture(width, height), nearness(depth)
    there = near > 0.0
    deep = np.where(there, depth, 1.0)
    seen = np.concatenate([uv * deep, deep, np.where(there, 1.0, 0.0)], axis=-1)
    back = np.vstack([camera_back(camera), [0.0, 0.0, 0.0, 1.0]])
    moved = seen @ (other @ back).T
    ahead = moved[..., 2:] > 0.0  # what lies behind the other camera has no place in its picture
    return np.where(ahead, moved[..., :2] / np.where(ahead, moved[..., 2:], 1.0) - uv, 0.0) * (width, height)


def camera_velocity(depth: Array, camera: Array, before: Array | None = None, after: Array | None = None) -> Array:
    """The motion that the camera causes, of what stands still: since the frame before, and to the frame after."""
    if before is None:  # a camera that stands still
        before, after = camera, camera if after is None else after
    past = -motion_to(before, camera, depth)
    coming = motion_to(after, camera, depth) if after is not None else past
    return np.clip(np.concatenate([past, coming], axis=-1), -1e5, 1e5)
