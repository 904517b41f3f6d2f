"""Shadows of whole objects on a floor, without gaps: against rays that numpy casts at a ball, a box and a thin rod."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import ball, rays
from halation.nodes import look_at
from halation.nodes.light.contact_shadows import ContactShadows
from scipy.ndimage import binary_dilation, binary_erosion, minimum_filter

Array = np.ndarray
SIZE = (240, 135)
RADIUS, ROD = 0.8, 0.03
LOW, HIGH = np.array([-0.5, -0.3, 0.0]), np.array([0.5, 0.5, 0.9])
FAR = 1e10


def meet_ball(eye: Array, way: Array) -> Array:
    """The distance to a ball on the floor, infinite where rays miss it."""
    away = eye - np.array([0.0, 0.0, RADIUS])
    a, b, c = (way * way).sum(-1), (way * away).sum(-1), (away * away).sum(-1) - RADIUS**2
    root = b * b - a * c
    far = (-b - np.sqrt(np.maximum(root, 0.0))) / a
    return np.where((root > 0.0) & (far > 1e-9), far, np.inf)


def meet_box(eye: Array, way: Array) -> Array:
    """The distance to a box on the floor."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, two = (LOW - eye) / way, (HIGH - eye) / way
    enter, leave = np.fmin(one, two).max(-1), np.fmax(one, two).min(-1)
    return np.where((enter < leave) & (enter > 1e-9), enter, np.inf)


def meet_rod(eye: Array, way: Array) -> Array:
    """The distance to the side of an upright rod, 1.2 high."""
    a, b = (way[..., :2] ** 2).sum(-1), (way[..., :2] * eye[..., :2]).sum(-1)
    root = b * b - a * ((eye[..., :2] ** 2).sum(-1) - ROD**2)
    far = (-b - np.sqrt(np.maximum(root, 0.0))) / a
    high = eye[..., 2] + far * way[..., 2]
    return np.where((root > 0.0) & (far > 1e-9) & (high > 0.0) & (high < 1.2), far, np.inf)


def render(meet, eye=(0.3, -5.5, 2.6), size=SIZE):
    """The camera, the depth, and the places of the floor; NaN on the object."""
    camera = look_at(eye, (0.3, 0.2, 0.6), (1.5, 1.5 * size[0] / size[1]))
    way, start = rays(camera, *size), np.array(eye)
    with np.errstate(divide="ignore"):
        floor = np.where(way[..., 2] < 0.0, -start[2] / way[..., 2], np.inf)
    depth = np.minimum(meet(start, way), floor)
    place = np.where(
        (depth == floor)[..., None] & np.isfinite(depth)[..., None], start + floor[..., None] * way, np.nan
    )
    return camera, np.where(np.isfinite(depth), depth, FAR), place


@pytest.mark.parametrize(
    ("meet", "most"),
    [
        (meet_ball, 0.02),
        (meet_rod, 0.1),
        (meet_box, 0.7),  # it is 0.8 deep, but 1.0 wide
    ],
)
@pytest.mark.parametrize("sun", [(-0.6, -0.1, 0.75), (0.7, 0.25, 0.6)])
def test_shadows_have_no_gaps(run, meet, most, sun):
    """All floor is dark whose ray to the sun meets the object, and little else, whatever the thickness."""
    camera, depth, place = render(meet)
    floor = np.isfinite(place[..., 0])
    way = np.array(sun) / np.linalg.norm(sun)
    start = np.nan_to_num(place) + np.array([0.0, 0.0, 1e-6])
    far = np.where(floor, meet(start, np.broadcast_to(way, place.shape)), np.inf)
    dark = floor & (far < 1.3)  # beyond two thirds of the length shadows fade out
    light = floor & ~np.isfinite(far)
    node = ContactShadows(direction=sun, length=2.0, softness=0.0, thickness=0.05)
    shadow = run(node, {"depth": depth, "camera": camera}, output="shadow")[..., 0]
    assert dark.sum() > 50
    assert (dark & (minimum_filter(shadow, 3) > 0.5)).sum() <= 0.05 * dark.sum()
    assert (binary_erosion(dark, iterations=2) & (shadow > 0.01)).sum() <= 0.05 * dark.sum()
    assert (light & ~binary_dilation(np.isfinite(far), iterations=2) & (shadow < 0.5)).sum() <= most * dark.sum()


