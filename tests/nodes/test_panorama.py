"""Panorama against closed forms: a smooth function of the direction, drawn in one projection and read in another.

Directions of each projection are written here from its definition, in 64 bits; rotations are scipy's, and OpenCV's
fisheye camera is a second witness.
"""

from __future__ import annotations

from itertools import chain

import cv2
import numpy as np
import pytest
from halation.nodes.distort.panorama import Panorama
from scipy.spatial.transform import Rotation
from selection import list_cases

PROJECTIONS = ("lat-long", "cube strip", "cube cross", "fisheye", "mirror ball", "little planet", "perspective")
SIZES = {
    "lat-long": (256, 128),
    "cube strip": (384, 64),
    "cube cross": (256, 192),
    "fisheye": (128, 128),
    "mirror ball": (160, 160),
    "little planet": (200, 200),
    "perspective": (320, 180),
}
ANGLES = {"fisheye": 200.0, "little planet": 260.0, "perspective": 70.0}


def smooth(way: np.ndarray) -> np.ndarray:
    """Four smooth functions of unit vectors [..., 3]: no symmetry maps one to itself."""
    x, y, z = np.moveaxis(way, -1, 0)
    return np.stack([0.5 + 0.4 * x, 0.5 + 0.3 * y + 0.1 * x * z, 0.5 + 0.4 * z, 1.0 + 0.0 * x], -1)


def aim(front, right, down):
    """Unit vectors from how far to the front, right and down a view looks; x is the front, y left, z up."""
    way = np.stack(np.broadcast_arrays(front, -np.asarray(right), -np.asarray(down)), -1)
    return way / np.linalg.norm(way, axis=-1, keepdims=True)


def directions(projection: str, size: tuple[int, int]) -> np.ndarray:
    """The direction of each pixel, [h, w, 3]; NaN where the projection has none."""
    width, height = size
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    if projection == "lat-long":
        longitude, latitude = (u - 0.5) * 2 * np.pi, (0.5 - v) * np.pi
        return aim(np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), -np.sin(latitude))
    if projection.startswith("cube"):
        side = height if projection == "cube strip" else height // 3
        a, b = np.meshgrid((np.arange(side) + 0.5) * 2 / side - 1, (np.arange(side) + 0.5) * 2 / side - 1)
        quarter = {name: Rotation.from_euler("z", degrees, degrees=True) for name, degrees in QUARTERS.items()}
        level = aim(1.0, a, b)
        faces = {name: turn.apply(level.reshape(-1, 3)).reshape(level.shape) for name, turn in quarter.items()}
        for name, degrees in (("up", -90.0), ("down", 90.0)):
            tilt = Rotation.from_euler("y", degrees, degrees=True)
            faces[name] = tilt.apply(level.reshape(-1, 3)).reshape(level.shape)
        if projection == "cube strip":
            return np.concatenate([faces[name] for name in ("right", "left", "up", "down", "front", "back")], 1)
        none = np.full_like(level, np.nan)
        rows = [
            [none, faces["up"], none, none],
            [faces["left"], faces["front"], faces["right"], faces["back"]],
            [none, faces["down"], none, none],
        ]
        return np.concatenate([np.concatenate(row, 1) for row in rows], 0)
    right, down = (2 * u - 1) * width / height, 2 * v - 1
    if projection == "perspective":
        slope = np.tan(np.radians(ANGLES[projection]) / 2)
        return aim(1.0, right * slope, down * slope)
    far = np.hypot(right, down).clip(1e-9)
    if projection == "little planet":  # from the pole over the sphere onto the plane below it
        scaled = far * np.tan(np.radians(ANGLES[projection]) / 4)
        away = 2 * np.arctan(scaled)
        return aim(np.sin(away) * -down / far, np.sin(away) * right / far, np.cos(away))
    with np.errstate(invalid="ignore"):
        away = far * np.radians(ANGLES["fisheye"]) / 2 if projection == "fisheye" else 2 * np.arcsin(far)
    way = aim(np.cos(away), np.sin(away) * right / far, np.sin(away) * down / far)
    way[far > 1] = np.nan
    return way


QUARTERS = {"front": 0.0, "left": 90.0, "back": 180.0, "right": -90.0}


def draw(projection: str) -> np.ndarray:
    return np.nan_to_num(smooth(directions(projection, SIZES[projection])))


STEPS = [
    [(source, PROJECTIONS[(number + step) % len(PROJECTIONS)]) for number, source in enumerate(PROJECTIONS)]
    for step in range(len(PROJECTIONS))
]
"""Pairs by how far they stand apart: the first three have each projection read by itself, from and to two others."""


