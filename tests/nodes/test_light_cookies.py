"""Cookies of lights, against projections that numpy writes out and pictures that scipy reads between pixels."""

from __future__ import annotations

import numpy as np
import pytest
from box_scene import taken
from halation.nodes import Light, LightKind, number_lights
from halation.nodes.light.deferred_lighting import DeferredLighting
from lighting_formulas import Array
from msgspec import structs
from scipy.ndimage import gaussian_filter, map_coordinates
from scipy.spatial.transform import Rotation

SIZE = (96, 54)
PLACE = (-1.2, -0.9, 1.7)
AIM = np.array([1.0, 1.0, -1.4]) / np.linalg.norm([1.0, 1.0, -1.4])
UP = np.array([0.0, 0.0, 1.0])
SPOT = Light(LightKind.SPOT, PLACE, tuple(AIM), outer=40.0, inner=40.0)
SUN = Light(LightKind.SUN, direction=(0.6, 0.35, -0.7), angle=0.0)


@pytest.fixture(scope="module")
def stage() -> dict[str, Array]:
    camera, depth, normal, _ = taken(size=SIZE)
    return {"camera": camera, "depth": depth, "normal": normal}


def slide(width: int, height: int, *, mode: str = "nearest") -> Array:
    """A smooth picture, bright enough that ratios can be taken."""
    noise = np.random.default_rng(7).random((height, width, 3))
    smooth = gaussian_filter(noise, (6.0, 6.0, 0.0), mode="wrap" if mode == "wrap" else "nearest")
    smooth = (smooth - smooth.min()) / np.ptp(smooth)
    return np.concatenate([smooth, np.ones((height, width, 1))], axis=-1).astype(np.float32)


def render(run, light: Light, given: dict[str, Array]) -> Array:
    node = DeferredLighting(lights=number_lights((light,)), ambient_intensity=0.0, roughness=1.0)
    return run(node, given, output="diffuse")[..., :3]


def share(run, light: Light, stage: dict[str, Array], **cookies: Array) -> tuple[Array, Array]:
    """What the cookie lets through, and where the light is bright enough to tell."""
    plain = render(run, structs.replace(light, cookie=0), stage)
    thrown = render(run, light, stage | cookies)
    bright = plain.min(axis=-1) > 1e-3 * plain.max()
    return thrown / np.maximum(plain, 1e-12), bright


def between(picture: Array, uv: Array, mode: str) -> Array:
    """A picture between its pixels; `uv` are fractions from the top left."""
    at = uv * np.array(picture.shape[1::-1]) - 0.5
    return np.stack(
        [
            map_coordinates(picture[..., c].astype(np.float64), (at[..., 1], at[..., 0]), order=1, mode=mode)
            for c in range(3)
        ],
        axis=-1,
    )


def seen_from(light: Light, place: Array, roll: float = 0.0) -> Array:
    """Places in the axes of an eye that looks along with the light: to the right, up, ahead."""
    aim = np.array(light.aim)
    right = np.cross(aim, UP)
    right /= np.linalg.norm(right)
    up = np.cross(right, aim)
    turned = Rotation.from_rotvec(roll * aim).apply(np.stack([right, up]))
    origin = np.zeros(3) if light.kind is LightKind.SUN else np.array(light.place)
    return (place - origin) @ np.stack([*turned, aim]).T


@pytest.mark.parametrize("size", [(256, 256), (320, 180), (150, 280)])
@pytest.mark.parametrize("roll", [0.0, 37.0])
def test_a_spot_throws_it_as_a_projector_does(run, stage, size, roll):
    """Upright and not mirrored for who looks along; its shorter side fills the cone."""
    picture, place = slide(*size), taken(size=SIZE)[3]
    found, bright = share(run, structs.replace(SPOT, cookie=1, roll=roll), stage, cookie_1=picture)
    right, up, ahead = np.moveaxis(seen_from(SPOT, place, np.radians(roll)), -1, 0)
    fill = np.tan(np.radians(40.0)) * np.maximum(np.array(size) / min(size), 1.0)
    uv = np.stack([0.5 + 0.5 * right / ahead / fill[0], 0.5 - 0.5 * up / ahead / fill[1]], axis=-1)
    assert bright.sum() > 800
    wanted = between(picture, uv, "nearest")
    off = np.abs(found - wanted)[bright]
    assert off.mean() < 2e-3 and np.percentile(off, 99) < 1e-2  # the rest are pixels of two surfaces