def test_a_ball_before_a_wall_has_a_round_shadow(run):
    """The area of the shadow on the floor is that of the ball's, not a crescent."""
    camera, depth, place = render(meet_ball)
    seen = ball(camera, (0.0, 0.0, RADIUS), RADIUS, *SIZE)
    np.testing.assert_allclose(depth[seen["depth"] < depth + 1e-6], seen["depth"][seen["depth"] < depth + 1e-6])
    way = np.array((0.5, 0.1, 0.86))
    far = meet_ball(np.nan_to_num(place) + np.array([0.0, 0.0, 1e-6]), np.broadcast_to(way, place.shape))
    dark = np.isfinite(place[..., 0]) & np.isfinite(far)
    node = ContactShadows(direction=tuple(way), length=4.0, softness=4.0)
    shadow = run(node, {"depth": depth, "camera": camera}, output="shadow")[..., 0]
    covered = (1.0 - shadow)[np.isfinite(place[..., 0])].sum()
    assert abs(covered / dark.sum() - 1.0) < 0.05


def test_a_large_picture_has_the_whole_shadow(run):
    """Rays behind a ball walk through hundreds of pixels: a sixth of its shadow was missing when 512 steps ended them.

    They also pass close behind its far side: a tenth was missing when the ball counted as deep as its front, which is
    nearer than its middle, is wide.
    """
    camera, depth, place = render(meet_ball, size=(1440, 810))
    way = np.array((-0.9, -0.2, 0.25)) / np.linalg.norm((-0.9, -0.2, 0.25))
    start = np.nan_to_num(place) + np.array([0.0, 0.0, 1e-6])
    far = np.where(np.isfinite(place[..., 0]), meet_ball(start, np.broadcast_to(way, place.shape)), np.inf)
    dark = binary_erosion(far < 2.6, iterations=4)
    node = ContactShadows(direction=tuple(way), length=4.0, softness=0.0, thickness=1.0)
    shadow = run(node, {"depth": depth, "camera": camera}, output="shadow")[..., 0]
    assert dark.sum() > 50000
    assert (dark & (shadow > 0.01)).sum() == 0


@pytest.mark.parametrize("side", [0.08, 0.15, 0.3])
@pytest.mark.parametrize("lean", [0.05, 0.12])
def test_a_side_thinner_than_a_pixel_hides_no_ray_behind_it(run, lean, side):
    """A wall in the sun beyond a tower, whose right side is seen at a grazing angle and leans in the picture.

    All rays pass more than a tower's depth behind its back, so no part of the wall is in its shadow. `side` is the
    width of the side in the picture, as a part of the place of its edge.
    """
    size, eye = (240, 135), np.array([0.0, 0.0, 0.0])
    camera = look_at(tuple(eye), (0.0, 1.0, 0.0), (0.6, 0.6 * size[0] / size[1]), (lean, 0.0, 1.0))
    way = rays(camera, *size)
    low, high = np.array([-1.0, 7.0, -9.0]), np.array([-side, 8.0, 9.0])
    with np.errstate(divide="ignore", invalid="ignore"):
        one, two = (low - eye) / way, (high - eye) / way
    enter, leave = np.fmin(one, two).max(-1), np.fmax(one, two).min(-1)
    tower = (enter < leave) & (enter > 0.0)
    depth = np.where(tower, enter, 10.0 / way[..., 1])
    grazed = tower & (np.abs(way[..., 0] * enter + side) < 1e-6)
    assert grazed.sum() > 10  # so that there is something to do wrong
    values = {"direction": (-0.9, -0.1, 0.3), "softness": 0.0, "length": 4.0, "thickness": 1.0}
    shadow = run(ContactShadows(**values), {"depth": depth, "camera": camera}, output="shadow")[..., 0]
    wall = ~binary_dilation(tower, iterations=2)
    assert wall.sum() > 5000 and shadow[wall].min() == 1.0
