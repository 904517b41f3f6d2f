"""Light shafts against the integral of scattered light, in closed form and by numpy, and against shadows cast."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import rays
from halation.nodes import look_at
from halation.nodes.light.light_shafts import LightShafts

SIZE = (64, 36)
CAMERA = look_at((0.0, -5.0, 1.0), (0.0, 0.0, 1.0), (1.1, 1.1 * 16 / 9))
WHITE = {"color": (1.0, 1.0, 1.0, 1.0), "intensity": 1.0}
BLACK = np.zeros((SIZE[1], SIZE[0], 4))


def haze(run, depth, output="shafts", image=BLACK, **values):
    return run(LightShafts(**(WHITE | values)), {"image": image, "depth": depth, "camera": CAMERA}, output=output)


def views():
    way = rays(CAMERA, *SIZE)
    stretch = np.linalg.norm(way, axis=-1)
    return way / stretch[..., None], stretch


def phase(cosine, g):
    return (1 - g * g) / (1 + g * g - 2 * g * cosine) ** 1.5


@pytest.mark.parametrize("forward", [0.0, 0.6, -0.4])
def test_a_free_sun(run, forward):
    """Without anything in the way: phase (1 - exp(-density way)), whatever the number of places."""
    view, stretch = views()
    sun = np.array([-0.3, -0.8, 0.5])
    depth = np.full(SIZE[::-1], 8.0)
    depth[:, :20] = 1e10
    values = {"light": "sun", "direction": tuple(sun), "forward": forward, "distance": 12.0, "density": 0.1}
    end = np.where(depth < 1e9, np.minimum(depth * stretch, 12.0), 12.0)
    expected = phase(view @ sun / np.linalg.norm(sun), forward) * (1 - np.exp(-0.1 * end))
    found = haze(run, depth, quality="preview", **values)
    inner = np.s_[:, 2:-2]  # neighbors are averaged
    clear = np.ones(depth.shape, bool)
    clear[:, 17:23] = False
    np.testing.assert_allclose(found[inner][clear[inner]][:, 0], expected[inner][clear[inner]], rtol=0.02)
    assert np.all(found[..., 3] == 0.0)


def test_a_sun_in_the_picture_is_one_of_the_world(run):
    depth = np.full(SIZE[::-1], 1e10)
    depth[10:20, 25:40] = 6.0
    at = (0.3, 0.2)
    way = np.reshape(CAMERA.inverse, (3, 4))[:, :3] @ (*at, 1.0)
    one = haze(run, depth, light="picture", source=at)
    np.testing.assert_allclose(one, haze(run, depth, light="sun", direction=tuple(way)), atol=2e-3)
    assert one.max() > 2 * one.min()


def blurred(picture):
    """The mean over neighbors, with half of the outermost, that takes the noise away."""
    weight, wide = np.array([0.5, 1, 1, 1, 0.5]) / 4, np.pad(picture, 2, mode="edge")
    return sum(weight[y] * weight[x] * wide[y : y + SIZE[1], x : x + SIZE[0]] for y in range(5) for x in range(5))


def summed(lamp, end, density, g, hidden=None, places=4000):
    """The integral along every way, by the midpoints of equal angles."""
    view, _ = views()
    eye = np.array(CAMERA.eye)
    closest = view @ (lamp - eye)
    side = np.maximum(np.linalg.norm(lamp - eye - closest[..., None] * view, axis=-1), 0.02)
    first, last = np.arctan2(-closest, side), np.arctan2(end - closest, side)
    total = 0.0
    for part in (np.arange(places) + 0.5) / places:
        away = closest + side * np.tan(first + part * (last - first))
        place = eye + away[..., None] * view
        way = lamp - place
        far = np.linalg.norm(way, axis=-1)
        light = np.exp(-density * (away + far)) * phase((way * view).sum(-1) / far, g)
        total = total + light * (1.0 if hidden is None else ~hidden(place, way))
    return density * total / places * (last - first) / side


@pytest.mark.parametrize("forward", [0.0, 0.5])
def test_a_free_lamp(run, forward):
    _, stretch = views()
    lamp, depth = np.array([0.7, -1.0, 1.4]), np.full(SIZE[::-1], 9.0)
    values = {"light": "lamp", "position": tuple(lamp), "density": 0.08, "forward": forward}
    found = haze(run, depth, quality="reference", **values)[..., 0]
    expected = summed(lamp, 9.0 * stretch, 0.08, forward, places=400)
    inner = np.s_[2:-2, 2:-2]
    np.testing.assert_allclose(found[inner], blurred(expected)[inner], rtol=0.03)
    # Without losses, in endless air: (pi / 2 + atan(closest / side)) / side times the density (Sun et al. 2005).
    thin = haze(
        run,
        np.full(SIZE[::-1], 1e10),
        quality="reference",
        **(values | {"density": 1e-5, "forward": 0.0, "distance": 1e6}),
    )[..., 0]
    view, _ = views()
    closest = view @ (lamp - np.array(CAMERA.eye))
    side = np.sqrt(np.sum((lamp - np.array(CAMERA.eye)) ** 2) - closest**2)
    expected = 1e-5 * (np.pi / 2 + np.arctan(closest / side)) / side
    np.testing.assert_allclose(thin[inner], blurred(expected)[inner], rtol=0.03)


def test_a_board_throws_a_shaft(run):
    """A board before a wall, as thick as all behind it: its shadow in the air, place by place in numpy."""
    _, stretch = views()
    depth = np.full(SIZE[::-1], 9.0)
    depth[12:24, 24:34] = 4.0
    lamp = np.array([2.0, 0.5, 1.6])  # beside it, half a unit deeper than it is
    rows = np.reshape(CAMERA.rows, (3, 4))

    def hidden(place, way):
        """True where the way to the lamp passes through what is behind the board."""
        found = np.zeros(place.shape[:2], bool)
        for part in (np.arange(60) + 0.5) / 60:
            seen = (place + part * way) @ rows[:, :3].T + rows[:, 3]
            x, y = (seen[..., axis] / seen[..., 2] * SIZE[axis] for axis in (0, 1))
            found |= (x > 24) & (x < 34) & (y > 12) & (y < 24) & (seen[..., 2] > 4.0)
        return found

    values = {"light": "lamp", "position": tuple(lamp), "density": 0.1, "forward": 0.0, "thickness": 1e6}
    found = haze(run, depth, quality="reference", **values)[..., 0]
    end = depth * stretch
    dark = blurred(summed(lamp, end, 0.1, 0.0, hidden, places=150))
    free = blurred(summed(lamp, end, 0.1, 0.0, places=150))
    edge = np.zeros(depth.shape, bool)
    edge[9:27, 21:37] = True
    edge[15:21, 27:31] = False
    edge[[0, 1, -2, -1]], edge[:, [0, 1, -2, -1]] = True, True
    shaded = (dark < 0.9 * free) & ~edge
    assert shaded.sum() > 100
    error = (found - dark) / free
    assert np.sqrt((error[~edge] ** 2).mean()) < 0.015
    steep = np.maximum(*(np.abs(one) for one in np.gradient(dark / free))) > 0.02
    assert np.abs(error[~edge & ~steep]).max() < 0.03
    assert (1 - dark / free)[~edge].max() > 0.2


def test_a_hidden_sun_lights_nothing_before_it(run):
    """Looking at the sun through a wall."""
    depth = np.full(SIZE[::-1], 4.0)
    assert np.all(haze(run, depth, light="picture", source=(0.5, 0.5), thickness=1e6) == 0.0)


def test_light_is_added(run, hdr):
    image, depth = hdr(*SIZE), np.full(SIZE[::-1], 6.0)
    values = {"color": (0.5, 0.2, 0.1, 0.5), "intensity": 3.0}
    alone = haze(run, depth, image=image, **values)
    out = haze(run, depth, output="out", image=image, **values)
    np.testing.assert_allclose(out[..., :3], image[..., :3] + alone[..., :3], rtol=1e-6)
    np.testing.assert_array_equal(out[..., 3], image[..., 3])
    np.testing.assert_allclose(alone[..., 1] / alone[..., 0], 0.4, rtol=1e-5)
    assert np.all(haze(run, depth, density=0.0) == 0.0)


def test_nothing_is_far_away(run):
    values = {"light": "sun", "direction": (0.0, 0.0, 1.0), "distance": 7.0}
    for empty in (np.inf, 0.0, -1.0, np.nan):
        found = haze(run, np.full(SIZE[::-1], empty), **values)
        np.testing.assert_array_equal(found, haze(run, np.full(SIZE[::-1], 1e10), **values))


def test_contours_are_smooth(run):
    """A ball before a wall, against 8 x 8 samples of each pixel: 0.6 of the error of whole pixels at most."""
    (width, height), samples = SIZE, 8
    y, x = (np.mgrid[: height * samples, : width * samples] + 0.5) / samples
    inside = np.hypot(x - 30.3, y - 17.6) < 16.2
    fine = np.where(inside, 4.0, 9.0)
    values = {"light": "sun", "direction": (0.2, 0.3, 0.9), "density": 0.1, "thickness": 0.0, "quality": "reference"}
    share = inside.reshape(height, samples, width, samples).mean((1, 3))
    near, far = (haze(run, np.full(SIZE[::-1], depth), **values)[..., 0] for depth in (4.0, 9.0))
    expected = share * near + (1.0 - share) * far
    pixels = fine[samples // 2 :: samples, samples // 2 :: samples]
    edge = (share > 0.0) & (share < 1.0)
    found = haze(run, pixels, **values)[..., 0]
    jagged = np.where(pixels < 5.0, near, far)
    error, before = (np.sqrt(((picture - expected)[edge] ** 2).mean()) for picture in (found, jagged))
    assert edge.sum() > 80 and error < 0.6 * before
