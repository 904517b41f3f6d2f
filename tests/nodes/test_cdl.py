"""The color decision list against OpenColorIO."""

from __future__ import annotations

import numpy as np
import PyOpenColorIO as ocio
import pytest
from halation.nodes.color.cdl import Cdl

STYLES = {"no clamp": ocio.CDL_NO_CLAMP, "asc": ocio.CDL_ASC}
SLOPE, OFFSET, POWER = (1.3, 0.9, 0.7, 1.0), (0.05, -0.02, 0.01, 0.0), (1.2, 0.8, 2.2, 1.0)


def reference(picture: np.ndarray, style: str, saturation: float) -> np.ndarray:
    transform = ocio.CDLTransform()
    transform.setSlope(SLOPE[:3])
    transform.setOffset(OFFSET[:3])
    transform.setPower(POWER[:3])
    transform.setSat(saturation)
    transform.setStyle(STYLES[style])
    processor = ocio.Config.CreateRaw().getProcessor(transform).getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS)
    out = np.ascontiguousarray(picture[..., :3], np.float32).reshape(-1, 3)
    processor.applyRGB(out)
    return out.reshape(*picture.shape[:2], 3)


def node(style: str, saturation: float) -> Cdl:
    return Cdl(style=style, slope=SLOPE, offset=OFFSET, power=POWER, saturation=saturation)


@pytest.mark.parametrize("style", Cdl.values["style"].choices)
@pytest.mark.parametrize("saturation", [0.0, 1.0, 1.7])
def test_it_is_opencolorios(run, style, saturation):
    """From shadows below black, where the power is skipped, to highlights of many stops."""
    rgb = 0.18 * 2 ** np.random.default_rng(4).uniform(-5, 5, (17, 23, 3))
    rgb[0] *= -1.0
    picture = np.concatenate([rgb, np.ones((17, 23, 1))], -1).astype(np.float32)
    expected = reference(picture, style, saturation)
    out = run(node(style, saturation), {"image": picture})
    assert (np.abs(out[..., :3] - expected) / np.maximum(np.abs(expected).max(-1, keepdims=True), 1.0)).max() < 2e-6
    assert np.all(out[..., 3] == 1.0)


@pytest.mark.parametrize("style", STYLES)
def test_coverage_does_not_change_the_color(run, hdr, style):
    picture = hdr(13, 9, opaque=True)
    whole = run(node(style, 1.5), {"image": picture})
    half = run(node(style, 1.5), {"image": picture * np.float32(0.5)})
    assert (np.abs(half - whole * 0.5) / np.maximum(np.abs(whole), 1.0)).max() < 2e-6
    assert not run(node(style, 1.5), {"image": np.zeros((1, 1, 4))}).any()


def test_neutral_values_vanish():
    assert Cdl().identity() == "image"
    assert Cdl(style="asc").identity() is None and Cdl(saturation=0.5).identity() is None
