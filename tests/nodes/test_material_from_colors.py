"""Materials from the colors of a render, against the materials of Cycles and against the equation itself."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import Light, LightKind, look_at, number_lights
from halation.nodes.geometry.material_from_colors import MaterialFromColors
from halation.nodes.light.deferred_lighting import DeferredLighting

CYCLES = {
    "gold": ((1.0, 0.766, 0.336), 1.0, (0.0, 0.0, 0.0), (1.0, 0.7643, 0.3339)),
    "copper": ((0.955, 0.638, 0.538), 1.0, (0.0, 0.0, 0.0), (0.9511, 0.6178, 0.5165)),
    "red plastic": ((0.8, 0.1, 0.05), 0.0, (0.7686, 0.0961, 0.048), (0.0392, 0.0392, 0.0392)),
    "half metal": ((0.5, 0.5, 0.5), 0.5, (0.2405, 0.2405, 0.2405), (0.2578, 0.2578, 0.2578)),
}
"""Base color and metalness of the Principled BSDF, and what Cycles 5.0.1 writes as Diffuse Color and Glossy Color in
the middle of a ball of it."""


def opaque(*colors: tuple[float, ...]) -> np.ndarray:
    return np.array([[(*color, 1.0) for color in colors]], np.float32)


def find_material(run, diffuse: np.ndarray, glossy: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    given = {"diffuse_color": diffuse, "glossy_color": glossy}
    return tuple(run(MaterialFromColors(), given, output=name) for name in ("albedo", "material"))


@pytest.mark.parametrize("name", CYCLES)
def test_materials_of_cycles_are_found(run, name):
    color, metal, diffuse, glossy = CYCLES[name]
    albedo, material = find_material(run, opaque(diffuse), opaque(glossy))
    np.testing.assert_allclose(albedo[0, 0, :3], color, atol=0.035)
    assert material[0, 0, 0] == pytest.approx(metal, abs=0.03)


def test_every_mixture_is_found_from_its_colors(run):
    random = np.random.default_rng(1)
    base, metal = random.uniform(0.1, 1.0, (8, 9, 3)), random.uniform(0.0, 1.0, (8, 9, 1))
    diffuse, glossy = base * (1.0 - metal), base * metal + 0.04 * (1.0 - metal)
    alpha = random.uniform(0.2, 1.0, (8, 9, 1))
    layers = (np.dstack([color * alpha, alpha]).astype(np.float32) for color in (diffuse, glossy))
    albedo, material = find_material(run, *layers)
    np.testing.assert_allclose(albedo[..., :3], base * alpha, atol=2e-5)
    np.testing.assert_allclose(material[..., :1], metal, atol=2e-4)


def test_black_plastic_is_no_metal_and_nothing_is_nothing(run):
    albedo, material = find_material(run, opaque((0.02, 0.02, 0.02), (0.0, 0.0, 0.0)), opaque((0.04,) * 3, (0.0,) * 3))
    np.testing.assert_allclose(albedo[0, :, :3], [[0.02] * 3, [0.0] * 3], atol=1e-5)
    np.testing.assert_allclose(material[0, :, 0], 0.0, atol=1e-4)


def find_by_light(run, diffuse: np.ndarray, beauty: np.ndarray, emission: np.ndarray, **values) -> tuple:
    given = {"diffuse_color": diffuse, "beauty": beauty, "emission": emission}
    given |= {"roughness": np.full(diffuse.shape[:2], 0.5)}
    node = MaterialFromColors(metals="beauty", **values)
    return tuple(run(node, given, output=name) for name in ("albedo", "material"))


LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""ITU-R BT.709-6."""


