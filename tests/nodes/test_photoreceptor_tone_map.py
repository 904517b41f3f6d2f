"""Photoreceptor Tone Map against OpenCV's Reinhard-Devlin and the paper's formula in double precision."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.tone.photoreceptor_tone_map import PhotoreceptorToneMap

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
OPENCV_WEIGHTS = np.array([0.299, 0.587, 0.114])


def scene(hdr, width=41, height=29):
    """Opaque light without black."""
    picture = hdr(width, height, opaque=True)
    picture[..., :3] = np.maximum(picture[..., :3], 2e-4)
    return picture


def formula(rgb, brightness=0.0, contrast=0.0, light=0.5, chroma=0.0, stretch=True, weight=None):
    """The paper's equations 1 to 6; the last step is the normalization of its program."""
    rgb = rgb.astype(np.float64)
    luma = rgb @ WEIGHTS
    weight = np.ones_like(luma) if weight is None else weight
    dim = np.log(np.maximum(luma, 1e-4))
    kept = dim[weight > 0]
    key = (kept.max() - np.average(dim, weights=weight)) / (kept.max() - kept.min())
    m = contrast or 0.3 + 0.7 * key**1.4
    mean = np.array([np.average(rgb[..., i], weights=weight) for i in range(3)])
    own = chroma * rgb + (1 - chroma) * luma[..., None]
    others = chroma * mean + (1 - chroma) * (mean @ WEIGHTS)
    out = rgb / (rgb + (np.exp(-brightness) * (light * own + (1 - light) * others)) ** m)
    low, high = out[weight > 0].min(), out[weight > 0].max()
    return (out - low) / (high - low) if stretch else out


@pytest.mark.parametrize("light", [0.0, 0.6, 1.0])
@pytest.mark.parametrize("chroma", [0.0, 0.5, 1.0])
@pytest.mark.parametrize(
    ("brightness", "contrast", "stretch"), [(0.0, 0.0, True), (1.5, 0.0, False), (-1.0, 0.8, True)]
)
def test_it_is_the_papers_formula(run, hdr, light, chroma, brightness, contrast, stretch):
    picture = scene(hdr)
    node = PhotoreceptorToneMap(
        brightness=brightness, contrast=contrast, light_adaptation=light, color_adaptation=chroma, stretch=stretch
    )
    expected = formula(picture[..., :3], brightness, contrast, light, chroma, stretch)
    assert np.abs(run(node, {"image": picture})[..., :3] - expected).max() < 3e-6


@pytest.mark.parametrize(("brightness", "light", "chroma"), [(0.0, 1.0, 0.0), (0.5, 0.3, 0.0), (-1.0, 0.7, 0.8)])
def test_it_is_opencvs(run, brightness, light, chroma):
    """OpenCV weighs luminance differently, so the colors are of the plane where both kinds of weights agree.

    OpenCV first stretches the picture to 0..1; this one fills that range already.
    """
    random = np.random.default_rng(2)
    gray = np.exp(random.uniform(np.log(2e-3), np.log(0.6), (31, 43, 1)))
    alike = np.cross(WEIGHTS - OPENCV_WEIGHTS, np.ones(3))
    rgb = gray * (1 + random.uniform(-3.0, 3.0, gray.shape) * alike)
    rgb[0, 0] = 0.01 * (1 - alike / alike[2])  # without blue, but not black, which is 0 / 0 in OpenCV
    rgb[5, 5] = 1.0
    assert np.abs(rgb @ (WEIGHTS - OPENCV_WEIGHTS)).max() < 1e-12 and rgb.min() == 0.0 and rgb.max() == 1.0
    picture = np.concatenate([rgb, np.ones_like(gray)], -1).astype(np.float32)
    reference = cv2.createTonemapReinhard(1.0, brightness, light, chroma).process(picture[..., :3].copy())
    node = PhotoreceptorToneMap(brightness=brightness, light_adaptation=light, color_adaptation=chroma)
    found = run(node, {"image": picture})[..., :3]
    assert np.abs(found - reference).max() < 5e-6


def test_what_is_empty_does_not_count(run, hdr):
    picture = scene(hdr)
    alpha = np.random.default_rng(4).random(picture.shape[:2])
    alpha[:, :9] = 0.0
    covered = picture.copy()
    covered[..., :3] *= alpha[..., None]
    covered[..., 3] = alpha
    found = run(PhotoreceptorToneMap(), {"image": covered})
    straight = covered[:, 9:, :3].astype(np.float64) / covered[:, 9:, 3:]
    expected = formula(straight, weight=covered[:, 9:, 3].astype(np.float64))
    assert np.abs(found[:, 9:, :3] - expected * covered[:, 9:, 3:]).max() < 5e-6
    assert np.array_equal(found[..., 3], covered[..., 3])


def test_color_adaptation_takes_a_cast_away(run):
    """Fully adapted to the colored average alone, with m = 1, a cast of the light leaves no trace."""
    gray = np.random.default_rng(5).uniform(0.05, 3.0, (9, 13, 1))
    white = np.concatenate([gray, gray, gray, np.ones_like(gray)], -1).astype(np.float32)
    node = PhotoreceptorToneMap(light_adaptation=0.0, color_adaptation=1.0, contrast=1.0)
    warm = run(node, {"image": white * np.float32([1.5, 1.0, 0.5, 1.0])})
    assert np.abs(warm - run(node, {"image": white})).max() < 2e-6


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (5, 3)])
def test_flat_and_tiny_pictures(run, size):
    """Nothing to stretch: C / (C + C^m) with m = 0.3."""
    picture = np.full((*size, 4), 0.4, np.float32)
    picture[..., 3] = 1.0
    found = run(PhotoreceptorToneMap(light_adaptation=1.0), {"image": picture})[..., :3]
    assert np.abs(found - 0.4 / (0.4 + 0.4**0.3)).max() < 1e-6


def test_black_stays_black(run):
    picture = np.zeros((4, 5, 4), np.float32)
    assert not run(PhotoreceptorToneMap(), {"image": picture}).any()
    picture[..., 3] = 1.0
    assert not run(PhotoreceptorToneMap(), {"image": picture})[..., :3].any()
