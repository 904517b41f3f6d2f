"""Facing and rim light on a ball, whose normals and ways to the camera are known."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import CAMERA, ball, rays
from halation.nodes.geometry.facing import Facing
from halation.nodes.geometry.rim_light import RimLight

BALL = ball(CAMERA, (0.4, 0.3, 1.1), 1.6, 60, 40)
THERE = BALL["depth"] < 1e9


def cosine(normal: np.ndarray, camera=CAMERA) -> np.ndarray:
    height, width = normal.shape[:2]
    ray = rays(camera, width, height)
    return -(normal * ray).sum(2) / np.linalg.norm(ray, axis=2)


def test_facing_is_the_cosine(run):
    found = run(Facing(), {"normal": BALL["normal"], "camera": CAMERA})[..., 0]
    np.testing.assert_allclose(found[THERE], cosine(BALL["normal"])[THERE], atol=2e-6)
    assert (found[~THERE] == 0.0).all() and found.max() > 0.999 and found[THERE].min() < 0.2
    turned = run(Facing(), {"normal": -BALL["normal"], "camera": CAMERA})
    assert (turned == 0.0).all()
    scaled = run(Facing(), {"normal": 0.99 * BALL["normal"], "camera": CAMERA})[..., 0]
    np.testing.assert_allclose(scaled, found, atol=1e-6)


def test_without_a_camera_normals_are_its_own(run):
    normal = np.random.default_rng(2).normal(size=(9, 11, 3))
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    found = run(Facing(), {"normal": normal})[..., 0]
    np.testing.assert_allclose(found, np.maximum(normal[..., 2], 0.0), atol=1e-6)


def test_a_mixed_normal_asks_its_neighbors(run):
    """One pixel between two planes and the background: the mean of what the whole normals around it face."""
    normal = np.zeros((5, 5, 3))
    normal[:, :2], normal[:, 3:] = (0.0, 0.6, 0.8), (0.0, -0.8, 0.6)
    normal[:, 2] = normal[:, 1] * 0.5 + normal[:, 3] * 0.5
    normal[4] = 0.0
    found = run(Facing(), {"normal": normal})[..., 0]
    np.testing.assert_allclose(found[:4], [[0.8, 0.8, 0.7, 0.6, 0.6]] * 4, atol=1e-6)
    assert (found[4] == 0.0).all()
    alone = np.full((3, 3, 3), 0.3)
    np.testing.assert_allclose(run(Facing(), {"normal": alone}), 3.0**-0.5, atol=1e-6)


@pytest.mark.parametrize("power", [0.5, 1.0, 3.0, 10.0])
def test_the_rim_is_a_power_of_what_turns_away(run, power):
    inputs = {"image": np.zeros((40, 60, 4)), "normal": BALL["normal"], "camera": CAMERA}
    found = run(RimLight(power=power), inputs, output="rim")[..., 0]
    expected = np.where(THERE, (1.0 - np.clip(cosine(BALL["normal"]), 0.0, 1.0)) ** power, 0.0)
    np.testing.assert_allclose(found, expected, atol=2e-5 if power >= 1.0 else 2e-3)


@pytest.mark.parametrize("angle", [0.0, 90.0, -135.0])
def test_it_can_come_from_one_side(run, angle):
    """Times (1 + cos) / 2 of the angle in the picture between the rim and the light."""
    normal = BALL["normal"]
    inputs = {"image": np.zeros((40, 60, 4)), "normal": normal, "camera": CAMERA}
    whole, side = (
        run(RimLight(power=1.0, focus=focus, angle=angle), inputs, output="rim")[..., 0] for focus in (0.0, 0.8)
    )
    ray = rays(CAMERA, 60, 40)
    ray /= np.linalg.norm(ray, axis=2, keepdims=True)
    across = normal - ray * (normal * ray).sum(2, keepdims=True)
    across /= np.maximum(np.linalg.norm(across, axis=2, keepdims=True), 1e-6)
    towards = np.cos(np.radians(angle)) * np.array(CAMERA.right) - np.sin(np.radians(angle)) * np.array(CAMERA.down)
    expected = whole * (0.2 + 0.8 * (0.5 + 0.5 * across @ towards))
    np.testing.assert_allclose(side[THERE], expected[THERE], atol=1e-4)


def test_it_is_added_on_what_is_covered(run, hdr):
    picture, mask = hdr(60, 40), np.random.default_rng(1).random((40, 60))
    inputs = {"image": picture, "normal": BALL["normal"], "camera": CAMERA, "mask": mask}
    node = RimLight(color=(0.2, 0.5, 1.0, 0.5), intensity=3.0)
    rim = run(node, inputs, output="rim")
    expected = picture.copy()
    expected[..., :3] += np.array([0.3, 0.75, 1.5]) * rim * mask[..., None] * picture[..., 3:]
    np.testing.assert_allclose(run(node, inputs), expected, rtol=1e-5, atol=1e-6)
    np.testing.assert_array_equal(run(RimLight(intensity=0.0), inputs), picture)


def test_masks_end_at_nothing_and_at_all(run):
    inputs = {"image": np.ones((40, 60, 4)), "normal": BALL["normal"], "camera": CAMERA}
    none, half, whole = (run(RimLight(), inputs | {"mask": np.full((40, 60), mask)}) for mask in (0.0, 0.5, 1.0))
    assert (none[..., :3] == 1.0).all() and whole.max() > half.max() > 1.0
    np.testing.assert_allclose(half - 1.0, 0.5 * (whole - 1.0), atol=1e-6)
    for mask, expected in ((-1.0, none), (3.0, whole), (np.nan, none)):
        np.testing.assert_array_equal(run(RimLight(), inputs | {"mask": np.full((40, 60), mask)}), expected)


def test_broken_pixels_become_finite_and_stay_alone(run):
    """A pixel that is not a number is black, one that is infinite is the largest half, and light ends there too."""
    picture = np.full((40, 60, 4), 0.5, np.float32)
    picture[20, 30], picture[20, 31, 0], picture[20, 32, 3] = np.nan, np.inf, np.nan
    inputs = {"normal": BALL["normal"], "camera": CAMERA}
    found, sound = (run(RimLight(), {"image": image, **inputs}) for image in (picture, np.full_like(picture, 0.5)))
    assert np.isfinite(found).all()
    np.testing.assert_array_equal(found[20, 30], 0.0)
    assert found[20, 31, 0] == 65504.0
    np.testing.assert_array_equal(found[20, 32], (0.5, 0.5, 0.5, 0.0))  # without cover no light is added
    changed = (found != sound).any(2)
    assert [*zip(*np.nonzero(changed), strict=True)] == [(20, 30), (20, 31), (20, 32)]
    suns = np.full((40, 60, 4), (3e38, 1.0, 1.0, 1.0), np.float32)
    bright = run(RimLight(color=(3e38, 1.0, 1.0, 1.0), intensity=4.0), {"image": suns, **inputs})
    assert np.isfinite(bright).all() and (bright[..., 0] == 65504.0).any()


@pytest.mark.parametrize("angle", [0.0, 30.0, -120.0])
def test_without_a_camera_one_looks_along_the_axis(run, angle):
    """Normals in the picture's own axes: what turns away is 1 - z, and the side is that of (x, y)."""
    normal = np.random.default_rng(3).normal(size=(12, 14, 3))
    normal[..., 2] = np.abs(normal[..., 2])
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    node = RimLight(power=2.0, focus=1.0, angle=angle)
    found = run(node, {"image": np.zeros((12, 14, 4)), "normal": normal}, output="rim")[..., 0]
    across = normal[..., :2] / np.linalg.norm(normal[..., :2], axis=2, keepdims=True)
    towards = across @ (np.cos(np.radians(angle)), np.sin(np.radians(angle)))
    np.testing.assert_allclose(found, (1.0 - normal[..., 2]) ** 2 * (0.5 + 0.5 * towards), atol=2e-6)