def test_black_that_gives_light_is_metal_of_its_hue(run):
    """Gold, a leaf, a lamp, and a lamp that also mirrors: half of its light."""
    diffuse = opaque((0.0, 0.0, 0.0), (0.1, 0.35, 0.08), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    gold = np.array([0.5, 0.38, 0.17])
    beauty = opaque(tuple(gold), (0.3, 0.3, 0.3), (4.0, 2.0, 1.0), (2.0, 2.0, 2.0))
    emission = opaque((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (4.0, 2.0, 1.0), (1.0, 1.0, 1.0))
    albedo, material = find_by_light(run, diffuse, beauty, emission, reflectance=0.6, roughen=0.1, polish=0.2)
    metal = np.array([1.0, 0.0, 0.0, 0.5])
    expected = [0.6 * gold / (gold @ LUMINANCE), (0.1, 0.35, 0.08), (0.0,) * 3, (0.3,) * 3]
    np.testing.assert_allclose(albedo[0, :, :3], expected, atol=1e-5)
    np.testing.assert_allclose(material[0], np.stack([metal, 0.6 - 0.2 * metal], -1), atol=1e-5)


def test_an_edge_of_metal_is_as_much_metal_as_it_covers(run):
    """The mean of gold and of a wall, from one side to the other, upright and across."""
    cover, gold, wall = np.array([0.05, 0.2, 0.4, 0.6, 0.8]), np.array([0.5, 0.38, 0.17]), np.array([0.7, 0.5, 0.3])
    shares = np.repeat(np.array([[1.0, 1.0, 0.0, 0.0, 0.0]]), len(cover), 0)
    shares[:, 2] = cover
    shares = shares[..., None]
    one = np.ones_like(shares)
    diffuse = np.concatenate([(1.0 - shares) * wall, one], -1)
    beauty = np.concatenate([shares * gold + (1.0 - shares) * 0.4 * wall, one], -1)
    expected = shares * 0.7 * gold / (gold @ LUMINANCE) + (1.0 - shares) * wall
    for turn in (lambda rows: rows[:1], lambda rows: rows[:1].transpose(1, 0, 2)):
        for row in range(len(cover)):
            layers = [turn(layer[row : row + 1]) for layer in (diffuse, beauty, np.zeros_like(diffuse))]
            albedo, material = find_by_light(run, *layers)
            np.testing.assert_allclose(albedo[..., :3], turn(expected[row : row + 1]), atol=2e-5)
            np.testing.assert_allclose(material[..., :1], turn(shares[row : row + 1]), atol=2e-5)


def test_a_dark_surface_of_another_hue_beside_metal_is_no_edge_of_it(run):
    colors = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.1, 0.35, 0.08), (0.7, 0.5, 0.3), (0.7, 0.5, 0.3))
    beauty, nothing = opaque(*[(0.4, 0.4, 0.4)] * 5), opaque(*[(0.0, 0.0, 0.0)] * 5)
    albedo, material = find_by_light(run, opaque(*colors), beauty, nothing)
    np.testing.assert_allclose(albedo[0, 2, :3], colors[2], atol=1e-5)
    assert material[0, 2, 0] == pytest.approx(0.0, abs=1e-5)


def test_a_rim_is_no_metal_because_little_of_it_is_there(run):
    """Light of a transparent film is premultiplied, and the alpha of the render is that of the surface."""
    leaf, light, alpha = np.array([0.1, 0.35, 0.08]), np.array([0.2, 0.4, 0.1]), np.array([0.05, 0.3, 1.0])[:, None]
    diffuse = np.concatenate([leaf * alpha, np.ones((3, 1))], -1)[None]
    beauty, nothing = np.concatenate([light * alpha, alpha], -1)[None], np.zeros((1, 3, 4))
    albedo, material = find_by_light(run, diffuse, beauty, nothing)
    np.testing.assert_allclose(albedo[0], np.concatenate([leaf * alpha, alpha], -1), atol=1e-5)
    np.testing.assert_allclose(material[0, :, 0], 0.0, atol=1e-5)


def test_gold_that_is_lit_again_looks_like_gold(run):
    color, _, diffuse, glossy = CYCLES["gold"]
    albedo, material = find_material(run, opaque(diffuse), opaque(glossy))
    up, eye = np.array([[[0.0, 0.0, 1.0]]]), (0.0, -1.0, 1.0)
    lights = number_lights((Light(LightKind.RECTANGLE, (0.0, 2.0, 2.0), (0.0, -1.0, -1.0), width=2.0, height=2.0),))
    node = DeferredLighting(lights=lights, ambient_intensity=0.0)
    geometry = {"normal": up, "position": 1e-6 * up, "camera": look_at(eye, (0.0, 0.0, 0.0), (1.0, 1.0))}
    lit = run(node, geometry | {"albedo": albedo, "material": material})[0, 0, :3]
    assert lit[0] > 0.1
    np.testing.assert_allclose(lit / lit[0], np.array(color) / color[0], atol=0.02)
    dull = run(node, geometry | {"albedo": opaque(diffuse)})[0, 0, :3]
    assert dull.max() < 0.1 * lit[0]