def test_a_sun_repeats_it(run, stage):
    picture, place = slide(128, 64, mode="wrap"), taken(size=SIZE)[3]
    found, bright = share(run, structs.replace(SUN, cookie=3, cookie_width=1.7), stage, cookie_3=picture)
    right, up, _ = np.moveaxis(seen_from(SUN, place), -1, 0)
    uv = np.stack([0.5 + right / 1.7, 0.5 - up / (1.7 / 2.0)], axis=-1)
    near = bright & (taken(size=SIZE)[1] < 6.0)
    assert near.sum() > 500 and (np.ptp(np.floor(uv[near]), axis=0) >= 1.0).all()
    assert np.abs(found - between(picture, uv, "grid-wrap"))[near].mean() < 1e-2


@pytest.mark.parametrize("kind", [LightKind.POINT, LightKind.SPHERE])
def test_a_ball_throws_it_all_around(run, stage, kind):
    picture, place = slide(256, 128, mode="wrap"), taken(size=SIZE)[3]
    found, bright = share(run, Light(kind, PLACE, cookie=4), stage, cookie_4=picture)
    way = place - np.array(PLACE)
    longitude, below = np.arctan2(way[..., 1], way[..., 0]), np.arccos(way[..., 2] / np.linalg.norm(way, axis=-1))
    uv = np.stack([(0.5 - longitude / (2.0 * np.pi)) % 1.0, below / np.pi], axis=-1)
    inner = bright & (np.abs(uv[..., 1] - 0.5) < 0.45)
    assert inner.sum() > 800
    assert np.abs(found - between(picture, uv, "grid-wrap"))[inner].mean() < 5e-3


def test_a_fine_pattern_far_away_becomes_its_mean(run, stage):
    """No moiré where a pixel shows many of its squares."""
    squares = np.indices((512, 512)).sum(axis=0) % 2
    picture = np.repeat(squares[..., None], 4, axis=-1).astype(np.float32)
    found, bright = share(run, structs.replace(SPOT, cookie=2), stage, cookie_2=picture)
    assert np.abs(found[bright] - 0.5).mean() < 0.03 and found[bright].std() < 0.06


def test_beyond_the_picture_of_a_spot_is_darkness(run, stage):
    """The corners of a cone wider than 180 degrees, which no flat picture covers, stay finite too."""
    wide = Light(LightKind.SPOT, (-1.2, 0.5, 1.7), (0.0, 1.0, 0.0), outer=120.0, inner=110.0, cookie=1)
    lit = render(run, wide, stage | {"cookie_1": slide(64, 64)})
    behind = seen_from(wide, taken(size=SIZE)[3])[..., 2] <= 0.0
    assert np.isfinite(lit).all() and (lit[behind] == 0.0).all() and behind.any() and (lit[~behind] > 0.0).any()


def test_an_input_without_a_link_lets_all_through(run, stage):
    found, bright = share(run, structs.replace(SPOT, cookie=2), stage)
    np.testing.assert_allclose(found[bright], 1.0, atol=1e-5)


def test_cookies_of_several_lights_add_up(run, stage):
    first, second = structs.replace(SPOT, cookie=1), structs.replace(SUN, cookie=2, cookie_width=2.0, matte=-1)
    pictures = {"cookie_1": slide(64, 48), "cookie_2": slide(48, 64), "matte_1": np.zeros(SIZE[::-1], np.float32)}
    alone = sum(render(run, light, stage | pictures) for light in (first, second))
    node = DeferredLighting(lights=number_lights((first, second)), ambient_intensity=0.0, roughness=1.0)
    together = run(node, stage | pictures, output="diffuse")[..., :3]
    np.testing.assert_allclose(together, alone, atol=2e-5 * alone.max())
