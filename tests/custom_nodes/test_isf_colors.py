"""Colors of values of ISF shaders, which hold display codes: against OpenColorIO's sRGB and IEC 61966-2-1."""

from __future__ import annotations

import numpy as np
import PyOpenColorIO as ocio
import pytest
from halation.custom_nodes.isf.inputs import decode_light, encode_light
from house_config import studio
from isf_files import isf, opaque, shader

NUMBERS = [0.0, 1e-5, 0.0031308, 0.0031309, 0.04, 0.04045, 0.04046, 0.18, 0.5, 0.75, 1.0]


def test_light_and_codes_are_those_of_opencolorio() -> None:
    to_light = (
        studio()
        .getProcessor("srgb_rec709_scene", "lin_rec709_scene")
        .getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS)
    )
    to_codes = (
        studio()
        .getProcessor("lin_rec709_scene", "srgb_rec709_scene")
        .getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS)
    )
    for number in NUMBERS:
        assert decode_light(number) == pytest.approx(to_light.applyRGB([number] * 3)[1], abs=2e-6)
        assert encode_light(number) == pytest.approx(to_codes.applyRGB([number] * 3)[1], abs=2e-6)


@pytest.mark.parametrize(("code", "light"), [(0.5, 0.21404114), (0.735356983, 0.5), (0.04045, 0.0031308), (1.0, 1.0),
                                             (1.353256, 2.0)])  # fmt: skip
def test_known_pairs_and_their_negatives(code: float, light: float) -> None:
    """Below black the curve is turned around, and beyond white it goes on."""
    for sign in (1.0, -1.0):
        assert decode_light(sign * code) == pytest.approx(sign * light, rel=1e-4)
        assert encode_light(sign * light) == pytest.approx(sign * code, rel=1e-4)


def test_one_undoes_the_other() -> None:
    for number in np.linspace(-2.0, 2.0, 401).tolist():
        assert encode_light(decode_light(number)) == pytest.approx(number, abs=2e-7)


@pytest.mark.parametrize("light", ["display", "linear"])
def test_a_shader_is_given_the_code_of_a_value_and_its_output_is_taken_for_one(run, light: str) -> None:
    """A color that is written out is the light of the value, whatever the shader computes with."""
    tint = {"NAME": "tint", "TYPE": "color", "DEFAULT": [0.5, 0.735356983, 1.0, 1.0]}
    kind = shader(isf("gl_FragColor = tint;", {"NAME": "inputImage", "TYPE": "image"}, tint))
    assert kind.values["tint"].default == pytest.approx((0.21404114, 0.5, 1.0, 1.0), rel=1e-5)
    found = run(kind(light=light, tint=(0.02, 0.5, 3.0, 1.0)), {"inputImage": opaque(3, 4)})
    np.testing.assert_allclose(found, np.full((3, 4, 4), (0.02, 0.5, 3.0, 1.0)), rtol=2e-5)
    half = shader(isf("gl_FragColor = vec4(0.5 * tint.rgb, 1.0);", {"NAME": "inputImage", "TYPE": "image"}, tint))
    found = run(half(light=light, tint=(0.5, 0.5, 0.5, 1.0)), {"inputImage": opaque(3, 4)})
    expected = 0.25 if light == "linear" else ((0.5 * 0.735356983 + 0.055) / 1.055) ** 2.4
    np.testing.assert_allclose(found[..., :3], expected, rtol=2e-5)
