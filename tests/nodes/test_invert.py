"""Invert against OpenImageIO and the sRGB transfer function."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.color.invert import Invert
from oiio_pictures import make_buffer

SPACES = Invert.values["space"].choices


def srgb_encode(linear: np.ndarray) -> np.ndarray:
    light = np.abs(linear.astype(np.float64))
    return np.sign(linear) * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def test_linear_is_that_of_openimageio(run, hdr):
    picture = hdr(21, 14, opaque=True)
    expected = oiio.ImageBufAlgo.invert(make_buffer(picture), oiio.ROI(0, 21, 0, 14, 0, 1, 0, 3)).get_pixels("float")
    np.testing.assert_array_equal(run(Invert(space="linear"), {"image": picture})[..., :3], expected[..., :3])


def test_display_codes_add_up_to_one(run, hdr):
    picture = hdr(21, 14, opaque=True)
    out = run(Invert(), {"image": picture})[..., :3]
    codes = srgb_encode(out) + srgb_encode(picture[..., :3])
    assert (np.abs(codes - 1.0) / np.maximum(1.0, srgb_encode(picture[..., :3]))).max() < 2e-6


def test_stops_are_mirrored_about_middle_gray(run):
    stops = np.linspace(-8, 8, 33)
    light = (0.18 * 2.0**stops).astype(np.float32)
    out = run(Invert(space="stops"), {"image": np.stack([light, light, light, light * 0 + 1], -1)[None]})
    assert np.abs(np.log2(out[0, :, 0] / 0.18) + stops).max() < 2e-6


@pytest.mark.parametrize("space", SPACES)
def test_the_negative_of_the_negative_is_the_picture(run, space):
    rgb = np.random.default_rng(1).uniform(0.01, 4.0, (9, 11, 3))
    picture = np.concatenate([rgb, np.ones((9, 11, 1))], -1).astype(np.float32)
    twice = run(Invert(space=space), {"image": run(Invert(space=space), {"image": picture})})
    assert np.abs(twice - picture).max() < 5e-6


@pytest.mark.parametrize("space", SPACES)
def test_coverage_stays_and_does_not_change_the_color(run, hdr, space):
    picture = hdr(13, 9, opaque=True)
    half = run(Invert(space=space), {"image": picture * np.float32(0.5)})
    whole = run(Invert(space=space), {"image": picture})
    assert (np.abs(half - whole * 0.5) / np.maximum(np.abs(whole), 1.0)).max() < 2e-6
    glow = np.array([[[0.5, 0.25, 0.0, 0.0]]], np.float32)
    np.testing.assert_array_equal(run(Invert(space=space), {"image": glow}), glow)


def test_a_mask_mixes(run, hdr):
    picture, mask = hdr(13, 9), np.random.default_rng(2).random((9, 13)).astype(np.float32)
    whole = run(Invert(), {"image": picture})
    out = run(Invert(), {"image": picture, "amount": mask})
    expected = picture + (whole - picture) * mask[..., None]
    assert (np.abs(out - expected) / np.maximum(np.abs(picture), 1.0)).max() < 2e-6
    assert Invert(amount=0.0).identity() == "image"
