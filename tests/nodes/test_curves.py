"""The Curves node against scipy's monotone cubic, and OpenColorIO's transfer functions."""

from __future__ import annotations

import numpy as np
import PyOpenColorIO as ocio
import pytest
from halation.nodes.color.curves import Curves
from scipy.interpolate import PchipInterpolator

POINTS = (0.1, 0.05, 0.3, 0.2, 0.5, 0.7, 0.55, 0.7, 0.9, 0.95)
RED = (0.0, 0.1, 1.0, 0.9)
BLUE = (0.0, 0.0, 0.2, 0.6, 1.0, 0.5)


def pchip(points: tuple[float, ...], x: np.ndarray) -> np.ndarray:
    """Scipy's curve, going on straight beyond its ends."""
    xs, ys = points[::2], points[1::2]
    curve = PchipInterpolator(xs, ys)
    slope = curve.derivative()
    inside = curve(x.clip(xs[0], xs[-1]))
    return inside + slope(xs[0]) * np.minimum(x - xs[0], 0) + slope(xs[-1]) * np.maximum(x - xs[-1], 0)


def coded(rgb: np.ndarray, space: str, direction: ocio.TransformDirection) -> np.ndarray:
    """OpenColorIO's encoding of light, or its inverse, in float32."""
    if space == "linear":
        return rgb
    out = np.ascontiguousarray(rgb, np.float32).reshape(-1, 3)
    if space == "display":
        transform = ocio.ExponentWithLinearTransform(
            gamma=(2.4, 2.4, 2.4, 1.0),
            offset=(0.055, 0.055, 0.055, 0.0),
            negativeStyle=ocio.NEGATIVE_MIRROR,
            direction=ocio.TRANSFORM_DIR_INVERSE
            if direction == ocio.TRANSFORM_DIR_FORWARD
            else ocio.TRANSFORM_DIR_FORWARD,
        )
        processor = ocio.Config.CreateRaw().getProcessor(transform)
    else:
        # Between spaces of the same primaries, so that only the curve is left.
        names = ("ACEScg", "ACEScct")
        names = names if direction == ocio.TRANSFORM_DIR_FORWARD else names[::-1]
        processor = ocio.Config.CreateFromBuiltinConfig("ocio://default").getProcessor(*names)
    processor.getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS).applyRGB(out)
    return out.reshape(rgb.shape).astype(np.float64)


def opaque(rgb: np.ndarray) -> np.ndarray:
    return np.concatenate([rgb, np.ones((*rgb.shape[:2], 1))], -1).astype(np.float32)


@pytest.mark.parametrize("space", ["linear", "display", "log"])
def test_it_is_scipys_curve_in_every_space(run, space):
    rgb = np.random.default_rng(2).uniform(-0.1, 1.6, (9, 31, 3))
    out = run(Curves(space=space, master=POINTS, red=RED, blue=BLUE), {"image": opaque(rgb)})
    code = coded(opaque(rgb)[..., :3].astype(np.float64), space, ocio.TRANSFORM_DIR_FORWARD)
    bent = pchip(POINTS, code)
    bent[..., 0], bent[..., 2] = pchip(RED, bent[..., 0]), pchip(BLUE, bent[..., 2])
    expected = coded(bent, space, ocio.TRANSFORM_DIR_INVERSE)
    # A curve's error is its slope times that of the encoding; in stops a rounding of 1e-7 is 1.2e-6 of the light.
    error = np.abs(out[..., :3] - expected) / np.maximum(np.abs(expected), 1.0)
    assert error.max() < {"linear": 1e-6, "display": 5e-6, "log": 2e-5}[space]


def test_from_two_points_to_seventeen(run):
    rng = np.random.default_rng(8)
    x = np.linspace(-0.5, 1.5, 201)
    for count in (2, 3, 16, 17):
        ys = rng.uniform(0, 1, count)
        points = tuple(float(part) for pair in zip(np.linspace(0, 1, count), ys, strict=True) for part in pair)
        out = run(Curves(space="linear", master=points), {"image": opaque(np.repeat(x[None, :, None], 3, 2))})
        expected = pchip(points, x.astype(np.float32).astype(np.float64))
        assert np.abs(out[0, :, 0] - expected).max() < 1e-5


def test_keeping_the_color_bends_brightness_alone(run, hdr):
    picture = hdr(17, 9, opaque=True)
    out = run(Curves(space="linear", keep_color=True, master=POINTS), {"image": picture}).astype(np.float64)
    weights = np.array([0.2126, 0.7152, 0.0722])
    light = picture[..., :3].astype(np.float64) @ weights
    wanted = pchip(POINTS, light)
    lit = light > 1e-3
    assert (np.abs(out[..., :3] @ weights - wanted) / np.maximum(wanted, 1.0))[lit].max() < 2e-6
    ratio = out[..., :3] / np.maximum(picture[..., :3], 1e-9)
    spread = np.ptp(np.where(picture[..., :3] > 1e-4, ratio, ratio[..., 1:2]), axis=-1)
    assert (spread / np.abs(ratio[..., 1]))[lit & (picture[..., 1] > 1e-4)].max() < 1e-5


def test_coverage_does_not_change_the_color(run, hdr):
    picture = hdr(9, 7, opaque=True)
    node = Curves(master=POINTS)
    half = run(node, {"image": picture * np.float32(0.5)})
    assert np.abs(half - run(node, {"image": picture}) * 0.5).max() < 1e-4
    assert not run(node, {"image": np.zeros((1, 1, 4))}).any()


def test_straight_curves_vanish(run, hdr):
    assert Curves().identity() == "image"
    assert Curves(red=(0.0, 0.0, 0.5, 0.6, 1.0, 1.0)).identity() is None
    picture = hdr(9, 7, opaque=True)
    straight = Curves(green=(0.0, 0.0, 0.5, 0.5, 1.0, 1.0), space="linear")
    assert np.abs(run(straight, {"image": picture}) - picture).max() < 2e-6 * max(1.0, picture.max())
