"""Deferred lighting against closed forms and integrals: a white furnace, balls of light, a ball that sets."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import Light, look_at, number_lights
from halation.nodes.light.deferred_lighting import DeferredLighting
from lighting_formulas import FURNACE, SPHERE, SUN, dot, ggx, unit


@pytest.mark.parametrize(("alpha", "mu", "share"), FURNACE)
def test_a_white_furnace_loses_what_single_scattering_loses(run, alpha, mu, share):
    """Suns where visible facets (Heitz 2018) mirror the eye, as bright as they are rare: their sum is the albedo."""
    count, eye = 1024, np.array([np.sqrt(1.0 - mu * mu), 0.0, mu])
    at = np.arange(count) + 0.5
    radius, turn = np.sqrt(at / count), 2.0 * np.pi * ((at * 0.6180339887498949) % 1.0)
    stretched = unit(eye * (alpha, alpha, 1.0))
    across = np.array([0.0, 1.0, 0.0])
    x, y = radius * np.cos(turn), radius * np.sin(turn)
    y = 0.5 * (1.0 - stretched[2]) * np.sqrt(1.0 - x * x) + 0.5 * (1.0 + stretched[2]) * y
    z = np.sqrt(np.maximum(1.0 - x * x - y * y, 0.0))
    h = x[:, None] * across + y[:, None] * np.cross(stretched, across) + z[:, None] * stretched
    h = unit(h * (alpha, alpha, 1.0))
    ways = 2.0 * (h @ eye)[:, None] * h - eye
    facets = alpha**2 / (np.pi * (h[:, 2] ** 2 * (alpha**2 - 1.0) + 1.0) ** 2)
    density = facets * 0.5 / (mu + np.sqrt(alpha**2 + (1.0 - alpha**2) * mu * mu))
    suns = tuple(
        Light(SUN, direction=tuple(-way), intensity=1.0 / (count * often))
        for way, often in zip(ways, density, strict=True)
        if way[2] > 0.0
    )
    up = np.array([[[0.0, 0.0, 1.0]]])
    inputs = {
        "albedo": np.ones((1, 1, 4)),
        "normal": up,
        "position": 1e-3 * up,
        "material": np.array([[[1.0, np.sqrt(alpha)]]]),
        "camera": look_at(tuple(1e4 * eye), (0, 0, 0), (1.0, 1.0)),
    }
    found = run(DeferredLighting(lights=number_lights(suns), ambient_intensity=0.0), inputs)
    assert abs(found[0, 0, 0] - share) < 0.002


@pytest.mark.parametrize("tilt", [0.0, 0.9])
@pytest.mark.parametrize(("roughness", "size"), [(0.15, 0.2), (0.15, 1.0), (0.4, 0.6), (0.7, 0.6)])
def test_a_ball_of_light_is_the_integral_over_its_points(run, roughness, size, tilt):
    """Its diffuse light to 1e-3; the middle of its highlight, which is an approximation, to 10 percent."""
    distance, count = 2.0, 512
    n, eye = np.array([0.0, 0.0, 1.0]), np.array([-np.sin(tilt), 0.0, np.cos(tilt)])
    middle = distance * np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    cosine = 1.0 - (np.arange(count) + 0.5) / count * (1.0 - np.sqrt(1.0 - (size / distance) ** 2))
    turn = 2.0 * np.pi * (np.arange(count) + 0.5) / count
    cosine, turn = (grid.ravel() for grid in np.meshgrid(cosine, turn))
    sine, side = np.sqrt(1.0 - cosine**2), np.array([0.0, 1.0, 0.0])
    ways = np.outer(sine * np.cos(turn), np.cross(side, middle / distance)) + np.outer(sine * np.sin(turn), side)
    ways += np.outer(cosine, middle / distance)
    radiance = 5.0 / (np.pi * size**2)
    span, nl = 2.0 * np.pi * (1.0 - np.sqrt(1.0 - (size / distance) ** 2)), np.maximum(ways[:, 2:], 0.0)
    diffuse = (nl / np.pi).mean() * radiance * span
    vh = dot(eye, unit(ways + eye))
    fresnel = 0.04 + 0.96 * (1.0 - vh) ** 5
    shine = (ggx(n, eye + 0 * ways, ways, np.array([roughness**2])) * fresnel * nl).mean() * radiance * span
    node = DeferredLighting(
        lights=number_lights((Light(SPHERE, tuple(middle), intensity=5.0, size=size),)),
        roughness=roughness,
        ambient_intensity=0.0,
    )
    inputs = {
        "albedo": np.ones((1, 1, 4)),
        "normal": n[None, None],
        "position": 1e-6 * n[None, None],
        "camera": look_at(tuple(1e4 * eye), (0, 0, 0), (1.0, 1.0)),
    }
    assert abs(run(node, inputs, output="diffuse")[0, 0, 0] / diffuse - 1.0) < 1e-3
    assert abs(run(node, inputs, output="specular_light")[0, 0, 0] / shine - 1.0) < 0.1


def test_a_ball_that_sets_still_lights(run):
    """The integral over the part of a ball of light that is above the horizon."""
    size, count, random = 0.8, 400_000, np.random.default_rng(2)
    for height in (0.5, 0.0, -0.5):
        middle = np.array([np.sqrt(4.0 - height**2), 0.0, height])
        cosine = 1.0 - random.random(count) * (1.0 - np.sqrt(1.0 - size**2 / 4.0))
        sine, turn = np.sqrt(1.0 - cosine**2), 2.0 * np.pi * random.random(count)
        up = cosine * middle[2] / 2.0 + sine * np.cos(turn) * np.sqrt(1.0 - height**2 / 4.0)
        span = 2.0 * np.pi * (1.0 - np.sqrt(1.0 - size**2 / 4.0))
        wanted = np.maximum(up, 0.0).mean() * span / (np.pi * size**2) / np.pi
        node = DeferredLighting(
            lights=number_lights((Light(SPHERE, tuple(middle), intensity=1.0, size=size),)), ambient_intensity=0.0
        )
        inputs = {"albedo": np.ones((1, 1, 4)), "normal": [[[0, 0, 1]]], "position": [[[0, 0, 1e-6]]]}
        assert abs(run(node, inputs, output="diffuse")[0, 0, 0] - wanted) < 2e-4
