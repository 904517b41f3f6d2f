"""Light on pixels that two surfaces share, as a renderer filters them: against shading 8 x 8 samples of each pixel."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import Light, LightKind, look_at, number_lights
from halation.nodes.light.deferred_lighting import DeferredLighting
from halation.nodes.light.directional_occlusion import DirectionalOcclusion
from halation.nodes.light.image_based_light import ImageBasedLight
from halation.nodes.light.screen_reflections import ScreenReflections
from raycast import cast_rays
from scipy.ndimage import binary_dilation, maximum_filter, minimum_filter

Array = np.ndarray

CAMERA = look_at((-0.5, -3.5, 1.6), (0.4, 2.0, 0.9), (1.1, 0.8))
WIDTH, HEIGHT, SAMPLES = 120, 88, 8
SUN, LAMP = np.array([0.4, 0.7, -0.6]), np.array([-1.5, -0.5, 3.0])
COLORS = np.array([(0.0, 0.0, 0.0), (0.7, 0.6, 0.5), (0.3, 0.5, 0.8), (0.8, 0.2, 0.15)])


def filtered(samples: Array) -> Array:
    """The mean over the samples of each pixel."""
    return samples.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, -1).mean((1, 3))


@pytest.fixture(scope="module")
def scene() -> dict[str, Array]:
    """A ball, a floor, a wall and sky: color and normals filtered over pixels, depth at their centers."""
    fine, centers = cast_rays(CAMERA, WIDTH * SAMPLES, HEIGHT * SAMPLES), cast_rays(CAMERA, WIDTH, HEIGHT)
    surface = np.where(fine.normal[..., 2] == 1.0, 1, np.where(fine.normal[..., 1] == -1.0, 2, 3)) * fine.hit
    albedo = COLORS[surface]
    toward = LAMP - fine.position
    distance = np.linalg.norm(toward, axis=-1)
    lamp = 30.0 * np.clip((toward * fine.normal).sum(-1) / distance**3, 0.0, None)
    sun = 2.0 * np.clip(fine.normal @ (-SUN / np.linalg.norm(SUN)), 0.0, None)
    blocks = surface.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES)
    edges = blocks.max((1, 3)) != blocks.min((1, 3))
    kinds = np.stack([(blocks == kind).any((1, 3)) for kind in range(4)])
    return {
        "albedo": np.dstack([filtered(albedo), np.ones((HEIGHT, WIDTH))]),
        "normal": filtered(fine.normal),
        "depth": np.where(centers.hit, centers.depth, 1e10),
        "lit": filtered(albedo * (lamp + sun)[..., None] / np.pi),
        "sky": filtered(albedo),
        "edges": edges,
        "corners": maximum_filter(kinds.sum(0), 5) > 2,
    }


def errors(scene: dict[str, Array], light: Array, expected: str) -> tuple[float, float, float]:
    """RMS inside of surfaces, RMS at edges, and the largest error at edges of two surfaces."""
    error = np.abs(light[..., :3] - scene[expected]).max(-1)
    edges, inside = scene["edges"], ~binary_dilation(scene["edges"], np.ones((3, 3)))
    assert edges.sum() > 250
    square = error**2
    return square[inside].mean() ** 0.5, square[edges].mean() ** 0.5, error[edges & ~scene["corners"]].max()


def test_the_scene_has_pixels_of_two_surfaces(scene):
    """They are a seam of one pixel, and their normals are shorter."""
    size = np.linalg.norm(scene["normal"], axis=-1)
    assert size[scene["edges"]].mean() < 0.85
    assert (minimum_filter(scene["edges"], 3) & scene["edges"]).sum() < 0.02 * scene["edges"].sum()


@pytest.mark.parametrize("alpha", [False, True])
def test_lamps_light_each_surface_of_a_pixel(run, scene, alpha):
    lights = (
        Light(LightKind.SUN, direction=tuple(SUN.tolist()), intensity=2.0, color=(1.0, 1.0, 1.0)),
        Light(LightKind.POINT, tuple(LAMP.tolist()), intensity=30.0, color=(1.0, 1.0, 1.0)),
    )
    node = DeferredLighting(lights=number_lights(lights), ambient_intensity=0.0, specular=0.0)
    inputs = {name: scene[name] for name in ("albedo", "normal", "depth")}
    if alpha:
        inputs["albedo"] = inputs["albedo"].copy()
        inputs["albedo"][..., 3] = filtered(
            (np.linalg.norm(cast_rays(CAMERA, WIDTH * SAMPLES, HEIGHT * SAMPLES).normal, axis=-1) > 0.5) * 1.0
        )[..., 0]
    light = run(node, inputs | {"camera": CAMERA}, output="diffuse")
    inside, edges, largest = errors(scene, light, "lit")
    assert inside < 1e-3 and edges < 6e-3 and largest < 0.03
    assert (light[..., 3] == inputs["albedo"][..., 3].astype(np.float32)).all()


@pytest.mark.parametrize("deep", [False, True])
def test_surroundings_light_each_surface_of_a_pixel(run, scene, deep):
    names = ("albedo", "normal", "depth") if deep else ("albedo", "normal")
    inputs = {name: scene[name] for name in names} | {"camera": CAMERA}
    inside, edges, largest = errors(scene, run(ImageBasedLight(specular=0.0), inputs, output="diffuse"), "sky")
    assert inside < 1e-3 and edges < 6e-3 and largest < 0.03


def test_surroundings_without_shade_light_each_surface_of_a_pixel(run, scene):
    """Where nothing is near enough to hide the sky, directional occlusion lights as the sky does."""
    inputs = {name: scene[name] for name in ("albedo", "normal", "depth")} | {"camera": CAMERA}
    inputs |= {"image": np.zeros((HEIGHT, WIDTH, 4)), "environment": np.ones((16, 32, 4))}
    light = run(DirectionalOcclusion(radius=1e-4, bounce=0.0), inputs, output="light")
    inside, edges, largest = errors(scene, light, "sky")
    assert inside < 5e-3 and edges < 1.3 * max(inside, 5e-3) and largest < 0.03


def test_reflections_are_divided_by_coverage(run, scene):
    """Against the same mirrors at 4 x 4 pixels for each, which are not filtered."""
    times, node = 4, ScreenReflections(reflectance=0.6, roughness=0.0, sky=False, thickness=2.0)
    fine = cast_rays(CAMERA, WIDTH * times, HEIGHT * times)
    surface = np.where(fine.normal[..., 2] == 1.0, 1, np.where(fine.normal[..., 1] == -1.0, 2, 3)) * fine.hit
    image = np.dstack([COLORS[surface], np.ones(surface.shape)])
    sharp = {"image": image, "normal": fine.normal, "depth": np.where(fine.hit, fine.depth, 1e10), "camera": CAMERA}
    expected = run(node, sharp, output="reflection").reshape(HEIGHT, times, WIDTH, times, 4).mean((1, 3))
    inputs = {"image": scene["albedo"], "normal": scene["normal"], "depth": scene["depth"], "camera": CAMERA}
    error = np.abs(run(node, inputs, output="reflection") - expected)[..., :3].max(-1)
    assert np.sqrt((error[scene["edges"]] ** 2).mean()) < 0.085


def test_hard_edges_stay_hard(run, scene):
    """Layers without antialiasing have no shared pixels: each is lit as if it were alone."""
    centers = cast_rays(CAMERA, WIDTH, HEIGHT)
    albedo = np.random.default_rng(3).uniform(0.1, 0.9, (HEIGHT, WIDTH, 4))
    albedo[..., 3] = 1.0
    inputs = {"albedo": albedo, "normal": centers.normal, "camera": CAMERA}
    light = run(ImageBasedLight(specular=0.0), inputs, output="diffuse")
    np.testing.assert_allclose(light[..., :3], albedo[..., :3] * centers.hit[..., None], atol=1e-5)
