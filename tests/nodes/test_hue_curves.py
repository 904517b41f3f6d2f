"""Curves over the hue: colorsys for the hue, scipy for the curves, OKLab from its published matrices."""

from __future__ import annotations

import colorsys

import numpy as np
import pytest
from halation.nodes.color.color_balance import ColorBalance
from halation.nodes.color.hue_curves import HueCurves
from scipy.interpolate import PchipInterpolator

CONES = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
TURN = (0.0, 0.0, 0.2, 0.08, 0.45, -0.1, 0.8, 0.05, 1.0, 0.0)
FACTOR = (0.0, 1.0, 0.3, 1.8, 0.6, 0.2, 1.0, 1.0)


def curve(points: tuple[float, ...], x: np.ndarray) -> np.ndarray:
    return PchipInterpolator(points[::2], points[1::2])(x)


def make_colors() -> np.ndarray:
    picture = np.ones((20, 30, 4), np.float32)
    picture[..., :3] = np.random.default_rng(2).uniform(0.02, 1.5, (20, 30, 3))
    return picture


@pytest.mark.parametrize(
    "values",
    [
        {"hue_by_hue": TURN},
        {"saturation_by_hue": FACTOR},
        {"light_by_hue": FACTOR},
        {"saturation_by_saturation": FACTOR},
        {"hue_by_hue": TURN, "saturation_by_hue": FACTOR, "light_by_hue": FACTOR},
    ],
    ids=lambda values: "+".join(values),
)
def test_curves_change_hues(run, values):
    picture = make_colors()
    node = HueCurves(**values)
    rgb = picture[..., :3].astype(np.float64)
    hue, saturation, _ = np.moveaxis(np.apply_along_axis(lambda color: colorsys.rgb_to_hsv(*color), -1, rgb), -1, 0)
    lab = np.cbrt(rgb @ CONES.T) @ LAB.T
    angle = 2.0 * np.pi * saturation * curve(node.hue_by_hue, hue)
    factor = 1.0 + saturation * (curve(node.saturation_by_hue, hue) - 1.0)
    factor *= curve(node.saturation_by_saturation, saturation)
    turned = (lab[..., 1] + 1j * lab[..., 2]) * factor * np.exp(1j * angle)
    changed = np.stack([lab[..., 0], turned.real, turned.imag], -1)
    light = 1.0 + saturation * (curve(node.light_by_hue, hue) - 1.0)
    expected = light[..., None] * ((changed @ np.linalg.inv(LAB).T) ** 3 @ np.linalg.inv(CONES).T)
    out = run(node, {"image": picture})
    np.testing.assert_allclose(out[..., :3], expected, atol=2e-4)
    half = run(node, {"image": 0.5 * picture})
    np.testing.assert_allclose(half, 0.5 * out, atol=1e-5)


def test_grays_stay(run):
    gray = np.repeat(np.linspace(0.0, 4.0, 30, dtype=np.float32)[None, :, None], 4, -1)
    node = HueCurves(hue_by_hue=(0.0, 0.3, 1.0, 0.3), light_by_hue=(0.0, 0.0, 1.0, 0.0))
    np.testing.assert_allclose(run(node, {"image": gray}), gray, atol=1e-5)


def balance_plainly(rgb: np.ndarray, node: ColorBalance) -> np.ndarray:
    """Blender's Color Balance (lift, gamma, gain), by its source: node_composite_colorbalance, in 64 bits."""
    lift, gamma, gain = (np.array(color[:3]) for color in (node.lift, node.gamma, node.gain))
    code = np.where(rgb < 0.0031308, np.maximum(rgb * 12.92, 0.0), 1.055 * np.maximum(rgb, 1e-9) ** (1 / 2.4) - 0.055)
    code = np.maximum(((code - 1.0) * (2.0 - lift) + 1.0) * gain, 0.0)
    light = np.where(code < 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
    return light ** (1.0 / gamma)


WHEELS = {"lift": (1.1, 0.95, 0.9, 1.0), "gamma": (0.9, 1.1, 1.3, 1.0), "gain": (1.2, 1.0, 0.8, 1.0)}


def test_wheels_are_those_of_blender(run):
    picture = make_colors()
    node = ColorBalance(**WHEELS)
    expected = balance_plainly(picture[..., :3].astype(np.float64), node)
    np.testing.assert_allclose(run(node, {"image": picture})[..., :3], expected, atol=2e-5)


@pytest.mark.parametrize("part", ["shadows", "midtones", "highlights"])
def test_a_range_changes_alone(run, part):
    tones = np.linspace(0.0, 1.0, 101)
    light = np.where(tones <= 0.04045, tones / 12.92, ((tones + 0.055) / 1.055) ** 2.4)
    picture = np.ones((1, 101, 4), np.float32)
    picture[..., :3] = light[None, :, None]
    parts = dict.fromkeys(("shadows", "midtones", "highlights"), 0.0) | {part: 1.0}
    node = ColorBalance(**WHEELS, **parts, low=0.3, high=0.7, blend=0.2)
    out, whole = (run(item, {"image": picture}) for item in (node, ColorBalance(**WHEELS)))
    spans = {"shadows": (-1.0, 0.2), "midtones": (0.4, 0.6), "highlights": (0.8, 2.0)}
    for name, (low, high) in spans.items():
        inside = (tones >= low) & (tones <= high)
        expected = whole if name == part else picture
        np.testing.assert_allclose(out[0, inside], expected[0, inside], atol=2e-5)
    weights = run(node.with_values(show="ranges"), {"image": picture})[0, :, :3]
    np.testing.assert_allclose(weights.sum(-1), 1.0, atol=1e-6)
