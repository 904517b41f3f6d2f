"""Reflections at pixels that several metals share, against the same node at 5 x 5 samples of each pixel.

A reflection changes fast with the normal, so that a wrong surface at an edge is a dot. What the layers can tell at all
is measured too: an oracle knows which surfaces a pixel shows, how much each covers and the mean of its normals.
"""

from __future__ import annotations

from importlib import resources

import numpy as np
import pytest
from exr_files import read
from eyes import CAMERA, COLORS, EYES, HEAD, HEIGHT, METAL, PLASTIC, SAMPLES, STEEL, WIDTH, by_pixel, see
from halation.nodes import Light, LightKind, name_lights
from halation.nodes.light.deferred_lighting import DeferredLighting
from halation.nodes.light.image_based_light import ImageBasedLight
from scipy.ndimage import binary_dilation

Array = np.ndarray

SEEN = 48
"""Samples of a pixel in a noisy render, as the sample frame has."""


@pytest.fixture(scope="module")
def scene() -> dict[str, Array]:
    """What each sample of each pixel sees: [HEIGHT, WIDTH, samples, ...]."""
    samples = see(CAMERA)
    facet = np.abs(samples.normal).argmax(axis=-1) * np.isin(samples.thing, (STEEL, PLASTIC))
    layers = {"normal": samples.normal, "depth": samples.depth, "thing": samples.thing, "facet": facet}
    return {name: by_pixel(layer) for name, layer in layers.items()}


def shown(run, normal: Array, depth: Array, color: Array, metallic: Array) -> Array:
    """The reflections of a studio, where white is 0.5, as a display would compress them."""
    with resources.as_file(resources.files("halation.presets") / "samples" / "studio.exr") as path:
        sky = np.asarray(read(path))[..., :3]
    opaque = [np.dstack([color, np.ones(depth.shape)]), np.dstack([sky, np.ones(sky.shape[:2])])]
    layers = {"normal": normal, "depth": depth, "albedo": opaque[0], "environment": opaque[1], "camera": CAMERA}
    layers |= {"metallic": metallic, "roughness": np.full(depth.shape, 0.25)}
    return run(ImageBasedLight(rotation=150.0, intensity=1.2), layers)[..., :3]


def compress(light: Array) -> Array:
    return light / (1.0 + light)


def find_expected(run, scene: dict[str, Array]) -> Array:
    """The mean over the samples of each pixel, each shaded alone."""
    flat = {
        name: np.swapaxes(layer.reshape(HEIGHT, WIDTH, SAMPLES, SAMPLES, -1), 1, 2) for name, layer in scene.items()
    }
    fine = {name: layer.reshape(HEIGHT * SAMPLES, WIDTH * SAMPLES, -1) for name, layer in flat.items()}
    thing = fine["thing"][..., 0].astype(int)
    return by_pixel(shown(run, fine["normal"], fine["depth"][..., 0], COLORS[thing], METAL[thing])).mean(axis=2)


def find_places(scene: dict[str, Array]) -> dict[str, Array]:
    """Pixels inside of surfaces, rims of eyes in metal, edges of two boxes, and their creases."""
    thing, facet = scene["thing"], scene["facet"]
    edge = thing.max(axis=2) != thing.min(axis=2)
    crease = ~edge & (facet.max(axis=2) != facet.min(axis=2))
    has = {number: (thing == number).any(axis=2) for number in (HEAD, EYES, STEEL, PLASTIC)}
    return {
        "inside": ~binary_dilation(edge | crease, np.ones((3, 3))),
        "eyes": edge & has[HEAD] & has[EYES],
        "steel": edge & has[STEEL],
        "plastic": edge & has[PLASTIC],
        "creases": crease,
    }


def measure(light: Array, expected: Array, places: dict[str, Array]) -> dict[str, float]:
    """RMS of what a display would show, where white is 0.5."""
    square = ((compress(light) - compress(expected)) ** 2).max(axis=-1)
    return {name: float(np.sqrt(square[place].mean())) for name, place in places.items()}


def test_rims_of_metals_have_no_dots(run, scene):
    """Filtered exactly, and from 48 samples. What took normals nearby as they are was off by 0.22 at eyes."""
    expected, places = find_expected(run, scene), find_places(scene)
    chosen = np.random.default_rng(5).integers(0, SAMPLES**2, (HEIGHT, WIDTH, SEEN))
    for pick in (None, chosen):
        few = {
            name: layer if pick is None else np.take_along_axis(layer, pick[..., None] if layer.ndim == 4 else pick, 2)
            for name, layer in scene.items()
        }
        thing, middle = few["thing"].astype(int), few["depth"].shape[2] // 2 + 3
        light = shown(
            run, few["normal"].mean(2), few["depth"][:, :, middle], COLORS[thing].mean(2), METAL[thing].mean(2)
        )
        found = measure(light, expected, places)
        most = {"inside": 0.018, "eyes": 0.175, "steel": 0.072, "plastic": 0.015, "creases": 0.065}
        assert {name: error for name, error in found.items() if error > most[name]} == {}


def test_what_the_layers_can_tell(run, scene):
    """The oracle is nearer where surfaces turn fast: at eyes, whose normals beside the edge tell less than the edge."""
    expected, places = find_expected(run, scene), find_places(scene)
    total = np.zeros((HEIGHT, WIDTH, 3))
    facets = 10 * scene["thing"] + scene["facet"]
    for number in np.unique(facets):
        part = facets == number
        normal = (scene["normal"] * part[..., None]).sum(2)
        normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-9)
        depth, thing = np.where(part.any(2), scene["depth"].min(2), 1e10), int(number // 10)
        color, metallic = np.broadcast_to(COLORS[thing], (HEIGHT, WIDTH, 3)), np.full((HEIGHT, WIDTH), METAL[thing])
        total += part.mean(2)[..., None] * shown(run, normal, depth, color, metallic)
    found = measure(total, expected, places)
    assert 0.08 < found["eyes"] < 0.13 and max(found[name] for name in ("steel", "plastic", "creases")) < 0.02


def test_a_color_that_is_no_mix_does_not_tell_how_much_is_covered(run):
    """Two flat metals meet in a column, whose color is that of what it mirrors: normals alone divide the light."""
    rows, height = np.linspace(0.1, 0.9, 9), 9
    front, back = np.array([0.0, -0.6, 0.8]), np.array([0.0, -0.8, -0.6])
    normal, albedo = np.zeros((height, 7, 3)), np.full((height, 7, 4), 1.0)
    normal[:, :3], normal[:, 4:] = front, back
    normal[:, 3] = rows[:, None] * front + (1.0 - rows[:, None]) * back
    albedo[:, :3, :3], albedo[:, 4:, :3] = 0.4, 0.6
    albedo[:, 3, :3] = 0.6 - 0.2 * rows[::-1, None]  # as if each covered what the other one does
    sun = Light(LightKind.SUN, direction=(0.0, 0.6, -0.8), intensity=np.pi)
    node = DeferredLighting(lights=name_lights(sun=sun), ambient_intensity=0.0, specular=0.0)
    depth = np.full((height, 7), 5.0)
    depth[:, 4:] = 5.2
    light = run(node, {"normal": normal, "albedo": albedo, "depth": depth, "camera": CAMERA}, output="diffuse")
    expected = albedo[:, 3, 0] * 0.4 * rows / (0.4 * rows + 0.6 * (1.0 - rows))  # the sun shines on the front alone
    np.testing.assert_allclose(light[:, 3, 0] / light[:, 0, 0] * 0.4, expected, atol=2e-3)
