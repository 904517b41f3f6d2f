"""Directional occlusion against closed forms, and against sums over all directions in numpy."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import CameraModel, look_at
from halation.nodes.light.ambient_occlusion import AmbientOcclusion
from halation.nodes.light.directional_occlusion import DirectionalOcclusion
from lens import blender
from scipy.ndimage import binary_erosion, gaussian_filter

SIZE, SMALL = (320, 180), (160, 90)


def corner(wall=True, size=SIZE):
    """Floor and wall: camera, depth, normals, places, and where a radius of 0.5 fits the picture."""
    width, height = size
    camera = look_at((5.0, 0.0, 3.0), (1.0, 0.0, 0.6), (30 / 36, 30 / 36 * width / height))
    y, x = np.mgrid[0:height, 0:width]
    seen = np.stack([(x + 0.5) / width, (y + 0.5) / height, np.ones(x.shape)], -1)
    rays = seen @ np.reshape(camera.inverse, (3, 4))[:, :3].T
    with np.errstate(divide="ignore"):
        floor, side = (-np.asarray(camera.eye)[axis] / rays[..., axis] for axis in (2, 0))
    floor, side = (np.where(depth > 0, depth, np.inf) for depth in (floor, side))
    depth = np.minimum(floor, side) if wall else floor
    normal = np.where((floor == depth)[..., None], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    with np.errstate(invalid="ignore"):
        place = camera.eye + depth[..., None] * rays
    reach = 0.5 / depth * 30 / 36 * width + 2
    return camera, depth, normal, place, (x > reach) & (x < width - reach) & (y > reach) & (y < height - reach)


def light(run, scene, image=None, environment=None, albedo=None, output="light", **values):
    camera, depth, normal, *_ = scene
    given = {"depth": depth, "normal": normal, "camera": camera}
    given["image"] = np.zeros((*depth.shape, 4)) if image is None else image
    if environment is not None:
        given["environment"] = environment
    if albedo is not None:
        given["albedo"] = albedo
    return run(DirectionalOcclusion(**({"radius": 0.5, "falloff": 0.0} | values)), given, output=output)


def sky(function, size=(64, 32), y_up=False):
    """An environment that is a function of direction."""
    width, height = size
    v, u = np.meshgrid((np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij")
    around, below = (0.5 - u) * 2 * np.pi, v * np.pi
    way = np.stack([np.sin(below) * np.cos(around), np.sin(below) * np.sin(around), np.cos(below)], -1)
    if y_up:
        way = way[..., [1, 2, 0]]
    return np.concatenate([function(way), np.ones((height, width, 1))], -1)


def even(*color):
    return np.broadcast_to(np.float32([*color, 1.0]), (4, 8, 4))


def share(c):
    c = np.clip(c, 0, 1)
    return 1 - (np.arccos(c) - c * np.sqrt(1 - c * c)) / np.pi


@pytest.mark.parametrize("resolution", ["full", "half"])
def test_an_even_sky_is_albedo_times_light_times_occlusion(run, resolution):
    scene = corner()
    albedo = np.broadcast_to(np.float32([0.8, 0.4, 0.1, 1.0]), (*scene[1].shape, 4))
    found = light(run, scene, environment=even(0.5, 2.0, 3.0), albedo=albedo, resolution=resolution, intensity=1.5)
    node = AmbientOcclusion(radius=0.5, falloff=0.0, resolution=resolution)
    open_ = run(node, {"depth": scene[1], "normal": scene[2], "camera": scene[0]}, output="occlusion")
    expected = open_ * np.array([0.8 * 0.5, 0.4 * 2.0, 0.1 * 3.0]) * 1.5
    np.testing.assert_allclose(found[..., :3], expected, rtol=2e-4, atol=1e-5)
    _, _, normal, place, inner = scene
    away = np.where(normal[..., 2] > 0.5, place[..., 0], place[..., 2])
    error = (found[..., 0] / 0.6 - share(away / 0.5))[inner]
    assert abs(error.mean()) < 0.01 and np.sqrt((error**2).mean()) < 0.02


@pytest.mark.parametrize("turn", [0.0, 90.0, 217.0])
def test_half_a_sky_lights_open_ground_by_half(run, turn):
    half = sky(lambda way: np.repeat((way[..., :1] > 0.0).astype(float), 3, -1))
    scene = corner(wall=False)
    found = light(run, scene, environment=half, rotation=turn)[..., 0][np.isfinite(scene[1])]
    assert abs(found.mean() - 0.5) < 0.005 and np.sqrt(((found - 0.5) ** 2).mean()) < 0.02


@pytest.mark.parametrize("resolution", ["full", "half"])
def test_a_wall_hides_only_its_side_of_the_sky(run, resolution):
    """Light from before the wall stays half; of light from behind it, as much goes as the wall hides."""
    scene = corner()
    place, floor = scene[3], scene[4] & (scene[2][..., 2] > 0.5)
    for turn, expected in ((0.0, np.full(floor.shape, 0.5)), (180.0, share(place[..., 0] / 0.5) - 0.5)):
        half = sky(lambda way: np.repeat((way[..., :1] > 0.0).astype(float), 3, -1))
        error = (light(run, scene, environment=half, rotation=turn, resolution=resolution)[..., 0] - expected)[floor]
        assert abs(error.mean()) < 0.01 and np.sqrt((error**2).mean()) < 0.02


@pytest.mark.parametrize("up", ["z", "y"])
@pytest.mark.parametrize("turn", [0.0, 40.0])
def test_colored_light_comes_from_where_it_is(run, up, turn):
    """Smooth light from all sides on open floor and wall, summed over the sphere in numpy."""

    def glow(way):
        return np.stack([1 + way[..., 0], (1 + way[..., 1]) ** 2, np.exp(way[..., 2])], -1)

    found = light(run, corner(wall=False), environment=sky(glow, (128, 64), up == "y"), rotation=turn, up=up)
    steps = np.linspace(0, 1, 200, endpoint=False) + 0.0025
    u, v = np.meshgrid(steps, steps)
    way = np.stack([np.sqrt(u) * np.cos(2 * np.pi * v), np.sqrt(u) * np.sin(2 * np.pi * v), np.sqrt(1 - u)], -1)
    angle = np.radians(turn)
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = np.moveaxis(way, -1, 0)
    # Turning the surroundings one way is looking at them turned the other way.
    seen = (c * x + s * y, -s * x + c * y, z) if up == "z" else (c * x - s * z, y, s * x + c * z)
    expected = glow(np.stack(seen, -1)).mean((0, 1))
    floor = found[110:160, 80:240, :3]
    assert np.abs(floor - expected).max() < 0.02 * expected.max()


@pytest.mark.parametrize("resolution", ["full", "half"])
def test_a_wall_bounces_what_it_hides(run, resolution):
    """C1's complement: where a wall of even light blocks, its light comes from it instead."""
    _, depth, normal, place, inner = scene = corner()
    wall = normal[..., 0] > 0.5
    image = np.zeros((*depth.shape, 4), np.float32)
    image[wall] = (3.0, 1.0, 0.2, 1.0)
    found = light(run, scene, image=image, resolution=resolution)
    blocked = 1 - share(place[..., 0] / 0.5)
    floor = inner & ~wall
    for channel, color in enumerate((3.0, 1.0, 0.2)):
        error = (found[..., channel] / color - blocked)[floor]
        assert abs(error.mean()) < 0.01 and np.sqrt((error**2).mean()) < 0.02
    assert np.abs(found[wall][:, :3]).max() < 1e-3  # the floor is black, and a plane does not light itself
    np.testing.assert_allclose(light(run, scene, image=image, resolution=resolution, bounce=2.0), [2, 2, 2, 1] * found)