@pytest.mark.parametrize(("source", "target"), list_cases(chain(*STEPS[:3]), chain(*STEPS[3:])))
def test_every_projection_reads_every_other(run, source, target):
    yaw, pitch, roll = (20.0, 15.0, 10.0) if source == "perspective" else (35.0, -50.0, 20.0)
    node = Panorama(
        source=source,
        source_angle=ANGLES.get(source, 180.0),
        target=target,
        angle=ANGLES.get(target, 180.0),
        yaw=yaw,
        pitch=pitch,
        roll=roll,
    )
    out = run(node, {"image": draw(source)})
    # Nose up and a turn to the right are negative angles about y and z, seen against the axes; a tilt is about x.
    turn = Rotation.from_euler("ZYX", (-yaw, -pitch, roll), degrees=True)
    view = directions(target, out.shape[1::-1])
    ways = turn.apply(view.reshape(-1, 3)).reshape(view.shape)
    expected = smooth(ways)
    if source == "mirror ball":  # its rim is a single direction, behind it
        expected[ways[..., 0] < -0.9] = np.nan
    shown = np.all(out[..., 3:] > 0.999, axis=-1) & np.isfinite(expected[..., 0])
    if source in ("lat-long", "cube strip", "cube cross"):
        assert shown[np.isfinite(expected[..., 0])].mean() > 0.98
    assert shown.sum() > 200 and np.abs(out - expected)[shown].max() < 0.02
    assert np.abs(out - expected)[shown].mean() < 1.5e-3


def test_a_fisheye_is_opencvs(run):
    """Where OpenCV's fisheye camera without distortion sees the pixels of a perspective view."""
    side, angle, view = 200, 150.0, 80.0
    y, x = np.mgrid[:side, :side].astype(np.float32) + 0.5
    node = Panorama(source="fisheye", source_angle=angle, target="perspective", angle=view, aspect=1.0)
    out = run(node, {"image": np.stack([x, y, 0 * x, 0 * x + 1], -1)})
    n = out.shape[0]
    slope = np.tan(np.radians(view) / 2)
    b, a = np.meshgrid(*[((np.arange(n) + 0.5) * 2 / n - 1) * slope] * 2, indexing="ij")
    points = np.stack([a.ravel(), b.ravel(), np.ones(a.size)], -1)[:, None]
    focal = side / np.radians(angle)
    camera = np.array([[focal, 0, side / 2], [0, focal, side / 2], [0, 0, 1.0]])
    expected = cv2.fisheye.projectPoints(points, np.zeros(3), np.zeros(3), camera, np.zeros(4))[0].reshape(n, n, 2)
    assert np.abs(out[..., :2] - expected).max() < 0.02


@pytest.mark.parametrize("source", ["lat-long", "cube strip", "cube cross"])
def test_sides_join_without_a_seam(run, source):
    """All around the horizon and over a pole, steps between pixels are as small where sides join as elsewhere."""
    for pitch in (0.0, 90.0):
        node = Panorama(source=source, target="lat-long", pitch=pitch, yaw=17.0, scale=2.0)
        out = run(node, {"image": draw(source)})
        steps = np.abs(np.diff(out, axis=1, append=out[:, :1]))[..., :3].max(-1)
        assert steps.max() < 0.025


def test_sizes_keep_the_pixels_of_a_quarter_turn():
    sizes = {
        ("lat-long", "cube strip"): ((400, 200), (600, 100)),
        ("cube strip", "lat-long"): ((600, 100), (400, 200)),
        ("lat-long", "cube cross"): ((400, 200), (400, 300)),
        ("cube cross", "mirror ball"): ((400, 300), (200, 200)),
        ("lat-long", "fisheye"): ((400, 200), (200, 200)),
    }
    for (source, target), (before, after) in sizes.items():
        node = Panorama(source=source, target=target, angle=180.0)
        assert node.output_size({"image": before}, before) == after


@pytest.mark.parametrize("target", ["cube strip", "cube cross"])
@pytest.mark.parametrize("scale", [1.0, 0.73, 0.01, 2.5])
@pytest.mark.parametrize("height", [2, 37, 101, 200, 1027])
def test_faces_of_cubes_are_whole_even_pixels_near_a_quarter_turn(target, scale, height):
    """Cells of a cube are equal squares of an even side, a pixel off at most where it is not the smallest side."""
    width, tall = Panorama(target=target, scale=scale).output_size({"image": (2 * height, height)}, (64, 64))
    across, down = {"cube strip": (6, 1), "cube cross": (4, 3)}[target]
    side = width // across
    assert (width, tall) == (across * side, down * side) and side % 2 == 0 and side >= 2
    assert abs(side - scale * height / 2.0) <= 1.0 or side == 2


@pytest.mark.parametrize("target", ["fisheye", "little planet", "perspective", "lat-long"])
@pytest.mark.parametrize("height", [40, 37, 331])
def test_other_results_have_even_sides_near_a_quarter_turn(target, height):
    """90 degrees of a lat-long picture are half of its height, and so many pixels of the result.

    A view has them in its middle, where r = tan(a); the other results over their whole height.
    """
    pixels = height / np.pi  # of a radian
    view = np.radians(70.0)
    side = {"perspective": 2.0 * np.tan(view / 2.0), "lat-long": np.pi}.get(target, view) * pixels
    node = Panorama(target=target, angle=70.0, aspect=1.5)
    width, tall = node.output_size({"image": (2 * height, height)}, (64, 64))
    assert width % 2 == 0 and tall % 2 == 0 and abs(tall - side) <= 1.0
    assert abs(width - {"perspective": 1.5, "lat-long": 2.0}.get(target, 1.0) * side) <= 1.0
