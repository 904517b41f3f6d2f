"""Deferred lighting against sums in float64 of the published formulas, closed forms, and integrals over the lights."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from geometry import CAMERA, ball
from halation.nodes import Light, LightKind, lights_of, look_at, number_lights
from halation.nodes.light import _light_tables as module
from halation.nodes.light.deferred_lighting import DeferredLighting
from lighting_formulas import FURNACE, POINT, SPHERE, SPOT, SUN, Array, lit, reflected
from msgspec import structs

SIZE = (23, 19)
LIGHTS = {
    "point": Light(POINT, (1.5, -2.0, 3.0), color=(1.0, 0.6, 0.3), intensity=20.0),
    "reach": Light(POINT, (1.0, -0.5, 2.5), color=(0.3, 0.6, 1.0), intensity=20.0, reach=2.6),
    "spot": Light(SPOT, (2.5, -3.5, 2.0), (-0.5, 1.0, -0.3), (0.4, 1.0, 0.6), 30.0, inner=8.0, outer=16.0),
    "wide spot": Light(SPOT, (0.0, -1.0, 2.6), (0.1, 0.5, -1.0), intensity=9.0, reach=4.0, inner=50.0, outer=75.0),
    "sun": Light(SUN, (9.0, 9.0, 9.0), (-1.0, 2.0, -1.5), (1.0, 0.9, 0.7), 3.0),
    "sphere": Light(SPHERE, (2.0, -1.5, 3.0), color=(1.0, 0.5, 0.7), intensity=15.0, size=0.9),
    "small sphere": Light(SPHERE, (-1.0, -1.0, 1.0), intensity=8.0, size=0.02, reach=6.0),
    "negative": Light(POINT, (-0.5, -1.5, 2.2), color=(0.9, 0.8, 0.1), intensity=-6.0, reach=5.0),
}


def scene(width: int, height: int, seed: int = 1) -> dict[str, Array]:
    """A ball before nothing, of many materials."""
    random = np.random.default_rng(seed)
    found = ball(CAMERA, (0.4, 0.3, 1.1), 1.4, width, height)
    alpha = random.uniform(0.2, 1.0, (height, width, 1))
    found["albedo"] = np.dstack([random.uniform(0.05, 1.0, (height, width, 3)) * alpha, alpha])
    found["material"] = random.uniform([0.0, 0.3], 1.0, (height, width, 2))
    found["emission"] = random.gamma(0.5, 1.0, (height, width, 4))
    found["occlusion"] = random.uniform(0.0, 1.0, (height, width))
    return {name: array.astype(np.float32) for name, array in found.items()}


@pytest.fixture
def render(renderer, run):
    """All outputs, lit by these lights alone."""

    def made(inputs, lights, camera=True, **values):
        node = DeferredLighting(**{"lights": number_lights(tuple(lights)), "ambient_intensity": 0.0} | values)
        given = inputs | ({"camera": CAMERA} if camera else {})
        return {name: run(node, given, output=name).astype(np.float64) for name in DeferredLighting.outputs}

    return made


GBUFFER = ("albedo", "normal", "position", "material")


def gbuffer(inputs: dict[str, Array]) -> dict[str, Array]:
    return {name: inputs[name] for name in GBUFFER}


@pytest.mark.parametrize("model", ["ggx", "phong"])
@pytest.mark.parametrize("name", LIGHTS)
def test_every_light_is_the_formula_in_float64(render, name, model):
    inputs, lights = scene(*SIZE), (LIGHTS[name],)
    found, wanted = render(gbuffer(inputs), lights, model=model), lit(inputs, lights, model)
    for part, expected in wanted.items():
        assert np.abs(expected).max() > 1e-3
        assert np.abs(found[part][..., :3] - expected).max() < 1e-5 * np.abs(expected).max(), part


def test_lights_emission_and_alpha_add_up(render):
    inputs, lights = scene(*SIZE), tuple(LIGHTS.values())
    found = render(gbuffer(inputs) | {"emission": inputs["emission"]}, lights, intensity=0.7)
    wanted = lit(inputs, lights)
    total = 0.7 * (wanted["diffuse"] + wanted["specular_light"]) + inputs["emission"][..., :3]
    assert np.abs(found["out"][..., :3] - total).max() < 1e-5 * total.max()
    assert (found["out"][..., 3] == inputs["albedo"][..., 3]).all()


@pytest.mark.parametrize("model", ["ggx", "phong"])
def test_a_light_and_its_negative_cancel_out(render, model):
    inputs, lights = scene(*SIZE), tuple(LIGHTS.values())
    against = tuple(structs.replace(light, intensity=-light.intensity) for light in lights)
    once, twice = (render(gbuffer(inputs), many, model=model)["out"] for many in (lights, against))
    both = render(gbuffer(inputs), (*lights, *against), model=model)["out"]
    scale = np.abs(once[..., :3]).max()
    assert np.abs(once + twice)[..., :3].max() == 0.0
    assert np.abs(both[..., :3]).max() < 1e-6 * scale


def strewn(count: int, seed: int) -> tuple[Light, ...]:
    """Lights of all kinds around the ball, most with a reach, some without, some negative, some far off."""
    random = np.random.default_rng(seed)
    reaches, often = (0.0, 0.4, 1.0, 2.0), (0.05, 0.35, 0.4, 0.2)
    kinds = random.choice([POINT, SPOT, SUN, SPHERE], count, p=[0.5, 0.3, 0.02, 0.18])
    return tuple(
        Light(
            LightKind(str(kind)),
            tuple(random.normal((0.4, 0.3, 1.1), 1.6)),
            tuple(random.normal(size=3)),
            tuple(random.uniform(0, 1, 3)),
            random.normal(2.0, 2.0),
            random.choice(reaches, p=often),
            random.uniform(0, 10),
            random.uniform(11, 120),
            random.uniform(0.05, 0.5),
            on=bool(random.random() < 0.95),
        )
        for kind in kinds
    )


@pytest.mark.parametrize(("count", "size"), [(3, (37, 21)), (25, (50, 33)), (97, (64, 48)), (1024, (33, 17))], ids=str)
def test_tiles_give_the_same_bits_as_asking_every_light(run, monkeypatch, count, size):
    inputs, lights = scene(*size), strewn(count, count)
    node, found = DeferredLighting(lights=number_lights(lights)), []
    for few in (0, 10**6):
        monkeypatch.setattr(module, "FEW", few)
        found.append(run(node, gbuffer(inputs) | {"camera": CAMERA}))
    assert found[0].tobytes() == found[1].tobytes() and found[0].std() > 0.0


def test_tiles_leave_lights_out(renderer, monkeypatch):
    """Spots and points are far fewer per tile than there are, and every light that lights a pixel is among them."""
    inputs, lights = scene(64, 48), [light for light in strewn(200, 5) if light.on]
    place, there = inputs["position"], inputs["depth"] < 1e9
    kept = lit_by = 0
    for light in lights:
        in_radians = structs.replace(light, inner=np.radians(light.inner), outer=np.radians(light.outer))
        ball_at = module._ball(in_radians)
        middle, radius = np.array(ball_at[:3]), ball_at[3]
        fallen, _ = reflected(
            light,
            "ggx",
            place[there].astype(float),
            inputs["normal"][there].astype(float),
            inputs["normal"][there].astype(float),
            np.array([0.04]),
            np.array([0.5]),
        )
        within = np.linalg.norm(place[there] - middle, axis=1) <= radius
        assert within[np.abs(fallen).max(1) > 0.0].all()
        kept, lit_by = kept + within.sum(), lit_by + len(within)
    assert kept < 0.25 * lit_by


def test_lambert_is_i_cos_over_d_squared(render):
    """A lamp over a white floor: radiance = I cos / (pi d^2)."""
    width, height = SIZE
    x, y = np.meshgrid(np.linspace(-3, 3, width), np.linspace(-3, 3, height))
    flat = np.dstack([x, y, np.full_like(x, 1e-6)])
    inputs = {"position": flat, "normal": np.dstack([0 * x, 0 * x, 1 + 0 * x]), "albedo": np.ones((height, width, 4))}
    found = render(inputs, (Light(place=(0.5, -0.2, 1.5), intensity=7.0),), camera=False)["diffuse"]
    square = (x - 0.5) ** 2 + (y + 0.2) ** 2 + 1.5**2
    wanted = 7.0 / np.pi * 1.5 / square**1.5
    assert np.abs(found[..., 0] / wanted - 1.0).max() < 1e-5


def test_ambient_light_is_albedo_times_occlusion(render, run):
    """Scattered exactly; what is mirrored of a white sky is the directional albedo, to 0.02."""
    inputs = scene(*SIZE)
    sky = {"ambient": (0.5, 1.0, 2.0, 0.5), "ambient_intensity": 0.6}
    found = render(gbuffer(inputs) | {"occlusion": inputs["occlusion"]}, (), **sky)["diffuse"]
    there = inputs["depth"] < 1e9
    scatter = inputs["albedo"][..., :3] * (1.0 - inputs["material"][..., :1]) * inputs["occlusion"][..., None]
    wanted = np.where(there[..., None], scatter * 0.3 * np.array([0.5, 1.0, 2.0]), 0.0)
    assert np.abs(found[..., :3] - wanted).max() < 1e-6
    for alpha, mu, share in FURNACE:
        eye = np.array([np.sqrt(1.0 - mu * mu), 0.0, mu])
        given = {
            "albedo": np.ones((1, 1, 4)),
            "normal": [[[0, 0, 1]]],
            "position": [[[0, 0, 1e-3]]],
            "material": [[[1.0, np.sqrt(alpha)]]],
            "camera": look_at(tuple(1e4 * eye), (0, 0, 0), (1.0, 1.0)),
        }
        white = DeferredLighting(lights=number_lights(()), ambient=(1.0, 1.0, 1.0, 1.0), ambient_intensity=1.0)
        assert abs(run(white, given)[0, 0, 0] - share) < 0.02


def test_depth_and_camera_do_as_well_as_positions(render):
    inputs, lights = scene(41, 31), tuple(LIGHTS.values())
    given = gbuffer(inputs)
    by_place = render(given, lights)["out"]
    given.pop("position")
    by_depth = render(given | {"depth": inputs["depth"]}, lights)["out"]
    assert np.abs(by_place - by_depth).max() < 1e-4 * np.abs(by_place).max()
    given.pop("normal")
    derived = render(given | {"depth": inputs["depth"]}, lights[4:5], ambient_intensity=0.0)["diffuse"]
    exact = render(gbuffer(inputs), lights[4:5])["diffuse"]
    assert np.median(np.abs(derived - exact)[inputs["depth"] < 1e9]) < 0.02 * exact.max()


def test_the_background_shows_emission_alone(render):
    inputs = scene(*SIZE)
    nothing = inputs["depth"] >= 1e9
    inputs["albedo"][nothing] = 1.0
    lights = tuple(LIGHTS.values())
    found = render(gbuffer(inputs) | {"emission": inputs["emission"]}, lights, ambient_intensity=1.0)
    assert nothing.any()
    assert (found["out"][nothing][:, :3] == inputs["emission"][nothing][:, :3]).all()
    assert (found["out"][..., 3] == inputs["albedo"][..., 3]).all()
    without = render(gbuffer(inputs) | {"depth": inputs["depth"]}, lights)
    assert (without["diffuse"][nothing][:, :3] == 0.0).all()


@pytest.mark.parametrize("few", [0, 10**6])
def test_bad_pixels_stay_where_they_are(run, monkeypatch, few):
    """NaN, infinity and nonsense in any input, in tiles too: finite, and the other pixels do not change a bit."""
    monkeypatch.setattr(module, "FEW", few)
    inputs, node = scene(*SIZE), DeferredLighting(lights=number_lights(strewn(30, 3)))
    whole = run(node, inputs | {"camera": CAMERA})
    for name, value in product((*GBUFFER, "emission", "occlusion"), (np.nan, np.inf, -np.inf, 3e38, -5.0)):
        spoiled = inputs | {name: inputs[name].copy()}
        spoiled[name][9, 11] = value
        found = run(node, spoiled | {"camera": CAMERA})
        assert np.isfinite(found).all()
        found[9, 11] = whole[9, 11]
        assert found.tobytes() == whole.tobytes(), (name, value)


def test_a_swarm_fills_its_box_evenly_in_all_its_colors():
    node = DeferredLighting(swarm=200, swarm_place=(1.0, 2.0, 3.0), swarm_spread=(4.0, 2.0, 0.5), swarm_intensity=-3.0)
    lights = tuple(node._swarm(1000))
    places = (np.array([light.place for light in lights]) - (1.0, 2.0, 3.0)) / (4.0, 2.0, 0.5)
    assert len(lights) == 200 and np.abs(places).max() < 1.0
    octants = np.histogramdd(places, bins=2, range=[(-1, 1)] * 3)[0]
    assert octants.min() > 20
    assert lights[0].intensity == -3.0 and lights[0].reach == node.swarm_reach
    assert np.ptp([light.color for light in lights], axis=0).min() > 0.5
    other = tuple(node.with_values(swarm_seed=1)._swarm(1000))
    assert other[0].place != lights[0].place
    assert len(tuple(node._swarm(7))) == 7


def test_a_swarm_is_so_many_lights_of_the_list(run):
    inputs = gbuffer(scene(*SIZE)) | {"camera": CAMERA}
    node = DeferredLighting(swarm=40)
    listed = DeferredLighting(lights=number_lights((*lights_of(node.lights), *node._swarm(40))))
    assert run(node, inputs).tobytes() == run(listed, inputs).tobytes()