def test_all_that_comes_in_a_furnace_is_one(run):
    """Surroundings and surfaces of the same light: what is hidden is made up for, everywhere."""
    scene = corner()
    ones = np.ones((*scene[1].shape, 4), np.float32)
    for values in ({"falloff": 0.0}, {"falloff": 0.7}, {"quality": "preview"}, {"radius": 2.0}):
        found = light(run, scene, image=ones, environment=even(1.0, 1.0, 1.0), **values)
        assert np.abs(found - 1.0).max() < 1e-4


def test_what_looks_away_gives_no_light(run):
    """A bright board before a floor that faces the camera only: the floor behind it sees its dark back."""
    camera, depth, normal, *_ = corner(wall=False)
    board = np.zeros(depth.shape, bool)
    board[53:93, 120:200] = True
    near = np.where(board, depth - 0.2, depth)
    toward = np.where(board[..., None], [1.0, 0.0, 0.0], normal)
    image = np.zeros((*depth.shape, 4), np.float32)
    image[board] = 1.0
    found = light(run, (camera, near, toward), image=image, radius=1.0)[..., 0]
    behind, before = found[46:51, 130:190], found[95:100, 130:190]
    assert behind.max() < 1e-5 < 0.01 < before.mean()


def test_the_picture_gets_the_light(run):
    scene = corner(size=(48, 27))
    rng = np.random.default_rng(3)
    image = rng.random((27, 48, 4)).astype(np.float32)
    given = {"image": image, "environment": even(0.3, 0.4, 0.5)}
    added, out = light(run, scene, **given), light(run, scene, **given, output="out")
    np.testing.assert_allclose(out[..., :3], image[..., :3] + added[..., :3] * image[..., 3:], rtol=1e-5)
    np.testing.assert_array_equal(out[..., 3], image[..., 3])


