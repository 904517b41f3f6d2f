"""Shadows and mattes of single lights, against rays that numpy casts past a box on a floor."""

from __future__ import annotations

import numpy as np
import pytest
from board_scene import measure_errors, take_board
from box_scene import box, dilated, taken
from halation.nodes import Light, LightKind, number_lights
from halation.nodes.light.deferred_lighting import DeferredLighting
from lighting_formulas import Array
from msgspec import structs

SIZE = (96, 54)
PLACE = (-1.2, -0.9, 1.7)
LIGHTS = {
    "point": Light(LightKind.POINT, PLACE),
    "spot": Light(LightKind.SPOT, PLACE, (1.0, 1.0, -1.4), outer=80.0, inner=70.0),
    "sun": Light(LightKind.SUN, direction=(0.6, 0.35, -0.7), angle=0.0),
    "sphere": Light(LightKind.SPHERE, PLACE, size=0.3),
    "rectangle": Light(LightKind.RECTANGLE, PLACE, (0.7, 0.7, -1.0), width=0.8, height=0.3),
    "disc": Light(LightKind.DISC, PLACE, (0.7, 0.7, -1.0), size=0.35),
    "tube": Light(LightKind.TUBE, PLACE, (1.0, -0.8, 0.0), length=0.8, size=0.02),
}


def render(run, lights: tuple[Light, ...], given: dict[str, Array], **values: object) -> Array:
    node = DeferredLighting(
        lights=number_lights(lights),
        ambient_intensity=0.0,
        **({"shadow_length": 1e3, "shadow_thickness": 1e4} | values),
    )
    return run(node, given, output="diffuse")[..., 0]


@pytest.fixture(scope="module")
def stage() -> dict[str, Array]:
    camera, depth, normal, _ = taken(size=SIZE)
    return {"camera": camera, "depth": depth, "normal": normal}


def hidden(light: Light, place: Array) -> Array:
    """The part of a light that the box hides, by 12 x 12 rays."""
    at = (np.arange(12) + 0.5) / 12.0
    along, across = (np.array(axis) for axis in light.half_axes)
    targets = []
    for u in at:
        for v in at:
            part = np.sqrt(u) * np.array([np.cos(2 * np.pi * v), np.sin(2 * np.pi * v)])
            if light.kind is LightKind.DISC:
                targets.append(np.array(light.place) + part[0] * along + part[1] * across)
            elif light.kind is LightKind.SPHERE:
                back = np.array(light.place) - place
                back = back / np.linalg.norm(back, axis=-1, keepdims=True)
                side = np.cross(back, (0.0, 0.0, 1.0))
                side = side / np.linalg.norm(side, axis=-1, keepdims=True)
                offset = part[0] * side + part[1] * np.cross(back, side)
                targets.append(np.array(light.place) + light.size * offset)
            elif light.kind in (LightKind.RECTANGLE, LightKind.TUBE):
                targets.append(np.array(light.place) + (2 * u - 1) * along + (2 * v - 1) * across)
            else:
                targets.append(np.array(light.place))
    met = []
    for target in targets:
        way = target - place if light.kind is not LightKind.SUN else np.broadcast_to(-np.array(light.aim), place.shape)
        enter, leave = box(place, way)
        met.append(np.isfinite(enter) & (leave > 1e-3) & ((light.kind is LightKind.SUN) | (enter < 1.0)))
    return np.mean(met, axis=0)


@pytest.mark.parametrize("name", LIGHTS)
def test_a_light_casts_the_shadow_that_rays_find(run, stage, name):
    light = LIGHTS[name]
    _, _, normal, place = taken(size=SIZE)
    lit = render(run, (light,), stage)
    shaded = render(run, (structs.replace(light, shadow=True),), stage)
    floor = (normal[..., 2] > 0.5) & (place[..., 2] < 1e-6) & (lit > 1e-6)
    expected = hidden(light, place + 1e-4 * normal)
    found = 1.0 - shaded / np.where(lit > 1e-6, lit, 1.0)
    clear = floor & ~dilated(~floor, 2)
    assert (clear & (expected > 0.95)).sum() > 30 and (clear & (expected == 0.0)).sum() > 300
    border = dilated((expected > 0.0) & (expected < 1.0), 4) | (dilated(expected > 0.5) & dilated(expected < 0.5))
    assert np.abs(found - expected)[clear & ~border & (expected == 0.0)].max() < 0.01  # the rim of a light
    assert np.abs(found - expected)[clear].mean() < 0.02
    if name in ("rectangle", "disc", "sphere"):
        half = clear & (expected > 0.3) & (expected < 0.7)
        assert half.sum() > 20 and np.abs(found - expected)[half].mean() < 0.15


