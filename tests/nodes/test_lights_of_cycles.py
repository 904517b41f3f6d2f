"""Relit layers of Blender against the same lights by Cycles, in the units of the files.

Inside of surfaces they are equal. At edges a pixel shows several surfaces, whose layers are filtered together. There
the measures are the light of the filtered normal, which is what a shader makes of the layers that knows nothing of
coverage, and a second render by Cycles with as many samples in other places: it shows other shares of the surfaces.
tests/data/make_blender_lights.py made the pictures.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from halation.nodes import Light, LightKind, look_at, name_lights
from halation.nodes.light.deferred_lighting import DeferredLighting
from halation.nodes.light.image_based_light import ImageBasedLight
from scipy.ndimage import binary_dilation, maximum_filter, minimum_filter

Array = np.ndarray

DATA = Path(__file__).parents[1] / "data/blender_lights.npz"
HEIGHT, WIDTH = 96, 128
DOWN = math.radians(10.0)
CAMERA = look_at(
    (0.0, -8.0, 2.6), (0.0, math.cos(DOWN) - 8.0, 2.6 - math.sin(DOWN)), (38.0 / 36.0, 38.0 / 36.0 * WIDTH / HEIGHT)
)
LAMP = (1.5, -3.0, 3.0)
STRENGTH = 400.0 / (4.0 * math.pi)
"""W/sr of a lamp of 400 W."""


@pytest.fixture(scope="module")
def layers() -> dict[str, Array]:
    """All pictures of the file."""
    with np.load(DATA) as file:
        return {name: np.asarray(file[name], np.float64) for name in file.files}


@pytest.fixture(scope="module")
def places(layers: dict[str, Array]) -> tuple[Array, Array]:
    """Where pixels are wholly inside of a surface, and where several surfaces share one: by color and depth."""
    albedo, alpha, depth = layers["albedo"], layers["alpha"], np.minimum(layers["depth"], 50.0)
    color = (maximum_filter(albedo, (3, 3, 1)) - minimum_filter(albedo, (3, 3, 1))).max(axis=2)
    shared = (color > 0.02) | (maximum_filter(depth, 3) - minimum_filter(depth, 3) > 0.05 * depth)
    return (alpha > 0.999) & ~binary_dilation(shared), shared & (alpha > 0.02)


def relight(run, layers: dict[str, Array], kind: str) -> Array:
    """The picture by our nodes."""
    inputs = {
        "albedo": np.dstack([layers["albedo"], layers["alpha"]]),
        "normal": layers["normal"],
        "depth": layers["depth"],
        "camera": CAMERA,
    }
    if kind == "sky":
        sky = layers["environment"]
        inputs["environment"] = np.dstack([sky, np.ones(sky.shape[:2])])
    if kind in ("white", "sky"):
        return run(ImageBasedLight(specular=0.0), inputs, output="diffuse")[..., :3]
    sun = Light(LightKind.SUN, direction=tuple(layers["sun_direction"].tolist()), intensity=3.0)
    light = sun if kind == "sun" else Light(LightKind.POINT, LAMP, intensity=STRENGTH)
    node = DeferredLighting(lights=name_lights(light=light), ambient_intensity=0.0, specular=0.0)
    return run(node, inputs, output="diffuse")[..., :3]


def rms(error: Array, where: Array) -> float:
    return float(np.sqrt((error[where] ** 2).mean()))


@pytest.mark.parametrize(("kind", "most"), [("sun", 0.001), ("lamp", 0.002), ("white", 0.001), ("sky", 0.006)])
def test_inside_of_surfaces_it_is_the_light_of_cycles(run, layers, places, kind, most):
    """As a part of the mean light. Cycles adds noise to the sky."""
    inside, _ = places
    expected = layers[kind]
    assert rms(relight(run, layers, kind) - expected, inside) < most * expected[inside].mean()


@pytest.mark.parametrize(("kind", "most", "part"), [("sun", 0.025, 0.2), ("lamp", 0.08, 0.15)])
def test_at_edges_it_is_much_nearer_than_the_light_of_the_filtered_normal(run, layers, places, kind, most, part):
    _, edges = places
    normal, expected = layers["normal"], layers[kind]
    unit = normal / np.maximum(np.linalg.norm(normal, axis=2, keepdims=True), 1e-9)
    if kind == "sun":
        falling = 3.0 * np.maximum(-unit @ layers["sun_direction"], 0.0)
    else:
        across, down = np.meshgrid((np.arange(WIDTH) + 0.5) / WIDTH, (np.arange(HEIGHT) + 0.5) / HEIGHT)
        depth = np.minimum(layers["depth"], 1e6)
        seen = np.stack([across * depth, down * depth, depth], -1)
        rows = np.array(CAMERA.rows).reshape(3, 4)
        away = np.array(LAMP) - (seen - rows[:, 3]) @ np.linalg.inv(rows[:, :3]).T
        distance = np.linalg.norm(away, axis=2)
        falling = STRENGTH * np.maximum((unit * away).sum(2), 0.0) / distance**3
    plain = layers["albedo"] * falling[..., None] / math.pi
    scale = expected[edges].mean()
    own, other = (rms(light - expected, edges) / scale for light in (relight(run, layers, kind), plain))
    assert own < most and own < part * other


@pytest.mark.parametrize(("kind", "most"), [("white", 0.005), ("sky", 0.04)])
def test_at_edges_a_sky_is_that_of_cycles(run, layers, places, kind, most):
    _, edges = places
    expected = layers[kind]
    assert rms(relight(run, layers, kind) - expected, edges) < most * expected[edges].mean()


@pytest.mark.parametrize(
    ("kind", "part", "least"), [("sun", 1.35, 15), ("lamp", 1.1, 3), ("white", 0.3, 60), ("sky", 0.5, 1.5)]
)
def test_at_edges_it_differs_from_cycles_as_much_as_cycles_from_itself(run, layers, places, kind, part, least):
    """Two renders of 64 samples are `least` times as different at edges as inside, so no relighting can be equal there.

    Half of what the sun and the lamp leave beyond that is in ten pixels of 1,528, which show three surfaces. The first
    picture of the sky has 2,048 samples.
    """
    inside, edges = places
    expected = layers[kind]
    noise = layers[f"{kind}_again"] - expected
    assert rms(noise, edges) > least * rms(noise, inside)
    assert rms(relight(run, layers, kind) - expected, edges) < part * rms(noise, edges)


@pytest.mark.parametrize(("kind", "part"), [("sun", 1.05), ("lamp", 1.2)])
def test_but_for_ten_pixels_edges_are_as_good_as_a_second_render(run, layers, places, kind, part):
    _, edges = places
    expected = layers[kind]
    own, noise = (
        np.sort(((light - expected)[edges] ** 2).mean(axis=1))[:-10].mean()
        for light in (relight(run, layers, kind), layers[f"{kind}_again"])
    )
    assert own < part**2 * noise