def test_nothing_gets_no_light(run):
    camera, depth, normal, *_ = corner(size=(48, 27))
    depth[:, :20] = 1e10
    scene = camera, depth, normal
    found = light(run, scene, image=np.ones((27, 48, 4)), environment=even(1.0, 1.0, 1.0))
    assert not found[:, :20, :3].any() and found[:, 20:, :3].min() > 0.5


def wall_and_floor(high, size=SMALL, eye=(2.4, 0.0, 2.0), target=(0.25, 0.0, 0.15)):
    """A floor and a wall so high, which goes on below: a scene as of corner(), and where it is floor and wall."""
    width, height = size
    camera = look_at(eye, target, (1.0, width / height))
    y, x = np.mgrid[0:height, 0:width]
    rays = np.stack([(x + 0.5) / width, (y + 0.5) / height, np.ones(x.shape)], -1)
    rays = rays @ np.reshape(camera.inverse, (3, 4))[:, :3].T
    floor, wall = (-np.array(eye)[axis] / rays[..., axis] for axis in (2, 0))
    top = eye[2] + wall * rays[..., 2]
    stands = (wall > 0) & (top < high) & (top > 0)
    depth = np.where(stands, wall, np.where((floor > 0) & (eye[0] + floor * rays[..., 0] > 0), floor, 1e10))
    ground = ~stands & (depth < 1e9)
    normal = np.where(stands[..., None], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]) * (depth < 1e9)[..., None]
    return (camera, depth, normal), np.array(eye) + depth[..., None] * rays, ground, stands


def hidden(place, side, high, radius):
    """Of a floor's light by the cosine, what a plane through the y axis hides that rises `high` to a side, by rays."""
    u, turn = np.meshgrid((np.arange(400) + 0.5) / 400, (np.arange(400) + 0.5) * np.pi / 200)
    way = np.stack([np.sqrt(u) * np.cos(turn), np.sqrt(u) * np.sin(turn), np.sqrt(1.0 - u)], -1)
    with np.errstate(divide="ignore"):
        far = -np.dot(side, place) / (way @ np.asarray(side))
    return ((far > 0) & (far < radius) & (far * way[..., 2] < high)).mean()


def test_a_low_wall_of_light(run):
    """C2 times a sky, and its complement times the wall's light."""
    high, bright, above = 0.4, 3.0, 0.7
    for d in (0.05, 0.2, 1.0):  # rays through half a sphere give (1 - d / sqrt(d^2 + h^2)) / 2
        assert abs(hidden((d, 0.0, 0.0), (1.0, 0.0, 0.0), high, 1e9) - 0.5 * (1.0 - d / np.hypot(d, high))) < 2e-3
    scene, place, ground, stands = wall_and_floor(high)
    image = np.zeros((*ground.shape, 4), np.float32)
    image[stands] = (bright, 0.5 * bright, 0.0, 1.0)
    values = {"image": image, "radius": 0.8, "quality": "reference", "denoise": False}
    dark, lit = light(run, scene, **values), light(run, scene, environment=even(*[above] * 3), **values)
    for d in (0.1, 0.2, 0.4, 0.6):
        near = ground & (np.abs(place[..., 0] - d) < 0.02) & (np.abs(place[..., 1]) < 0.15)
        blocked = hidden((place[near][:, 0].mean(), 0.0, 0.0), (1.0, 0.0, 0.0), high, 0.8)
        assert near.sum() > 10
        assert abs(dark[near][:, 0].mean() / bright - blocked) < 0.02
        np.testing.assert_allclose(dark[near][:, 1], 0.5 * dark[near][:, 0], rtol=1e-5)
        assert abs(lit[near][:, 2].mean() / above - (1.0 - blocked)) < 0.02