def test_each_of_many_lights_has_its_own_shadow(run, stage):
    lights = tuple(structs.replace(light, shadow=number % 3 > 0) for number, light in enumerate(LIGHTS.values()))
    together = render(run, lights, stage)
    alone = sum(render(run, (light,), stage) for light in lights)
    np.testing.assert_allclose(together, alone, atol=2e-5 * alone.max())


def test_places_in_the_world_give_the_same_shadows_as_depth(run, stage):
    _, depth, _, place = taken(size=SIZE)
    lights = (structs.replace(LIGHTS["point"], shadow=True),)
    given = {name: pixels for name, pixels in stage.items() if name != "depth"}
    found = render(run, lights, given | {"position": np.where(depth[..., None] < 1e9, place, 1e10)})
    expected = render(run, lights, stage)
    differs = np.abs(found - expected) > 1e-3 * expected.max()
    assert expected.max() > 0.0 and differs.mean() < 0.02


def test_mattes_choose_what_a_light_lights(run, stage):
    light, random = LIGHTS["point"], np.random.default_rng(1)
    mattes = {f"matte_{number}": random.random(SIZE[::-1]).astype(np.float32) for number in (1, 2, 3, 4)}
    lit = render(run, (light,), stage)
    for number in (1, 2, 3, 4):
        matte = mattes[f"matte_{number}"]
        inside = render(run, (structs.replace(light, matte=number),), stage | mattes)
        outside = render(run, (structs.replace(light, matte=-number),), stage | mattes)
        np.testing.assert_allclose(inside, lit * matte, atol=1e-5 * lit.max())
        np.testing.assert_allclose(inside + outside, lit, atol=1e-5 * lit.max())


def test_without_a_camera_nothing_casts_shadows(run, stage):
    given = {"normal": stage["normal"], "position": taken(size=SIZE)[3]}
    shaded = render(run, (structs.replace(LIGHTS["sphere"], shadow=True),), given)
    np.testing.assert_allclose(shaded, render(run, (LIGHTS["sphere"],), given), rtol=1e-5)


@pytest.mark.parametrize("turn", [0, 45, 90, 135, 200])
@pytest.mark.parametrize("kind", [LightKind.SUN, LightKind.SPHERE, LightKind.DISC])
def test_a_penumbra_is_as_wide_whichever_way_its_edge_runs(run, kind, turn):
    """A round light right above the edge of a board."""
    above, radius, board = np.array([0.0, 0.0, 3.0]), 1.2, take_board(turn)
    light = Light(kind, tuple(above), (0.0, 0.0, -1.0), size=radius, angle=60.0)
    given = {"camera": board.camera, "depth": board.depth, "normal": board.normal}
    lit, shaded = (render(run, (structs.replace(light, shadow=on),), given) for on in (False, True))
    off = board.place @ board.toward
    if kind is LightKind.SUN:
        chord = off / np.tan(np.radians(30.0))
    else:
        # A point of the light is seen if it lies beyond the plane through the place and the edge of the board.
        across = board.toward + off[..., None] * np.array([0.0, 0.0, 1.0])
        facing = above - board.place if kind is LightKind.SPHERE else np.broadcast_to(above, board.place.shape)
        facing = facing / np.linalg.norm(facing, axis=-1, keepdims=True)
        across -= (across * facing).sum(-1, keepdims=True) * facing
        chord = 2.0 * off / (radius * np.linalg.norm(across, axis=-1))
    error = measure_errors(board, shaded / lit, chord)
    assert abs(error.mean()) < 0.02 and np.sqrt((error**2).mean()) < 0.03
