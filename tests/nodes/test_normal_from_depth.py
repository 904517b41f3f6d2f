"""Normals and curvature from depth, on planes, spheres and corners whose depth is known."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import look_at
from halation.nodes.geometry.normal_from_depth import NormalFromDepth

WIDTH, HEIGHT = 97, 61
CAMERA = look_at((5.0, 0.5, 3.0), (1.0, 0.0, 0.6), (0.9, 0.9 * WIDTH / HEIGHT))


def rays() -> np.ndarray:
    """From the eye to depth 1, for every pixel."""
    inverse = np.reshape(CAMERA.inverse, (3, 4))[:, :3]
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    seen = np.stack([(x + 0.5) / WIDTH, (y + 0.5) / HEIGHT, np.ones_like(x, float)], -1)
    return seen @ inverse.T


def plane(normal, through) -> np.ndarray:
    """Depth of a plane, infinite behind the camera."""
    normal = np.asarray(normal, float)
    with np.errstate(divide="ignore"):
        depth = normal @ (np.asarray(through) - CAMERA.eye) / (rays() @ normal)
    return np.where(depth > 0, depth, np.inf)


def sphere(center, radius, far=False) -> tuple[np.ndarray, np.ndarray]:
    """Depth of a sphere, its outside or its inside, infinite beside it; and the normals towards the camera."""
    way, ray = np.asarray(CAMERA.eye) - center, rays()
    a, b, c = (ray**2).sum(-1), ray @ way, way @ way - radius**2
    with np.errstate(invalid="ignore"):
        depth = (-b + (1 if far else -1) * np.sqrt(b * b - a * c)) / a
    normals = (way + depth[..., None] * ray) / radius * (-1 if far else 1)
    return np.where(np.isfinite(depth), depth, np.inf), normals


def normals(run, depth):
    return run(NormalFromDepth(), {"depth": depth, "camera": CAMERA}, output="normal")


def curvature(run, depth, **values):
    return run(NormalFromDepth(**values), {"depth": depth, "camera": CAMERA}, output="curvature")[..., 0]


@pytest.mark.parametrize("normal", [(0, 0, 1), (1, 0, 0), (0.6, -0.5, 0.3), (0.8, 0.1, 0.6)], ids=str)
def test_planes_at_any_angle(run, normal):
    depth = plane(normal, (0.0, 0.0, -0.5))
    unit = np.asarray(normal) / np.linalg.norm(normal)
    found = normals(run, depth)
    seen = np.isfinite(depth)
    np.testing.assert_allclose(found[seen], np.broadcast_to(unit, found.shape)[seen], atol=3e-4)
    assert np.all(found[~seen] == 0.0)


def test_a_corner_stays_sharp_to_the_last_pixel(run):
    floor, wall = plane((0, 0, 1), (0, 0, 0)), plane((1, 0, 0), (0, 0, 0))
    expected = np.where((floor < wall)[..., None], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    wrong = np.abs(normals(run, np.minimum(floor, wall)) - expected).max(-1) > 1e-3
    assert wrong.sum() <= 2  # where the crease crosses a row, a pixel has no neighbor on its own surface


def test_a_sphere_before_a_wall(run):
    wall, (ball, turned) = plane((1, 0, 0), (-2, 0, 0)), sphere((1.0, 0.0, 0.6), 1.2)
    found = normals(run, np.minimum(wall, ball))
    on_wall = wall < ball
    assert on_wall.sum() > 1000 and (~on_wall).sum() > 1000
    np.testing.assert_allclose(found[on_wall], np.broadcast_to([1.0, 0.0, 0.0], found.shape)[on_wall], atol=3e-4)
    facing = ~on_wall & (-(turned * rays()).sum(-1) > 0.5 * np.linalg.norm(rays(), axis=-1))
    error = np.linalg.norm(found - turned, axis=-1)
    assert error[facing].max() < 4e-3
    assert error[~on_wall].max() < 0.3  # where a pixel at the rim has no second one on the sphere


def test_it_is_second_order(run):
    """Half the bend, a quarter of the error: differences are central wherever both sides are smooth."""
    center = (1.0, 0.0, 0.6)
    small, turned = sphere(center, 0.7)
    facing = -(turned * rays()).sum(-1) > 0.8 * np.linalg.norm(rays(), axis=-1)
    error = np.linalg.norm(normals(run, small) - turned, axis=-1)[facing].max()
    large, turned = sphere(center, 1.4)
    facing = -(turned * rays()).sum(-1) > 0.8 * np.linalg.norm(rays(), axis=-1)
    assert np.linalg.norm(normals(run, large) - turned, axis=-1)[facing].max() < error / 3.0


@pytest.mark.parametrize("reach", [1.0, 2.0])
@pytest.mark.parametrize("inside", [False, True])
def test_the_curvature_of_a_sphere(run, reach, inside):
    ball, turned = sphere((1.0, 0.0, 0.6), 8.0 if inside else 1.3, far=inside)
    facing = np.isfinite(ball) & (-(turned * rays()).sum(-1) > 0.6 * np.linalg.norm(rays(), axis=-1))
    facing[:4] = facing[-4:] = facing[:, :4] = facing[:, -4:] = False
    found = curvature(run, ball, reach=reach)[facing]
    assert facing.sum() > 900
    assert np.abs(found * (-8.0 if inside else 1.3) - 1.0).max() < 0.02


def test_planes_have_no_curvature_and_corners_do(run):
    floor, wall = plane((0, 0, 1), (0, 0, 0)), plane((1, 0, 0), (0, 0, 0))
    found = curvature(run, np.minimum(floor, wall))
    crease = np.zeros(found.shape, bool)
    rows = np.abs(np.diff((floor < wall).astype(int), axis=0)).nonzero()[0]
    crease[rows.min() - 2 : rows.max() + 4] = True
    assert np.abs(found[~crease]).max() < 5e-3
    column = found[:, WIDTH // 2]
    assert column.min() < -2.0 and column.max() < 5e-3  # a corner seen from within is hollow


@pytest.mark.parametrize("height", [0.5, 1.0, 3.0])
def test_creases_are_hollow_on_both_sides(run, height):
    """Floor and wall from any height: half of the turn over the way across the crease, from the planes themselves."""
    camera = look_at((5.0, 0.0, height), (0.0, 0.0, 0.02), (0.9, 0.9 * WIDTH / HEIGHT))
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    seen = np.stack([(x + 0.5) / WIDTH, (y + 0.5) / HEIGHT, np.ones_like(x, float)], -1)
    ray = seen @ np.reshape(camera.inverse, (3, 4))[:, :3].T
    with np.errstate(divide="ignore"):
        floor, wall = -height / ray[..., 2], -5.0 / ray[..., 0]
    floor = np.where(floor > 0.0, floor, np.inf)
    depth, is_floor = np.minimum(floor, wall), floor < wall
    place, normal = depth[..., None] * ray, np.where(is_floor[..., None], (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    way, turn = place[4:] - place[:-4], normal[4:] - normal[:-4]
    expected = 0.5 * (turn * way).sum(-1) / (way[..., ::2] ** 2).sum(-1)
    found = run(NormalFromDepth(), {"depth": depth, "camera": camera}, output="curvature")[2:-2, :, 0]
    crease = expected != 0.0
    assert crease.sum() == 4 * WIDTH
    np.testing.assert_allclose(found[crease], expected[crease], rtol=0.02)


def test_silhouettes_are_no_curvature(run):
    wall, (ball, _) = plane((1, 0, 0), (-6, 0, 0)), sphere((1.0, 0.0, 0.6), 1.2)
    found = curvature(run, np.minimum(wall, ball))
    assert np.abs(found[wall < ball]).max() < 1e-2


def test_nothing_is_nothing(run):
    for empty in (np.inf, 1e10, 0.0, -3.0, np.nan):
        depth = np.full((5, 7), empty, np.float32)
        assert not normals(run, depth).any() and not curvature(run, depth).any()
