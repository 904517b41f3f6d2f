"""Conventions that the pixels prove: layers are compared with positions, a camera, another frame.

What a renderer usually writes is in `conventions`. Users change it, and files pass through programs that do not say so,
so pixels count more. Every test here compares what a layer holds with what it would hold by each convention, over a few
thousand pixels in double precision, and takes the best one if it fits well and clearly better than the next:

- depth against the distance of the positions from the camera: along its axis, from the eye, inverse, or scaled to 0..1;
- depth without positions by planes: 1 / planar depth of a plane is linear over the picture, other kinds are bent;
- normals against the surface that neighboring positions span, in the axes of the world and of the camera;
- motion against where two cameras see the same place, or against the picture of the frame before.

Medians and not means decide, as edges, moving objects and antialiased pixels are always wrong somewhere.
"""

from __future__ import annotations

import math
from types import MappingProxyType

import numpy as np
from halation.nodes import CameraModel

from ..color.transforms import Array
from .camera import FARTHEST, SAMPLES, find_surface_points, sample_pixels
from .conventions import Convention, DepthKind, MotionDirection, VectorSpace

_FEWEST_SAMPLES = 30
"""Fewer pixels prove nothing: the median of 30 samples lies within the middle half of the distribution (binomial, 99
%)."""

_WORST_DEPTH_ERROR = 2e-3
"""The largest median error of a depth that matches, relative. Half floats alone are off by up to 5e-4 (11 bits).
Measured on nine frames of a street by Blender: planar 3e-8 to 1e-7 as floats and 1e-4 as halves; the same depth taken
for radial 0.037."""

_WORST_BEND = 2e-5
"""The largest relative bend that counts as flat. On those frames correctly read float depth bends by 1e-7, and half
floats too much to tell."""

_FLAT_SHARE = 0.3
"""The part of the picture that must be flat. Chosen by judgement: walls and floors fill that much of most renders,
while edges and round surfaces bend in any reading."""

_CLEAR_FACTOR = 4.0
"""How many times less the right reading must bend than the next one. On those frames it is 15 to 22 times."""

_FOCAL_LENGTHS = np.geomspace(0.4, 8.0, 25)
"""Focal lengths, in widths of the picture, that are tried for radial depth: fields of view from 103 to 7 degrees, in
steps of 13 %."""

_WORST_ANGLE = 20.0
"""Degrees by which normals may differ from the surfaces in the median, since bump maps bend them. On those frames exact
normals differ by 0, normals of 8 bits by 0.3; with the wrong axes they differ by 83."""

_LEAST_MOTION = 0.5
"""Pixels. Shorter motion proves nothing: something that stands still fits every direction. Chosen by judgement."""

_LIKELY_FACTOR = 1.15
"""How many times worse the next direction must fit than the best one. On four pairs of those frames it is 1.39 to
1.61."""

_UNCLAMPED_SHARE = 0.1
"""Share of a depth from 0 to 1 that must lie between: the rest is clamped and tells nothing. Chosen by judgement:
with a third and with three times as much all tests pass, as for the next two."""

_LEAST_RANGE = 1e-3
"""How much of 0..1 a normalized depth must use: any line fits what is nearly constant. Chosen by judgement."""

_OUTLIER_MEDIANS = 6.0
"""Errors beyond so many medians are outliers: of normally distributed ones 5e-5 are. `_ROUNDING` keeps exact values,
whose median is 0."""

_ROUNDING = 1e-12
_BEND_STEPS = 48
"""The arms of a cross are this part of the picture's smaller side: long enough that floats of 32 bits show the bend of
radial depth, short enough that most crosses lie on one wall. Chosen by judgement."""

_NEGATIVE_SHARE = 0.99
"""Share of the pixels below zero for negative depth: a few may be damaged or background."""

_HOME_DISTANCE = 1e-3
_HOME_ALIGNMENT = 0.9999
"""A camera stands at 0 if it is nearer than this, relative to the positions, and looks along an axis if the cosine
is at least this (0.8 degrees). Cameras that were solved from positions around 0 are off by 2e-9 as floats and 6e-5 as
halves."""

_UNIT_LENGTH = 0.05
_ENCODED_LENGTH = 0.02
"""How far the length of a normal may be from 1: 8 bits are off by up to 0.007 (half a step of 2/255 along each axis,
times the square root of 3). Averages at edges are shorter and left out."""

_HOME_ANGLE = 0.5
"""Degrees by which other axes must fit better than those of positions: normals of 8 bits alone differ by 0.3."""

