"""Light from all sides against sums over all directions in numpy."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import look_at
from halation.nodes.light.image_based_light import ImageBasedLight

CAMERA = look_at((0.0, -4.0, 1.0), (0.0, 0.0, 0.0), (1.2, 1.2))


def directions(width, height):
    """Of every pixel of a lat-long picture, z up, and its solid angle."""
    v, u = np.meshgrid((np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij")
    around, below = (0.5 - u) * 2 * np.pi, v * np.pi
    way = np.stack([np.sin(below) * np.cos(around), np.sin(below) * np.sin(around), np.cos(below)], -1)
    edges = np.cos(np.linspace(0, np.pi, height + 1))
    return way, np.broadcast_to((edges[:-1] - edges[1:])[:, None] * 2 * np.pi / width, (height, width))


def soft(way):
    return np.stack([1 + way[..., 0], (1 + way[..., 1]) ** 2, np.exp(2 * way[..., 2])], -1)


def sun(way):
    """A sky with a small sun, 2000 times as bright."""
    beam = (way @ np.array([0.48, 0.6, 0.64]) > np.cos(0.04)) * 2000.0
    return (0.5 + 0.4 * way[..., 2] + beam)[..., None] * np.array([1.0, 0.9, 0.7])


def picture(function, width=256, height=128, y_up=False):
    way, _ = directions(width, height)
    if y_up:
        way = way[..., [1, 2, 0]]
    return np.concatenate([function(way), np.ones((height, width, 1))], -1).astype(np.float32)


def normals(height=12, width=16):
    """Normals that face anywhere."""
    found = np.random.default_rng(5).normal(size=(height, width, 3))
    found /= np.linalg.norm(found, axis=-1, keepdims=True)
    found[0, :4] = [[0, 0, 1], [0, 0, -1], [-1, 0, 0], [0, -1, 0]]
    return found


def render(run, normal, output, **given):
    names = ("environment", "albedo", "roughness", "metallic", "occlusion")
    arrays = {name: np.asarray(given.pop(name)) for name in names if name in given}
    return run(ImageBasedLight(**given), {"normal": normal, "camera": CAMERA} | arrays, output=output)


def gray(value, shape=(12, 16)):
    return np.broadcast_to(np.float32([value, value, value, 1.0]), (*shape, 4))


def matte(function, normal, turn=0.0):
    """To turn the surroundings one way is to turn the surface the other way."""
    way, angle = directions(256, 128)
    c, s = np.cos(turn), np.sin(turn)
    x, y, z = np.moveaxis(normal, -1, 0)
    turned = np.stack([c * x + s * y, -s * x + c * y, z], -1)
    facing = np.maximum(way.reshape(-1, 3) @ turned.reshape(-1, 3).T, 0) * angle.reshape(-1, 1) / np.pi
    return (facing.T @ function(way).reshape(-1, 3)).reshape(normal.shape)


@pytest.mark.parametrize(("function", "most"), [(soft, 0.01), (sun, 0.02)], ids=["soft", "sun"])
@pytest.mark.parametrize("turn", [0.0, 70.0])
def test_matte_light_is_the_cosine_sum(run, function, most, turn):
    normal = normals()
    found = render(run, normal, "diffuse", environment=picture(function), albedo=gray(1.0), rotation=turn)[..., :3]
    expected = matte(function, normal, np.radians(turn))
    assert np.abs(found - expected).max() < most * expected.max()
    assert np.sqrt(((found - expected) ** 2).mean()) < 0.005 * expected.max()


def test_with_y_up(run):
    normal = normals()
    found = render(run, normal, "diffuse", environment=picture(soft, y_up=True), albedo=gray(1.0), up="y")[..., :3]
    expected = matte(soft, normal)
    assert np.abs(found - expected).max() < 0.02 * expected.max()


def test_an_even_sky(run):
    normal = normals()
    values = {"albedo": gray(0.6), "occlusion": np.full((12, 16), 0.5), "intensity": 3.0}
    np.testing.assert_allclose(render(run, normal, "diffuse", **values)[..., :3], 0.9, rtol=1e-5)


def rays(normal):
    height, width = normal.shape[:2]
    y, x = np.mgrid[0:height, 0:width]
    seen = np.stack([(x + 0.5) / width, (y + 0.5) / height, np.ones(x.shape)], -1)
    ray = seen @ np.reshape(CAMERA.inverse, (3, 4))[:, :3].T
    return ray / np.linalg.norm(ray, axis=-1, keepdims=True)


@pytest.mark.parametrize(
    ("roughness", "most"),
    [(0.0, 0.01), (0.12, 0.01), (0.2, 0.01), (0.25, 0.01), (0.5, 0.01), (0.75, 0.02), (1.0, 0.02)],
)
def test_reflections_are_the_sky_by_the_lobe(run, roughness, most):
    """White metal, divided by what it mirrors of an even sky: the mean by GGX around the mirrored view."""
    normal = normals()
    given = {"albedo": gray(1.0), "metallic": np.ones((12, 16)), "roughness": np.full((12, 16), roughness)}
    white = render(run, normal, "reflection", **given)[..., :3]
    found = render(run, normal, "reflection", environment=picture(soft, 512, 256), **given)[..., :3] / white
    ray = rays(normal)
    mirrored = (ray - 2 * (ray * normal).sum(-1, keepdims=True) * normal).reshape(-1, 3)
    if roughness == 0.0:
        expected = soft(mirrored)
    else:
        way, angle = directions(256, 128)
        lit = np.clip(way.reshape(-1, 3) @ mirrored.T, 0, 1)
        square, alpha2 = (1 + lit) / 2, roughness**4  # (n.h)^2, where n is the mirrored way itself
        lobe = lit * angle.reshape(-1, 1) / (square * (alpha2 - 1) + 1) ** 2
        expected = (lobe.T @ soft(way).reshape(-1, 3)) / lobe.sum(0)[:, None]
    error = found.reshape(-1, 3) - expected
    assert np.abs(error).max() < 2 * most * expected.max() and np.sqrt((error**2).mean()) < most * expected.max()


def furnace(alpha, facing):
    """What facets mirror once of an even sky of 1: their formula, summed over all of them as often as they are."""
    part, turn = np.meshgrid((np.arange(3000) + 0.5) / 3000, (np.arange(200) + 0.5) * np.pi / 200)
    slope = alpha * np.sqrt(part / (1.0 - part))
    facet = np.stack([slope * np.cos(turn), slope * np.sin(turn), np.ones_like(part)], -1)
    facet /= np.linalg.norm(facet, axis=-1, keepdims=True)
    seen = facet @ np.array([np.sqrt(1.0 - facing**2), 0.0, facing])
    lit = 2.0 * seen * facet[..., 2] - facing
    far = lambda cosine: np.sqrt(cosine**2 * (1.0 - alpha**2) + alpha**2)  # noqa: E731
    both = np.maximum(lit, 1e-12)
    passed = 2.0 * facing * both / (facing * far(both) + both * far(facing))
    return np.where((seen > 0) & (lit > 0), passed * seen / (facing * facet[..., 2]), 0.0).mean()


@pytest.mark.parametrize(
    ("alpha", "shares"),
    [
        (0.02, {}),
        (0.1, {1.0: 0.9881, 0.3: 0.9369}),
        (0.25, {1.0: 0.9159, 0.3: 0.8389}),
        (0.5, {1.0: 0.6880, 0.3: 0.7464}),
        (1.0, {1.0: 0.3069, 0.3: 0.5614}),
    ],
)
def test_the_white_furnace(run, alpha, shares):
    """At any angle to the eye; `shares` are by Monte Carlo, to 0.001."""
    ray = rays(np.zeros((1, 1, 3)))[0, 0]
    side = np.cross(ray, (0.0, 0.0, 1.0))
    side /= np.linalg.norm(side)
    cosines = np.array([1.0, 0.7, 0.3, 0.1])
    for facing in cosines:
        normal = np.reshape(-facing * ray + np.sqrt(1 - facing**2) * side, (1, 1, 3))
        given = {"albedo": gray(1.0, (1, 1)), "metallic": np.ones((1, 1)), "roughness": np.full((1, 1), alpha**0.5)}
        found = render(run, normal, "reflection", **given)[0, 0, 0]
        assert abs(found - furnace(alpha, facing)) < 0.0015
        assert abs(found - shares.get(facing, found)) < 0.002


def test_parts_add_up_and_nothing_stays_nothing(run):
    normal = normals()
    normal[3:5] = 0.0
    environment = picture(soft)
    parts = [render(run, normal, output, environment=environment) for output in ("diffuse", "reflection", "out")]
    np.testing.assert_allclose(parts[2][..., :3], parts[0][..., :3] + parts[1][..., :3], rtol=1e-5)
    assert not parts[2][3:5].any() and np.all(parts[2][5:, :, 3] == 1.0)
    mirror = render(run, normal, "reflection", environment=environment, specular=0.0, roughness=np.ones((12, 16)))
    assert mirror[5:, :, :3].mean() < parts[1][5:, :, :3].mean()


def test_a_small_sun_leaves_no_dots(run):
    """The lobe of a rough surface around a sun falls off evenly: no sample of it stands out."""
    environment = picture(sun, 1024, 512)
    turn = np.linspace(-1.2, 1.2, 200)
    toward, side = np.array([0.48, 0.6, 0.64]), np.array([0.78086881, -0.62469505, 0.0])
    mirrored = np.cos(turn)[:, None] * toward + np.sin(turn)[:, None] * side
    ray = rays(np.zeros((1, 200, 3)))[0]
    half = mirrored - ray
    normal = (half / np.linalg.norm(half, axis=-1, keepdims=True))[None]
    for roughness in (0.25, 0.5, 0.75):
        given = {"albedo": gray(1.0, (1, 200)), "metallic": np.ones((1, 200))}
        given["roughness"] = np.full((1, 200), roughness)
        white = render(run, normal, "reflection", **given)[0, :, 0]
        found = render(run, normal, "reflection", environment=environment, **given)[0, :, 0] / white
        fall = np.diff(np.log(found[100:]))
        assert found.argmax() in range(85, 116)
        assert fall.max() < 0.12, roughness
