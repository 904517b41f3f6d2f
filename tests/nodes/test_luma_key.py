"""The luma key against numpy's piecewise linear interpolation."""

from __future__ import annotations

import colorsys

import numpy as np
import pytest
from halation.nodes.color.luma_key import LumaKey

MEASURES = {
    "luminance": lambda rgb: rgb @ [0.2126, 0.7152, 0.0722],
    "maximum": lambda rgb: rgb.max(-1),
    "minimum": lambda rgb: rgb.min(-1),
    "saturation": lambda rgb: np.apply_along_axis(lambda c: colorsys.rgb_to_hsv(*c)[1], -1, rgb),
}
VALUES = {"low": 0.4, "high": 0.7, "low_softness": 0.3, "high_softness": 0.2}


@pytest.mark.parametrize("measure", MEASURES)
@pytest.mark.parametrize("invert", [False, True])
def test_the_matte_is_a_trapezoid(run, hdr, measure, invert):
    picture = hdr(23, 17, opaque=True)
    light = MEASURES[measure](picture[..., :3].astype(np.float64))
    kept = np.interp(light, [0.1, 0.4, 0.7, 0.9], [0.0, 1.0, 1.0, 0.0])
    kept = 1 - kept if invert else kept
    node = LumaKey(measure=measure, invert=invert, **VALUES)
    assert np.abs(run(node, {"image": picture}, output="matte")[..., 0] - kept).max() < 2e-6
    out = run(node, {"image": picture})
    assert (np.abs(out - picture * kept[..., None]) / np.maximum(picture, 1.0)).max() < 2e-6


def test_the_two_halves_add_up(run, hdr):
    picture = hdr(9, 7)
    both = [run(LumaKey(invert=invert), {"image": picture}) for invert in (False, True)]
    assert (np.abs(sum(both) - picture) / np.maximum(picture, 1.0)).max() < 1e-6


def test_coverage_does_not_change_the_key(run, hdr):
    picture = hdr(9, 7, opaque=True)
    whole = run(LumaKey(**VALUES), {"image": picture}, output="matte")
    half = run(LumaKey(**VALUES), {"image": picture * np.float32(0.5)}, output="matte")
    assert np.abs(half - 0.5 * whole).max() < 1e-6


def test_without_softness_it_is_a_threshold(run):
    ramp = np.linspace(0, 1, 101)
    picture = np.stack([ramp, ramp, ramp, np.ones(101)], -1)[None]
    node = LumaKey(measure="maximum", low=0.255, low_softness=0.0)
    np.testing.assert_array_equal(run(node, {"image": picture}, output="matte")[0, :, 0], ramp > 0.255)
