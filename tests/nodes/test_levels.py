"""Levels against OpenImageIO, OpenColorIO and its formula."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import PyOpenColorIO as ocio
import pytest
from halation.nodes.color.levels import Levels
from oiio_pictures import make_buffer

VALUES = {"black": 0.05, "white": 0.8, "low": 0.1, "high": 1.5}


def assert_close(found: np.ndarray, expected: np.ndarray, wanted: float = 2e-6) -> None:
    assert (np.abs(found - expected) / np.maximum(np.abs(expected), 1.0)).max() < wanted


def test_straight_levels_are_openimageios_contrast_remap(run, hdr):
    picture = hdr(23, 17, opaque=True)
    expected = oiio.ImageBufAlgo.contrast_remap(make_buffer(picture), 0.05, 0.8, 0.1, 1.5).get_pixels("float")
    assert_close(run(Levels(**VALUES), {"image": picture})[..., :3], expected[..., :3])


def srgb(picture: np.ndarray, direction: ocio.TransformDirection) -> np.ndarray:
    curve = ocio.ExponentWithLinearTransform(
        gamma=(2.4, 2.4, 2.4, 1.0),
        offset=(0.055, 0.055, 0.055, 0.0),
        negativeStyle=ocio.NEGATIVE_MIRROR,
        direction=direction,
    )
    out = np.ascontiguousarray(picture[..., :3], np.float32).reshape(-1, 3)
    processor = ocio.Config.CreateRaw().getProcessor(curve)
    processor.getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS).applyRGB(out)
    return out.reshape(*picture.shape[:2], 3).astype(np.float64)


@pytest.mark.parametrize("space", ["linear", "display"])
@pytest.mark.parametrize("gamma", [0.5, 1.0, 2.2])
@pytest.mark.parametrize("clip", [False, True])
def test_it_is_the_formula(run, space, gamma, clip):
    rgb = np.random.default_rng(3).uniform(-0.2, 1.5, (9, 11, 3))
    picture = np.concatenate([rgb, np.ones((9, 11, 1))], -1).astype(np.float32)
    code = srgb(picture, ocio.TRANSFORM_DIR_INVERSE) if space == "display" else picture[..., :3].astype(np.float64)
    level = (code - 0.05) / 0.75
    level = level.clip(0, 1) if clip else level
    expected = np.where(level > 0, np.maximum(level, 0) ** (1 / gamma), level) * 1.4 + 0.1
    expected = srgb(expected, ocio.TRANSFORM_DIR_FORWARD) if space == "display" else expected
    out = run(Levels(space=space, gamma=gamma, clip=clip, **VALUES), {"image": picture})[..., :3]
    assert_close(out, expected, 1e-5)


def test_the_points_become_what_they_should(run):
    ends = np.array([[[0.05] * 3 + [1.0], [0.8] * 3 + [1.0]]], np.float32)
    for gamma in (0.4, 1.0, 3.0):
        out = run(Levels(gamma=gamma, **VALUES), {"image": ends})[0, :, 0]
        assert_close(out, np.array([0.1, 1.5]), 1e-6)


def test_swapping_the_points_undoes(run, hdr):
    picture = hdr(9, 7, opaque=True)
    there = run(Levels(gamma=2.0, **VALUES), {"image": picture})
    back = run(Levels(gamma=0.5, black=0.1, white=1.5, low=0.05, high=0.8), {"image": there})
    assert_close(back, picture, 2e-5)


def test_coverage_does_not_change_the_color(run, hdr):
    picture = hdr(9, 7, opaque=True)
    half = run(Levels(gamma=2.0, **VALUES), {"image": picture * np.float32(0.5)})
    assert_close(half, run(Levels(gamma=2.0, **VALUES), {"image": picture}) * 0.5)
    empty = run(Levels(gamma=2.0, **VALUES), {"image": np.zeros((1, 1, 4))})
    assert not empty.any()


def test_neutral_levels_vanish():
    assert Levels().identity() == "image" and Levels(clip=True).identity() is None
    assert Levels(black=0.5, white=0.5, low=0.5, high=0.5).identity() is None