_STILL = 1e-9
"""A ratio of stored to true motion that is 0 but for rounding: there is no motion in the layer."""

_MOTION_ERROR = 0.02
"""The largest median error of motion, relative to the median motion, plus so many pixels: half floats are off by up to
5e-4, and moving objects do not count in the median. Chosen by judgement."""

_UNIT_ERROR = 0.02
"""How far a unit of motion may be from a usual one: the next usual one is a factor of 2 away. Chosen by judgement."""


def match_depth_with_positions(depth: Array, position: Array, camera: CameraModel) -> Convention | None:
    """The kind of a depth [h, w], compared with the distances of positions [h, w, 3]; None if no kind fits."""
    rows, columns = sample_pixels((depth.shape[1], depth.shape[0]), SAMPLES)
    places, stored = position[rows, columns, :3].astype(np.float64), depth[rows, columns].astype(np.float64).ravel()
    with np.errstate(invalid="ignore"):
        keep = find_surface_points(places) & (np.abs(stored) < FARTHEST)
    places, stored = places[keep], stored[keep]
    ahead = places @ np.array(camera.rows[8:11]) + camera.rows[11]
    if len(stored) < _FEWEST_SAMPLES or float(ahead.min()) <= 0.0:
        return None
    away = np.linalg.norm(places - np.array(camera.eye), axis=1)
    candidates = {
        DepthKind.PLANAR: (ahead, "the distance of every place along the camera's axis"),
        DepthKind.RADIAL: (away, "the distance of every place from the eye"),
        DepthKind.INVERSE: (1.0 / ahead, "1 / the distance of every place along the camera's axis"),
        DepthKind.NEGATIVE: (-ahead, "minus the distance of every place along the camera's axis"),
    }
    errors = {kind: float(np.median(np.abs(stored / guess - 1.0))) for kind, (guess, _) in candidates.items()}
    kind = min(errors, key=lambda kind: errors[kind])
    if errors[kind] > _WORST_DEPTH_ERROR:
        return _match_normalized_depth(stored, ahead)
    return Convention(kind, f"{candidates[kind][1]}, to {errors[kind]:.0e}", True, _sign_scale(kind))


def _sign_scale(kind: DepthKind) -> tuple[float]:
    return (-1.0,) if kind is DepthKind.NEGATIVE else (1.0,)


def _match_normalized_depth(stored: Array, ahead: Array) -> Convention | None:
    """Depth between 0 and 1 that is linear in planar depth where it is not clamped."""
    if stored.min() < 0.0 or stored.max() > 1.0:
        return None
    free = (stored > 0.0) & (stored < 1.0)
    stored, ahead = stored[free], ahead[free]
    if len(stored) < max(_FEWEST_SAMPLES, _UNCLAMPED_SHARE * len(free)) or float(np.ptp(stored)) < _LEAST_RANGE:
        return None
    keep = np.ones(len(stored), bool)
    scale = offset = 0.0
    error = keep
    for _ in range(3):
        scale, offset = (float(part) for part in np.polyfit(stored[keep], ahead[keep], 1))
        error = np.abs(stored * scale + offset - ahead) / ahead
        keep = error <= _OUTLIER_MEDIANS * float(np.median(error)) + _ROUNDING
    if float(np.median(error)) > _WORST_DEPTH_ERROR:
        return None
    reason = f"0 is {offset:.4g} and 1 is {offset + scale:.4g} along the camera's axis, by the positions"
    return Convention(DepthKind.NORMALIZED, reason, True, (scale,), (offset,))


