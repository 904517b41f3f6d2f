"""Color Space against OpenColorIO's own CPU path."""

from __future__ import annotations

import numpy as np
import PyOpenColorIO as ocio
import pytest
from halation.nodes.color._spaces import SPACES
from halation.nodes.color.color_space import ColorSpace


def reference(rgb: np.ndarray, source: str, target: str) -> np.ndarray:
    config = ocio.Config.CreateFromBuiltinConfig("ocio://studio-config-latest")
    out = np.array(rgb, np.float32).reshape(-1, 3)
    config.getProcessor(source, target).getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS).applyRGB(out)
    return out.reshape(rgb.shape)


def opaque(rgb: np.ndarray) -> np.ndarray:
    return np.concatenate([rgb, np.ones((*rgb.shape[:2], 1))], -1).astype(np.float32)


def stops(rng: np.random.Generator) -> np.ndarray:
    """Colors from 8 stops below middle gray to 6 above it."""
    return (0.18 * np.exp2(rng.uniform(-8, 6, (7, 23, 3)))).astype(np.float32)


@pytest.mark.parametrize("space", SPACES)
def test_there_and_back_is_opencolorio(run, space):
    light = stops(np.random.default_rng(3))
    codes = reference(light, "lin_rec709_scene", SPACES[space])
    out = run(ColorSpace(target=space), {"image": opaque(light)})[..., :3]
    assert (np.abs(out - codes) / np.maximum(np.abs(codes), 1.0)).max() < 5e-6
    # The inverse of a log multiplies what float32 rounds away of its code by the light.
    expected = reference(codes, SPACES[space], "lin_rec709_scene")
    back = run(ColorSpace(source=space, target="linear rec709"), {"image": opaque(codes)})[..., :3]
    assert (np.abs(back - expected) / np.maximum(np.abs(expected).max(-1, keepdims=True), 1.0)).max() < 1e-4


def test_published_numbers(run):
    """White and middle gray in other encodings: ARRI LogC4 specification (2022), ACES S-2016-001, SMPTE ST 2084."""
    gray = opaque(np.full((1, 1, 3), 0.18))
    for space, code in (("arri logc4", 0.2784), ("acescct", 0.4135884), ("sony s-log3", 420 / 1023)):
        assert np.abs(run(ColorSpace(target=space), {"image": gray})[0, 0, :3] - code).max() < 1e-4
    white = opaque(np.ones((1, 1, 3)))
    assert np.abs(run(ColorSpace(target="rec2100 pq"), {"image": white})[0, 0, :3] - 0.508078).max() < 1e-4


def test_coverage_does_not_change_the_color(run):
    light = opaque(stops(np.random.default_rng(4)))
    half = run(ColorSpace(target="acescct"), {"image": light * np.float32(0.5)})
    assert np.abs(half - run(ColorSpace(target="acescct"), {"image": light}) * 0.5).max() < 1e-5
    glow = np.array([[[0.2, 0.1, 0.05, 0.0]]], np.float32)
    expected = reference(glow[..., :3], "lin_rec709_scene", "lin_ap1_scene")
    assert np.abs(run(ColorSpace(), {"image": glow})[..., :3] - expected).max() < 1e-6


def test_the_same_space_is_neutral():
    assert ColorSpace(target="working").identity() == "image" and ColorSpace().identity() is None
