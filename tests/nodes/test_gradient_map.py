"""Gradient Map against OpenImageIO's color maps and numpy."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes import ramp_at
from halation.nodes.color.gradient_map import GradientMap
from oiio_pictures import make_buffer


def gray(light: np.ndarray) -> np.ndarray:
    """A row of opaque grays."""
    return np.stack([light, light, light, np.ones_like(light)], -1)[None].astype(np.float32)


@pytest.mark.parametrize("palette", ["inferno", "viridis", "magma", "plasma", "turbo"])
def test_palettes_are_those_of_openimageio(run, palette):
    light = np.linspace(-0.25, 1.25, 301)
    out = run(GradientMap(palette=palette, scale="linear", low=0.0, high=1.0), {"image": gray(light)})
    expected = oiio.ImageBufAlgo.color_map(
        make_buffer(light.clip(0, 1).astype(np.float32)[None, :, None]), 0, palette
    ).get_pixels("float")
    assert np.abs(out[0, :, :3] - expected[0]).max() < 1e-5
    assert (out[..., 3] == 1).all()


STOPS = (0.1, 1.0, 0.0, 0.0, 1.0, 0.4, 0.0, 2.0, 0.0, 0.5, 0.4, 0.3, 0.0, 0.0, 1.0, 0.9, 0.0, 0.0, 4.0, 0.0)


@pytest.mark.parametrize("smooth", [False, True])
@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("scale", ["linear", "display", "stops"])
def test_a_ramp_of_ones_own(run, scale, reverse, smooth):
    light = np.geomspace(1e-4, 20.0, 83).astype(np.float32).astype(np.float64)
    srgb = np.vectorize(lambda x: 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055)
    scaled = {"linear": lambda x: np.asarray(x), "display": srgb, "stops": np.log2}[scale]
    t = ((scaled(light) - scaled(0.02)) / (scaled(8.0) - scaled(0.02))).clip(0, 1)
    t = 1 - t if reverse else t
    expected = np.array([ramp_at(STOPS, x, smooth) for x in t])
    expected[:, :3] *= expected[:, 3:]
    node = GradientMap(palette="ramp", ramp=STOPS, scale=scale, low=0.02, high=8.0, reverse=reverse, smooth=smooth)
    clear = np.abs(t - 0.4) > 1e-5  # two stops at one place: a step
    assert np.abs(run(node, {"image": gray(light)})[0] - expected)[clear].max() < 2e-5


def test_seventeen_stops_and_two(run):
    rng = np.random.default_rng(4)
    for count in (2, 17):
        places = np.linspace(0, 1, count)
        stops = tuple(float(x) for row in np.column_stack([places, rng.random((count, 4))]) for x in row)
        light = np.linspace(0, 1, 55)
        out = run(GradientMap(palette="ramp", ramp=stops, scale="linear", low=0.0, high=1.0), {"image": gray(light)})[0]
        columns = np.array(stops).reshape(-1, 5)
        expected = np.stack([np.interp(light, columns[:, 0], columns[:, k]) for k in range(1, 5)], -1)
        expected[:, :3] *= expected[:, 3:]
        assert np.abs(out - expected).max() < 1e-6


def test_luminance_decides_and_coverage_does_not(run, hdr):
    picture = hdr(9, 7, opaque=True)
    light = picture[..., :3] @ np.array([0.2126, 0.7152, 0.0722], np.float32)
    same = np.concatenate([np.repeat(light[..., None], 3, -1), np.ones((*light.shape, 1), np.float32)], -1)
    node = GradientMap()
    assert np.abs(run(node, {"image": picture}) - run(node, {"image": same})).max() < 1e-5
    half = run(node, {"image": picture * np.float32(0.5)})
    assert np.abs(half - run(node, {"image": picture}) * 0.5).max() < 1e-5


def test_mixing(run, hdr):
    picture = hdr(9, 7, opaque=False)
    full, none = run(GradientMap(), {"image": picture}), picture
    assert np.abs(run(GradientMap(amount=0.25), {"image": picture}) - (0.25 * full + 0.75 * none)).max() < 1e-5
    assert GradientMap(amount=0.0).identity() == "image"
