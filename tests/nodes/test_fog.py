"""Fog against its closed forms in float64, the layer on the ground against scipy's numerical integral."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import CAMERA, rays
from halation.nodes import look_at
from halation.nodes.geometry.fog import Fog
from scipy.integrate import quad

SKY = 1e10


def depths(width: int = 13, height: int = 9) -> np.ndarray:
    return np.random.default_rng(4).uniform(0.3, 40.0, (height, width)).astype(np.float32)


def amount(run, node, depth, **more):
    picture = np.zeros((*depth.shape, 4))
    return run(node, {"image": picture, "depth": depth, **more}, output="amount")[..., 0]


@pytest.mark.parametrize("seen", [False, True])
@pytest.mark.parametrize("mode", ["linear", "exponential", "exponential squared"])
def test_the_three_kinds_of_opengl(run, mode, seen):
    depth, density, start, end = depths(), 0.07, 3.0, 25.0
    way = depth * np.linalg.norm(rays(CAMERA, 13, 9), axis=2) if seen else depth.astype(float)
    thick = density * np.maximum(way - start, 0.0)
    expected = {
        "linear": np.clip((way - start) / (end - start), 0.0, 1.0),
        "exponential": 1.0 - np.exp(-thick),
        "exponential squared": 1.0 - np.exp(-(thick**2)),
    }[mode]
    node = Fog(mode=mode, density=density, start=start, end=end, color=(1.0, 1.0, 1.0, 0.8))
    found = amount(run, node, depth, **({"camera": CAMERA} if seen else {}))
    np.testing.assert_allclose(found, 0.8 * expected, atol=1e-6)


LOOKS = {
    "down": look_at((0.0, -6.0, 5.0), (0.0, 0.0, -4.0), (1.0, 1.5)),
    "level": look_at((0.0, -6.0, 0.5), (0.0, 0.0, 0.5), (1.0, 1.5)),
    "up": look_at((0.0, -6.0, 0.2), (0.0, 0.0, 6.0), (1.0, 1.5)),
    "from far above": look_at((0.0, -6.0, 90.0), (0.0, 0.0, 0.0), (1.0, 1.5)),
}


def integral(eye, way, rise, start, density, base, thickness):
    """Of the density along one way, numerically."""
    if way <= start:
        return 0.0
    return quad(lambda s: density * np.exp(-(eye + s * rise - base) / thickness), start, way, epsrel=1e-10)[0]


@pytest.mark.parametrize("look", LOOKS)
@pytest.mark.parametrize("axis", ["z", "y"])
def test_a_layer_on_the_ground_is_the_integral_along_the_way(run, look, axis):
    camera, depth = LOOKS[look], depths()
    if axis == "y":  # the same world with its axes in another order: x, z, y
        rows = np.reshape(camera.rows, (3, 4))[:, [0, 2, 1, 3]]
        camera = type(camera)(tuple(rows.ravel()))
    ray = rays(camera, 13, 9)
    length = np.linalg.norm(ray, axis=2)
    up = {"z": 2, "y": 1}[axis]
    density, start, base, thickness = 0.05, 2.0, 0.7, 1.9
    expected = np.array(
        [
            integral(camera.eye[up], depth[p] * length[p], ray[p][up] / length[p], start, density, base, thickness)
            for p in np.ndindex(depth.shape)
        ]
    ).reshape(depth.shape)
    node = Fog(mode="height", density=density, start=start, base=base, thickness=thickness, up=axis)
    np.testing.assert_allclose(amount(run, node, depth, camera=camera), 1.0 - np.exp(-expected), atol=3e-6)


def test_a_layer_below_the_sky(run):
    """Upwards it thins out to density * thickness / rise, downwards it has no end."""
    camera = LOOKS["up"]
    ray = rays(camera, 7, 5)
    rise = ray[..., 2] / np.linalg.norm(ray, axis=2)
    node = Fog(mode="height", density=0.2, start=0.0, base=0.0, thickness=3.0, sky=0.75)
    found = amount(run, node, np.full((5, 7), SKY), camera=camera)
    thick = 0.2 * np.exp(-0.2 / 3.0) * 3.0 / rise
    assert rise.min() > 0.0
    np.testing.assert_allclose(found, 0.75 * (1.0 - np.exp(-thick)), atol=1e-6)
    below = amount(run, node, np.full((5, 7), SKY), camera=LOOKS["down"])
    np.testing.assert_allclose(below, 0.75, atol=1e-6)


def test_positions_do_for_the_height(run):
    """Of a place and the height of the eye, the same integral along the depth."""
    depth, height = depths(), np.random.default_rng(9).uniform(-2.0, 6.0, (9, 13))
    position = np.dstack([np.ones_like(height), np.ones_like(height), height])
    node = Fog(mode="height", density=0.06, start=1.5, base=0.3, thickness=2.0, eye=1.1)
    expected = np.array(
        [integral(1.1, depth[p], (height[p] - 1.1) / depth[p], 1.5, 0.06, 0.3, 2.0) for p in np.ndindex(depth.shape)]
    ).reshape(depth.shape)
    np.testing.assert_allclose(amount(run, node, depth, position=position), 1.0 - np.exp(-expected), atol=3e-6)


def test_alpha_is_kept_or_filled(run, hdr):
    """As premultiplied layers: fog that is as opaque as `amount` lies over the picture."""
    picture, depth = hdr(13, 9), depths()
    color = np.array([0.4, 0.5, 0.9])
    hidden = (1.0 - np.exp(-0.1 * depth.astype(float)))[..., None]
    for alpha in ("keep", "fill"):
        node = Fog(density=0.1, start=0.0, color=(*color, 1.0), alpha=alpha)
        found = run(node, {"image": picture, "depth": depth})
        covered = picture[..., 3:] if alpha == "keep" else 1.0
        np.testing.assert_allclose(
            found[..., :3], picture[..., :3] * (1.0 - hidden) + color * hidden * covered, rtol=2e-5, atol=1e-5
        )
        wanted = picture[..., 3:] if alpha == "keep" else picture[..., 3:] * (1.0 - hidden) + hidden
        np.testing.assert_allclose(found[..., 3:], wanted, atol=1e-6)


def test_a_layer_in_fog_over_a_picture_in_fog_is_both_in_fog(run):
    """Kept alpha: fog first and merge then is the light of each, dimmed by its own fog."""
    depth = np.full((1, 1), 7.0)
    node, clear = Fog(density=0.1, start=0.0), Fog(density=0.0)
    layer = np.array([[[0.3, 0.2, 0.1, 0.6]]])
    plain, foggy = (run(one, {"image": layer, "depth": depth}) for one in (clear, node))
    np.testing.assert_allclose(plain, layer, rtol=1e-6)
    solid = run(node, {"image": layer / layer[..., 3:], "depth": depth})
    np.testing.assert_allclose(foggy, solid * layer[..., 3:], rtol=1e-6)


def test_the_fog_glows_towards_the_sun(run):
    picture, depth = np.zeros((9, 13, 4)), np.full((9, 13), 1e4)
    picture[..., 3] = 1.0
    sun = np.array([0.1, 0.8, -0.1])
    node = Fog(
        density=1.0,
        color=(0.2, 0.3, 0.4, 1.0),
        sun=0.9,
        sun_color=(2.0, 1.5, 1.0, 1.0),
        sun_direction=tuple(sun),
        sun_focus=6.0,
    )
    ray = rays(CAMERA, 13, 9)
    along = ray @ sun / np.linalg.norm(ray, axis=2) / np.linalg.norm(sun)
    share = 0.9 * np.maximum(along, 0.0)[..., None] ** 6.0
    expected = np.array([0.2, 0.3, 0.4]) * (1.0 - share) + np.array([2.0, 1.5, 1.0]) * share
    found = run(node, {"image": picture, "depth": depth, "camera": CAMERA})
    np.testing.assert_allclose(found[..., :3], expected, rtol=1e-5)
    away = node.with_values(sun_direction=tuple(-np.array(CAMERA.forward)))
    found = run(away, {"image": picture, "depth": depth, "camera": CAMERA})
    np.testing.assert_allclose(found[0, 0], (0.2, 0.3, 0.4, 1.0), rtol=1e-6)
