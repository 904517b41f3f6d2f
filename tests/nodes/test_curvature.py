"""Curvature on balls, a pillar, planes and folds, where it is known."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import CAMERA, ball, rays
from halation.nodes import look_at
from halation.nodes.geometry.curvature import Curvature
from scipy.ndimage import binary_erosion

CENTER = (0.4, 0.3, 1.1)
WAYS = {"position": ("normal", "position"), "depth": ("normal", "depth", "camera")}


def mean(run, node, picture, *names):
    inputs = {name: picture[name] for name in names}
    return run(node, inputs, output="mean")[..., 0]


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("radius", [0.5, 1.6])
@pytest.mark.parametrize("reach", [1.0, 3.0])
def test_a_ball_bends_by_one_over_its_radius(run, way, radius, reach):
    """Everywhere, up to its silhouette, which is never looked across."""
    picture = ball(CAMERA, CENTER, radius, 90, 60) | {"camera": CAMERA}
    there = picture["depth"] < 1e9
    found = mean(run, Curvature(reach=reach), picture, *WAYS[way])
    inside = binary_erosion(there, iterations=3)
    assert inside.sum() > 50
    np.testing.assert_allclose(found[inside], 1.0 / radius, rtol=2e-4)
    assert (found[~there] == 0.0).all()
    known = found[there & (found != 0.0)]
    np.testing.assert_allclose(known, 1.0 / radius, rtol=2e-4)
    hollow = picture | {"normal": -picture["normal"]}
    np.testing.assert_allclose(mean(run, Curvature(reach=reach), hollow, *WAYS[way]), -found, atol=1e-5)


def test_one_ball_before_another(run):
    """Each has its own curvature, right up to the gap between them."""
    front, back = ball(CAMERA, CENTER, 0.7, 90, 60), ball(CAMERA, (1.6, 6.0, 1.4), 2.5, 90, 60)
    mine = front["depth"] < back["depth"]
    picture = {
        name: np.where(mine if front[name].ndim == 2 else mine[..., None], front[name], back[name]) for name in front
    }
    found = mean(run, Curvature(), picture, "normal", "position")
    wanted = np.where(mine, 1.0 / 0.7, np.where(back["depth"] < 1e9, 1.0 / 2.5, 0.0))
    known = found != 0.0
    assert (known & mine).sum() > 0.95 * mine.sum() > 100
    np.testing.assert_allclose(found[known], wanted[known], rtol=1e-3)


def test_a_pillar_bends_by_half(run):
    """An upright cylinder, from afar: half of 1 / radius."""
    camera, radius = look_at((0.0, -50.0, 0.0), (0.0, 0.0, 0.0), (12.0, 18.0)), 1.5
    ray, eye = rays(camera, 90, 60), np.array(camera.eye)
    flat, start = ray[..., :2], eye[:2]
    a, b = (flat * flat).sum(2), flat @ start
    root = b * b - a * (start @ start - radius**2)
    there = root > 0.0
    depth = np.where(there, (-b - np.sqrt(np.maximum(root, 0.0))) / a, 1e10)
    position = np.where(there[..., None], eye + depth[..., None] * ray, 0.0)
    normal = np.where(there[..., None], position * (1.0, 1.0, 0.0) / radius, 0.0)
    found = mean(run, Curvature(), {"normal": normal, "position": position}, "normal", "position")
    inside = np.abs(position[..., 0]) < 0.9 * radius
    np.testing.assert_allclose(found[there & inside], 0.5 / radius, rtol=5e-3)


def test_a_fold_is_a_ridge_from_outside_and_a_cavity_from_inside(run):
    """Two planes at right angles: nothing on them, and across the fold the turn over twice the way."""
    x, y = np.meshgrid(np.arange(20) - 9.5, np.arange(12.0))
    position = np.dstack([x, y + 1.0, -np.abs(x)])
    slope = np.sqrt(0.5) * np.dstack([np.sign(x), np.zeros_like(x), np.ones_like(x)])
    for sign, output in ((1.0, "ridge"), (-1.0, "cavity")):
        inputs = {"normal": sign * slope, "position": position}
        found = run(Curvature(radius=0.4), inputs, output=output)[..., 0]
        # One pixel on either side: their neighbors lie (2, 0, -1 or 1) apart, and turn by (sqrt 2, 0, 0).
        np.testing.assert_allclose(found[:, 9:11], 0.4 * 0.5 * 2.0 * 2.0**0.5 / 5.0, rtol=1e-4)
        assert (found[:, :9] == 0.0).all() and (found[:, 11:] == 0.0).all()
        other = run(Curvature(radius=0.4), inputs, output="cavity" if sign > 0.0 else "ridge")
        assert (other == 0.0).all()


def test_the_outputs_are_parts_of_the_mean(run):
    picture = ball(CAMERA, CENTER, 1.6, 40, 30)
    inputs = {name: picture[name] for name in WAYS["position"]}
    for radius in (0.25, 1.0, 4.0):
        ridge = run(Curvature(radius=radius), inputs, output="ridge")[15, 20, 0]
        assert ridge == pytest.approx(min(radius / 1.6, 1.0), rel=1e-3)
    hollow = inputs | {"normal": -inputs["normal"]}
    assert run(Curvature(radius=0.4), hollow, output="cavity")[15, 20, 0] == pytest.approx(0.25, rel=1e-3)


@pytest.mark.parametrize("camera", [None, CAMERA])
def test_normals_alone_see_a_ball_from_afar(run, camera):
    """In parallel view, with a radius of 0.4 picture heights."""
    height, width, radius = 200, 240, 0.4
    y, x = np.mgrid[:height, :width]
    right, up = (x + 0.5 - width / 2) / height / radius, -(y + 0.5 - height / 2) / height / radius
    square = right**2 + up**2
    there = square < 1.0
    out = np.sqrt(np.maximum(1.0 - square, 0.0))
    if camera is None:
        normal, inputs = np.dstack([right, up, out]), {}
    else:
        axes = np.array([camera.right, -np.array(camera.down), -np.array(camera.forward)])
        normal, inputs = np.dstack([right, up, out]) @ axes, {"camera": camera}
    normal[~there] = 0.0
    found = run(Curvature(), inputs | {"normal": normal}, output="mean")[..., 0]
    np.testing.assert_allclose(found[square < 0.7], 1.0 / radius, rtol=2e-3)
    assert (found[~there] == 0.0).all()


@pytest.mark.parametrize("reach", [1.0, 3.0])
def test_normals_alone_stop_at_holes_and_at_the_border(run, reach):
    """A ball larger than the picture, with pixels that have no normal: beside them it still bends by 1 / radius."""
    height, width, radius = 48, 64, 2.0
    y, x = np.mgrid[:height, :width]
    right, up = (x + 0.5 - width / 2) / height / radius, -(y + 0.5 - height / 2) / height / radius
    normal = np.dstack([right, up, np.sqrt(1.0 - right**2 - up**2)])
    holes = np.zeros((height, width), bool)
    holes[8:-8:11, 8:-8:11] = True
    normal[holes] = 0.0
    found = run(Curvature(reach=reach), {"normal": normal}, output="mean")[..., 0]
    assert (found[holes] == 0.0).all()
    # A difference to one side is of the place half of the reach away, where the ball is at another angle.
    np.testing.assert_allclose(found[~holes], 1.0 / radius, rtol=0.02 * reach)