@pytest.mark.parametrize("degrees", [60.0, 100.0, 130.0])
def test_wedges_under_a_sky(run, degrees):
    """C4: at the edge of a wedge (1 - cos) / 2 of the sky is left; the other side gives its light for the rest."""
    width, height = SMALL
    slope = np.array([np.sin(np.radians(degrees)), 0.0, -np.cos(np.radians(degrees))])
    assert abs(hidden((1e-6, 0.0, 0.0), slope, np.inf, 1e9) - (1.0 + np.cos(np.radians(degrees))) / 2.0) < 2e-3
    eye = np.array([4.0, 0.0, 2.5]) if degrees < 120 else np.array([2.0, 0.0, 4.0])
    camera = look_at(tuple(eye), (0.3, 0.0, 0.1), (2.0, 2.0 * width / height))
    y, x = np.mgrid[0:height, 0:width]
    rays = np.stack([(x + 0.5) / width, (y + 0.5) / height, np.ones(x.shape)], -1)
    rays = rays @ np.reshape(camera.inverse, (3, 4))[:, :3].T
    floor, side = -eye[2] / rays[..., 2], -(eye @ slope) / (rays @ slope)
    floor, side = (np.where(one > 0, one, np.inf) for one in (floor, side))
    depth, ground = np.minimum(floor, side), floor < side
    normal = np.where(ground[..., None], [0.0, 0.0, 1.0], slope)
    place = eye + depth[..., None] * rays
    image = np.where(ground[..., None], 0.0, np.array([2.0, 1.0, 0.5, 1.0]))
    found = light(
        run, (camera, depth, normal), image=image, environment=even(0.0, 0.0, 0.8), quality="reference", denoise=False
    )
    for low, high in ((0.01, 0.05), (0.05, 0.1), (0.2, 0.25)):
        near = ground & (place[..., 0] > low) & (place[..., 0] < high) & (np.abs(place[..., 1]) < 0.4)
        blocked = hidden((place[near][:, 0].mean(), 0.0, 0.0), slope, np.inf, 0.5)
        assert near.sum() > 25
        assert abs(found[near][:, 0].mean() / 2.0 - blocked) < 0.02
        assert abs(found[near][:, 2].mean() - (0.8 * (1.0 - blocked) + 0.5 * blocked)) < 0.02


def test_cycles_bounces_light_once_off_colored_walls(run):
    """Three sides of a box in the sun, all of which the picture shows: what it hands on, in red, green and white."""
    data = blender("occlusion")
    camera, depth = CameraModel(tuple(data["bounced_rows"].ravel())), data["bounced_depth"]
    image = np.dstack([data["bounced_image"], np.ones(depth.shape)])
    scene, expected = (camera, depth, data["bounced_normal"]), data["bounced_light"].astype(float)
    inside = binary_erosion(depth < 1e9, iterations=2)
    found = light(run, scene, image=image, radius=2.4, quality="reference", denoise=False)[..., :3]
    error = (found - expected)[inside]
    assert expected[inside].max() > 0.5
    assert np.abs(error.mean(0)).max() < 0.012 and np.sqrt((error**2).mean(0)).max() < 0.02
    for channel in range(3):
        assert np.corrcoef(found[inside][:, channel], expected[inside][:, channel])[0, 1] > 0.985
    worked = light(run, scene, image=image, radius=2.4)[..., :3][inside] - expected[inside]
    assert np.sqrt((worked**2).mean(0)).max() < 0.03


def test_a_small_lamp_does_not_splatter(run):
    """Beside a lamp of few pixels light falls off smoothly, and none of it is lost."""
    scene = corner()
    _, _, normal, place, inner = scene
    lamp = (normal[..., 0] > 0.5) & (np.hypot(place[..., 1], place[..., 2] - 0.25) < 0.04)
    assert 4 < lamp.sum() < 60
    image = np.where(lamp[..., None], np.float32([200, 200, 200, 1]), np.float32([0, 0, 0, 1]))
    near = inner & (normal[..., 2] > 0.5) & (np.hypot(place[..., 0] - 0.2, place[..., 1]) < 0.15)
    few, many = (light(run, scene, image=image, quality=quality)[..., 0] for quality in ("quality", "reference"))
    rough, error = few - gaussian_filter(few, 3.0), few - many
    assert near.sum() > 50
    assert rough[near].std() < 0.25 * few[near].mean()
    assert np.sqrt((error[near] ** 2).mean()) < 0.22 * many[near].mean()
    assert abs(few[near].mean() / many[near].mean() - 1.0) < 0.15
