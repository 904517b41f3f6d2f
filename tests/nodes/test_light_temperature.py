"""Color temperatures and exposures of lights, against published chromaticities and the plain color."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import Light, LightKind, number_lights
from halation.nodes.light._blackbody import blackbody_chromaticity, blackbody_rec709
from halation.nodes.light.deferred_lighting import DeferredLighting

PLANCKIAN_LOCUS = {
    2000.0: (0.5267, 0.4133),
    2856.0: (0.4476, 0.4074),
    4000.0: (0.3805, 0.3768),
    5000.0: (0.3451, 0.3516),
    6500.0: (0.3135, 0.3237),
    10000.0: (0.2807, 0.2884),
}
"""Wyszecki and Stiles, Color Science (1982), table 1(3.3.4); 2856 K is illuminant A of CIE 15."""


@pytest.mark.parametrize("kelvin", PLANCKIAN_LOCUS)
def test_chromaticities_are_those_of_the_planckian_locus(kelvin):
    np.testing.assert_allclose(blackbody_chromaticity(kelvin), PLANCKIAN_LOCUS[kelvin], atol=8e-4)


def test_all_temperatures_are_equally_bright():
    for kelvin in np.linspace(1000.0, 15000.0, 57):
        assert np.dot(blackbody_rec709(kelvin), (0.2126729, 0.7151522, 0.0721750)) == pytest.approx(1.0)
    red, _, blue = np.array([blackbody_rec709(kelvin) for kelvin in (2000.0, 4000.0, 6500.0, 10000.0)]).T
    assert (np.diff(red) < 0.0).all() and (np.diff(blue) > 0.0).all()


def floor_lit_by(run, *lights: Light) -> np.ndarray:
    given = {
        "position": np.full((2, 3, 3), 1e-3),
        "normal": np.dstack([np.zeros((2, 3)), np.zeros((2, 3)), np.ones((2, 3))]),
    }
    node = DeferredLighting(lights=number_lights(lights), ambient_intensity=0.0, specular=0.0)
    return run(node, given)[0, 0, :3].astype(np.float64)


@pytest.mark.parametrize("kind", [LightKind.SUN, LightKind.POINT, LightKind.SPOT, LightKind.SPHERE])
def test_a_temperature_colors_a_light(run, kind):
    tint = (1.0, 0.5, 0.25)
    plain = floor_lit_by(run, Light(kind, color=tint))
    warm = floor_lit_by(run, Light(kind, color=tint, temperature=2856.0))
    np.testing.assert_allclose(warm / plain, blackbody_rec709(2856.0), rtol=1e-5)


def test_lights_without_a_temperature_keep_their_color(run):
    cold, warm = Light(color=(0.2, 0.5, 1.0)), Light(temperature=3200.0)
    both = floor_lit_by(run, cold, warm)
    np.testing.assert_allclose(both, floor_lit_by(run, cold) + floor_lit_by(run, warm), rtol=1e-5)


def test_a_stop_doubles_the_light(run):
    np.testing.assert_allclose(floor_lit_by(run, Light(exposure=1.5)), 2.0**1.5 * floor_lit_by(run, Light()), rtol=1e-5)


def test_solo_lights_shine_alone(run):
    key, fill = Light(color=(1.0, 0.0, 0.0), solo=True), Light(color=(0.0, 1.0, 0.0))
    np.testing.assert_array_equal(floor_lit_by(run, key, fill), floor_lit_by(run, key))