def judge_depth_by_planes(depth: Array) -> Convention | None:
    """The kind of a depth [h, w] without positions: by its sign, or by the reading that makes planes flat.

    On a plane, 1 / planar depth is linear over the picture. So is inverse depth unchanged, and radial depth converted
    with the right focal length. Each sample is a cross of five pixels, whose second difference is 0 on a plane. The
    flattest three tenths of the picture decide, because the rest may be bent.
    """
    height, width = depth.shape[:2]
    depth = depth.reshape(height, width)
    reach = max(1, min(width, height) // _BEND_STEPS)
    if min(width, height) < 2 * reach + 3:
        return None
    rows, columns = sample_pixels((width, height), 4 * SAMPLES, reach)
    steps = reach * np.array([(0, 0), (0, -1), (0, 1), (-1, 0), (1, 0)])
    at = np.stack([rows, columns], axis=1) + steps[:, None]
    cross = depth[at[..., 0], at[..., 1]].astype(np.float64)
    finite = np.isfinite(cross[0]) & (np.abs(cross[0]) < FARTHEST)
    is_negative = finite.any() and bool((cross[0][finite] < 0.0).mean() > _NEGATIVE_SHARE)
    cross = -cross if is_negative else cross
    with np.errstate(invalid="ignore"):
        keep = ((cross > 0.0) & (cross < FARTHEST)).all(axis=0) & (cross[1:] != cross[0]).any(axis=0)
    at, cross = at[:, keep], cross[:, keep]
    convention = (
        _find_flattest_kind(cross, (at - ((height - 1) / 2, (width - 1) / 2)) / width)
        if len(at[0]) >= _FEWEST_SAMPLES
        else None
    )
    if not is_negative:
        return convention
    return (
        None
        if convention and convention.kind != DepthKind.PLANAR
        else Convention(DepthKind.NEGATIVE, "all of it is below zero", True, _sign_scale(DepthKind.NEGATIVE))
    )


def _find_flattest_kind(cross: Array, away: Array) -> Convention | None:
    """Depths of five pixels in a row each, and their distances from the middle one as fractions of the width."""
    square = (away**2).sum(axis=2)
    bends = {
        DepthKind.PLANAR: _measure_bend(1.0 / cross),
        DepthKind.INVERSE: _measure_bend(cross),
        DepthKind.RADIAL: min(_measure_bend(np.sqrt(1.0 + square / focal**2) / cross) for focal in _FOCAL_LENGTHS),
    }
    if bends[DepthKind.PLANAR] < _CLEAR_FACTOR * bends[DepthKind.RADIAL]:
        del bends[DepthKind.RADIAL]  # with a long focal length there is no difference
    first, second = sorted(bends, key=lambda kind: bends[kind])[:2]
    if bends[first] > _WORST_BEND or bends[second] < _CLEAR_FACTOR * bends[first]:
        return None
    words = {DepthKind.PLANAR: "planar, ", DepthKind.INVERSE: "inverse, ", DepthKind.RADIAL: "radial, "}[first]
    return Convention(first, f"read as {words}planes in the picture come out flat, to {bends[first]:.0e}", True)


def _measure_bend(field: Array) -> float:
    """The second difference, relative to the value, that three tenths of the pixels do not exceed."""
    across, down = (np.abs(field[i] + field[i + 1] - 2.0 * field[0]) for i in (1, 3))
    return float(np.quantile(np.maximum(across, down) / field[0], _FLAT_SHARE))


def find_position_space(camera: CameraModel, position: Array) -> Convention:
    """The axes of positions, by the place of the camera that was solved from them."""
    rows, columns = sample_pixels((position.shape[1], position.shape[0]), SAMPLES)
    places = position[rows, columns, :3].astype(np.float64)
    places = places[find_surface_points(places)]
    size = float(np.median(np.linalg.norm(places, axis=1))) if len(places) else 1.0
    home = math.hypot(*camera.eye) < _HOME_DISTANCE * size
    for space, ahead in ((VectorSpace.CAMERA, -1.0), (VectorSpace.CAMERA_AHEAD, 1.0)):
        alignment = min(camera.forward[2] * ahead, camera.right[0], -camera.down[1])
        if home and alignment > _HOME_ALIGNMENT:
            return Convention(space, "the camera that sees them stands at 0 and looks along z", True)
    eye = ", ".join(f"{part:.4g}" for part in camera.eye)
    return Convention(VectorSpace.WORLD, f"the camera that sees them stands at {eye}", True)


_AXES_WORDS = MappingProxyType(
    {
        VectorSpace.WORLD: "the world",
        VectorSpace.CAMERA: "the camera",
        VectorSpace.CAMERA_AHEAD: "the camera, z ahead",
    }
)


def match_normals_with_positions(
    normal: Array, position: Array, camera: CameraModel, home: VectorSpace = VectorSpace.WORLD
) -> Convention | None:
    """The axes of normals, by the surfaces that neighboring positions span; `home` are the axes of positions.

    The cross product of the differences of positions is the true normal, turned to the camera. Each candidate of axes
    is compared with it by the median angle, which bent surfaces and edges do not disturb. Where two fit alike, as for a
    camera that looks along an axis of the world, `home` is taken.
    """
    height, width = normal.shape[:2]
    if min(width, height) < 3:
        return None
    rows, columns = sample_pixels((width, height), SAMPLES, 1)
    rows, columns = rows.clip(1, height - 2), columns.clip(1, width - 2)
    place = {
        step: position[rows + step[0], columns + step[1], :3].astype(np.float64)
        for step in ((0, 0), (0, -1), (0, 1), (-1, 0), (1, 0))
    }
    stored = normal[rows, columns, :3].astype(np.float64)
    scale, offset = _find_normal_encoding(stored)
    stored = stored * scale + offset
    with np.errstate(invalid="ignore", over="ignore"):
        length = np.linalg.norm(stored, axis=1)
        keep = np.all([find_surface_points(places) for places in place.values()], axis=0) & (
            np.abs(length - 1.0) < _UNIT_LENGTH
        )
    facing = np.cross(place[0, 1][keep] - place[0, -1][keep], place[1, 0][keep] - place[-1, 0][keep])
    facing *= np.sign(((np.array(camera.eye) - place[0, 0][keep]) * facing).sum(axis=1))[:, None]
    size = np.linalg.norm(facing, axis=1)
    facing, stored = facing[size > 0.0] / size[size > 0.0, None], (stored[keep] / length[keep, None])[size > 0.0]
    if len(facing) < _FEWEST_SAMPLES:
        return None
    up, ahead = -np.array(camera.down), np.array(camera.forward)
    axes = {
        VectorSpace.CAMERA: np.stack([camera.right, up, -ahead]),
        VectorSpace.CAMERA_AHEAD: np.stack([camera.right, up, ahead]),
        home: np.eye(3),
    }
    angles = {space: _median_angle(stored, facing @ turned.T) for space, turned in axes.items()}
    space = min(angles, key=lambda space: angles[space])
    if angles[home] < angles[space] + _HOME_ANGLE:
        space = home
    if angles[space] > _WORST_ANGLE:
        return None
    coded = ", once 2 n - 1 decodes them" if offset else ""
    reason = f"{angles[space]:.2g} degrees off the surfaces of the positions in the axes of {_AXES_WORDS[space]}{coded}"
    return Convention(space, reason, True, (scale,) * 3, (offset,) * 3)


def _find_normal_encoding(vectors: Array) -> tuple[float, float]:
    """The scale and offset that make unit vectors: pictures of normals are stored in 0..1."""
    with np.errstate(invalid="ignore"):
        vectors_there = vectors[np.isfinite(vectors).all(axis=1) & (vectors != 0.0).any(axis=1)]
    if len(vectors_there) and vectors_there.min() >= 0.0 and vectors_there.max() <= 1.0:
        off = np.abs(np.linalg.norm(2.0 * vectors_there - 1.0, axis=1) - 1.0)
        if (
            float(np.median(off)) < _ENCODED_LENGTH
            and float(np.median(np.abs(np.linalg.norm(vectors_there, axis=1) - 1.0))) > _ENCODED_LENGTH
        ):
            return 2.0, -1.0
    return 1.0, 0.0


def _median_angle(a: Array, b: Array) -> float:
    """The median angle between unit vectors, in degrees."""
    return float(np.degrees(np.median(np.arccos(np.clip((a * b).sum(axis=1), -1.0, 1.0)))))


def match_velocity_with_cameras(
    velocity: Array, position: Array, here: CameraModel, before: CameraModel
) -> Convention | None:
    """The direction and unit of motion [h, w, 2], by where two cameras see the same positions; most of them must stand
    still in the world. None if the camera hardly moves or no direction fits.

    Each axis gives the median ratio of the stored motion to that of the cameras: its sign is the direction, its size
    the unit. The medians ignore what moves by itself.
    """
    height, width = velocity.shape[:2]
    rows, columns = sample_pixels((width, height), SAMPLES)
    places, stored = position[rows, columns, :3].astype(np.float64), velocity[rows, columns, :2].astype(np.float64)
    keep = find_surface_points(places) & np.isfinite(stored).all(axis=1)
    places, stored = np.pad(places[keep], ((0, 0), (0, 1)), constant_values=1.0), stored[keep]
    image_now, image_before = (_project(camera, places) for camera in (here, before))
    moved = (image_now - image_before) * (width, height)
    finite = np.isfinite(moved).all(axis=1)
    moved, stored = moved[finite], stored[finite]
    ratios: list[float] = []
    for axis in (0, 1):
        moves = np.abs(moved[:, axis]) > _LEAST_MOTION
        ratio = float(np.median(stored[moves, axis] / moved[moves, axis])) if moves.sum() >= _FEWEST_SAMPLES else 0.0
        if abs(ratio) < _STILL:
            return None
        ratios.append(1.0 / ratio)
    scale, unit = _find_unit((ratios[0], ratios[1]), (width, height))
    off = np.abs(stored * scale - moved)
    if float(np.median(off)) > _MOTION_ERROR * float(np.median(np.abs(moved))) + _MOTION_ERROR:
        return None
    way = "current minus previous" if scale[0] > 0.0 else "previous minus current"
    up = "down" if (scale[0] > 0.0) == (scale[1] > 0.0) else "up"
    reason = f"{way} {unit}, y {up}: where the cameras of both frames see the same places, to {np.median(off):.1g} px"
    return Convention(MotionDirection.FROM_PREVIOUS, reason, True, scale)


def _project(camera: CameraModel, places: Array) -> Array:
    projected = places @ np.reshape(camera.rows, (3, 4)).T
    with np.errstate(divide="ignore", invalid="ignore"):
        return projected[:, :2] / projected[:, 2:]


def _find_unit(ratios: tuple[float, float], size: tuple[int, int]) -> tuple[tuple[float, float], str]:
    """Factors to pixels, exact if the unit is a usual one, and its name."""
    units = (("in pixels", (1.0, 1.0)), ("in pictures", size), ("in half pictures", (size[0] / 2, size[1] / 2)))
    for name, usual in units:
        if all(abs(abs(ratio) / factor - 1.0) < _UNIT_ERROR for ratio, factor in zip(ratios, usual, strict=True)):
            return (math.copysign(usual[0], ratios[0]), math.copysign(usual[1], ratios[1])), name
    return ratios, f"in pixels times {1.0 / abs(ratios[0]):.4g}"


def match_velocity_with_pictures(velocity: Array, here: Array, before: Array) -> Convention | None:
    """The direction of motion [h, w, 2] in pixels: the one of four that maps the picture [h, w, 3] before best to this
    one; None if nothing moves or none is clearly better.

    Pixels that appear from behind others have nothing to match in the frame before, so the worst tenth is left out. The
    logarithm keeps a few bright lights from deciding alone.
    """
    height, width = velocity.shape[:2]
    rows, columns = sample_pixels((width, height), 4 * SAMPLES)
    stored = velocity[rows, columns, :2].astype(np.float64)
    with np.errstate(invalid="ignore"):
        keep = (np.abs(stored) > _LEAST_MOTION).all(axis=1) & (np.abs(stored) < width).all(axis=1)
    rows, columns, stored = rows[keep], columns[keep], stored[keep]
    if len(stored) < _FEWEST_SAMPLES:
        return None
    light_now = np.log1p(np.maximum(_read_light(here, rows, columns), 0.0))
    errors: dict[tuple[float, float], float] = {}
    for sign in ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)):
        light_before = _sample_between_pixels(before, columns - sign[0] * stored[:, 0], rows - sign[1] * stored[:, 1])
        apart = np.abs(np.log1p(np.maximum(light_before, 0.0)) - light_now).mean(axis=1)
        errors[sign] = float(np.mean(np.sort(apart)[: -len(apart) // 10]))
    first, second = sorted(errors, key=lambda sign: errors[sign])[:2]
    if errors[second] < _LIKELY_FACTOR * errors[first] or errors[second] == 0.0:
        return None
    way = "along with the motion" if first[0] > 0.0 else "against the motion"
    up = "down" if first[0] == first[1] else "up"
    return Convention(
        MotionDirection.FROM_PREVIOUS, f"{way} in pixels, y {up}: so the frame before fits best", True, first
    )


def _sample_between_pixels(picture: Array, x: Array, y: Array) -> Array:
    """The picture interpolated linearly between pixels; border pixels are repeated."""
    x, y = x.clip(0, picture.shape[1] - 1), y.clip(0, picture.shape[0] - 1)
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    right, low = (left + 1).clip(max=picture.shape[1] - 1), (top + 1).clip(max=picture.shape[0] - 1)
    s, t = (x - left)[:, None], (y - top)[:, None]
    upper = _read_light(picture, top, left) * (1.0 - s) + _read_light(picture, top, right) * s
    return upper * (1.0 - t) + (_read_light(picture, low, left) * (1.0 - s) + _read_light(picture, low, right) * s) * t


def _read_light(picture: Array, rows: Array, columns: Array) -> Array:
    """Pixels of a picture; NaN and infinity are black."""
    return np.nan_to_num(picture[rows, columns, :3].astype(np.float64), nan=0.0, posinf=0.0, neginf=0.0)
