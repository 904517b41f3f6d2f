"""Lens distortion against OpenCV's camera model."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
import pytest
from halation.nodes.distort.lens_distortion import LensDistortion
from warps import warp_picture, waves

SIZE = (60, 40)
LENSES = [
    {"k1": -0.2},
    {"k1": 0.25, "k2": -0.05},
    {"k1": -0.1, "k2": 0.04, "k3": -0.01, "p1": 0.01, "p2": -0.02},
]


def camera(center: tuple[float, float], focal: float) -> np.ndarray:
    return np.array([[focal, 0, center[0] - 0.5], [0, focal, center[1] - 0.5], [0, 0, 1.0]])


def opencv(lens: dict[str, float]) -> np.ndarray:
    return np.array([lens.get(name, 0.0) for name in ("k1", "k2", "p1", "p2", "k3")])


def ramp() -> np.ndarray:
    """Every pixel holds its own position."""
    y, x = np.mgrid[: SIZE[1], : SIZE[0]].astype(np.float32) + 0.5
    return np.stack([x, y, 0 * x, 0 * x + 1], -1)


def assert_same_positions(run, direction: str, lens: dict[str, float], by_opencv: Callable) -> None:
    """Sampled in the same places, a picture of its own positions tells where both looked."""
    matrix = camera((28.0, 22.0), 48.0)

    def source(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        points = np.stack([x.ravel() - 0.5, y.ravel() - 0.5], -1)
        found = by_opencv(points, matrix, opencv(lens)).reshape(*x.shape, 2) + 0.5
        return found[..., 0], found[..., 1]

    expected, sure = warp_picture(ramp(), source)
    seen = sure & np.all((expected[..., :2] > 2) & (expected[..., :2] < np.array(SIZE) - 2), -1)
    node = LensDistortion(direction=direction, focal=1.2, center=(28 / 60, 22 / 40), edge="clamp", **lens)
    out = run(node, {"image": ramp()})
    assert seen.mean() > 0.6 and np.abs(out - expected)[seen].max() < 2e-5


@pytest.mark.parametrize("lens", LENSES, ids=str)
def test_undistort_is_opencvs_projection(run, lens):
    def bent(points: np.ndarray, matrix: np.ndarray, lens_: np.ndarray) -> np.ndarray:
        rays = np.linalg.solve(matrix, np.concatenate([points, np.ones((len(points), 1))], -1).T).T
        return cv2.projectPoints(rays.reshape(-1, 1, 3), np.zeros(3), np.zeros(3), matrix, lens_)[0]

    assert_same_positions(run, "undistort", lens, bent)


@pytest.mark.parametrize("lens", LENSES, ids=str)
def test_distort_is_opencvs_inverse(run, lens):
    def straight(points: np.ndarray, matrix: np.ndarray, lens_: np.ndarray) -> np.ndarray:
        criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 500, 1e-12)
        return cv2.undistortPoints(points.reshape(-1, 1, 2), matrix, lens_, P=matrix, criteria=criteria)

    assert_same_positions(run, "distort", lens, straight)


@pytest.mark.parametrize("lens", LENSES[:2], ids=str)
def test_pictures_are_looked_up_there(run, hdr, edge, lens):
    picture, radial = hdr(*SIZE), [lens.get(name, 0.0) for name in ("k1", "k2")]

    def source(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        dx, dy = (x - 30) / 1.3, (y - 20) / 1.3
        r2 = (dx * dx + dy * dy) / 48**2
        bend = 1 + radial[0] * r2 + radial[1] * r2 * r2
        return 30 + dx * bend, 20 + dy * bend

    node = LensDistortion(direction="undistort", focal=1.2, zoom=1.3, edge=edge.name, **lens)
    expected, _ = warp_picture(picture, source, edge.scipy_map)
    assert np.abs(run(node, {"image": picture}) - expected).max() < 1e-5 * picture.max()


@pytest.mark.parametrize("lens", LENSES, ids=str)
def test_one_undoes_the_other(run, lens):
    picture = waves(*SIZE)
    there = run(LensDistortion(focal=1.5, edge="clamp", **lens), {"image": picture})
    back = run(LensDistortion(direction="undistort", focal=1.5, edge="clamp", **lens), {"image": there})
    assert np.abs(back - picture)[6:-6, 9:-9].max() < 0.02


def test_beyond_where_a_barrel_turns_back_nothing_is_seen(run):
    """r (1 - 0.5 r^2) is never more than 0.544, the distance at which the picture ends."""
    out = run(LensDistortion(k1=-0.5, focal=0.5), {"image": np.ones((41, 61, 4))})
    y, x = np.mgrid[:41, :61] + 0.5
    distance = np.hypot(x - 30.5, y - 20.5) / 20.5
    assert not out[distance > 0.56].any() and np.all(out[distance < 0.4] == 1.0)


@pytest.mark.parametrize("edge", ["clamp", "mirror", "reflect", "wrap"])
def test_what_is_shown_there_is_of_the_picture(run, hdr, edge):
    """Far outside, edges still give a color that the picture has."""
    picture = hdr(61, 41)
    made = run(LensDistortion(k1=-0.5, focal=0.5, edge=edge), {"image": picture})
    assert made.max() <= 1.001 * picture.max() and made.min() >= 0.0


def test_a_straight_lens_vanishes():
    assert LensDistortion(k1=0.0).identity() == "image" and LensDistortion(k1=0.0, zoom=1.1).identity() is None


def cubic(x: np.ndarray, b: float, c: float) -> np.ndarray:
    """Mitchell and Netravali (1988), equation 8."""
    x = np.abs(x)
    near = (12 - 9 * b - 6 * c) * x**3 + (-18 + 12 * b + 6 * c) * x**2 + 6 - 2 * b
    far = (-b - 6 * c) * x**3 + (6 * b + 30 * c) * x**2 + (-12 * b - 48 * c) * x + 8 * b + 24 * c
    return np.where(x < 1, near, np.where(x < 2, far, 0.0)) / 6


KERNELS = {
    "nearest": lambda x: ((x >= -0.5) & (x < 0.5)) * 1.0,
    "triangle": lambda x: np.maximum(1 - np.abs(x), 0),
    "catmull-rom": lambda x: cubic(x, 0, 0.5),
    "mitchell": lambda x: cubic(x, 1 / 3, 1 / 3),
    "lanczos": lambda x: np.where(np.abs(x) < 3, np.sinc(x) * np.sinc(x / 3), 0),
}


@pytest.mark.parametrize("kernel", KERNELS)
def test_each_filter_weighs_pixels_by_its_formula(run, hdr, kernel):
    """At the places of OpenCV's camera, with the published weights in 64 bits. The lens only enlarges."""
    picture, lens, matrix = hdr(*SIZE), {"k1": -0.15, "p1": 0.01}, camera((28.0, 22.0), 48.0)
    y, x = np.mgrid[: SIZE[1], : SIZE[0]]
    rays = np.linalg.solve(matrix, np.stack([x.ravel(), y.ravel(), np.ones(x.size)]).astype(np.float64)).T
    places = cv2.projectPoints(rays.reshape(-1, 1, 3), np.zeros(3), np.zeros(3), matrix, opencv(lens))[0][:, 0]
    across, down = (KERNELS[kernel](np.arange(n) - places[:, axis, None]) for axis, n in enumerate(SIZE))
    expected = np.einsum("py,px,yxc->pc", down, across, picture.astype(np.float64))
    expected /= (down.sum(1) * across.sum(1)).clip(1e-9)[:, None]
    node = LensDistortion(
        direction="undistort", focal=1.2, center=(28 / 60, 22 / 40), edge="clamp", kernel=kernel, **lens
    )
    out = run(node, {"image": picture}).reshape(-1, 4)
    inside = np.all((places > 4) & (places < np.array(SIZE) - 5), axis=1)
    if kernel == "nearest":  # a place in the middle of two pixels is rounded either way
        inside &= np.all(np.abs(places % 1.0 - 0.5) > 1e-3, axis=1)
    assert inside.mean() > 0.6 and np.abs(out - expected)[inside].max() < 2e-5 * picture.max()
