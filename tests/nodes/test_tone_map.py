"""Tone Map against the papers' formulas in double precision, OpenCV's Drago, OpenColorIO's ACES and Blender's AgX."""

from __future__ import annotations

from pathlib import Path
from typing import get_args, get_type_hints

import cv2
import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.tone.tone_map import ToneMap
from tone_operators import (
    FORMULAS,
    LUMINANCE_OPERATORS,
    OPERATORS,
    PER_CHANNEL,
    WEIGHTS,
    agx,
    logarithmic,
    lottes,
    scene,
    srgb,
    statistics,
    uchimura,
)


@pytest.mark.parametrize("operator", LUMINANCE_OPERATORS)
def test_luminance_operators_are_the_papers(run, operator):
    image = scene()
    measured = statistics(image)
    rgb = image[..., :3].astype(np.float64)
    light = np.maximum(rgb @ WEIGHTS, 1e-12)
    expected = rgb * (FORMULAS[operator](light, **measured, key=0.3, bias=0.7) / light)[..., None]
    out = run(ToneMap(operator=operator, key=0.3, bias=0.7, clip=False, **measured), {"image": image})
    assert (np.abs(out[..., :3] - expected) / np.maximum(1.0, expected)).max() < 2e-6
    clipped = run(ToneMap(operator=operator, key=0.3, bias=0.7, **measured), {"image": image})
    assert np.array_equal(clipped[..., :3], out[..., :3].clip(0, 1))


@pytest.mark.parametrize("operator", PER_CHANNEL)
def test_channel_operators_are_the_published_formulas(run, operator):
    image = scene(1)
    expected = PER_CHANNEL[operator](image[..., :3].astype(np.float64))
    out = run(ToneMap(operator=operator, clip=False), {"image": image})
    assert np.abs(out[..., :3] - expected).max() < 2e-6


def test_unsquared_goes_beyond_white(run):
    """With a white of 4 times the key's white it reaches 2 * 4 / 5."""
    image = np.array([[[4.0, 4.0, 4.0, 1.0]]], np.float32)
    node = ToneMap(operator="reinhard unsquared", maximum=4.0, clip=False)
    assert run(node, {"image": image})[0, 0, :3] == pytest.approx(1.6, abs=1e-6)


@pytest.mark.parametrize(("q", "k"), [(4.0, 1.0), (1.0, 3.0), (20.0, 0.5)])
def test_logarithmic_has_two_factors(run, q, k):
    image = scene(9)
    rgb = image[..., :3].astype(np.float64)
    light = np.maximum(rgb @ WEIGHTS, 1e-12)
    expected = rgb * (logarithmic(light, 0.18, 5.0, q=q, k=k) / light)[..., None]
    node = ToneMap(operator="logarithmic", maximum=5.0, q=q, k=k, clip=False)
    out = run(node, {"image": image})[..., :3]
    assert (np.abs(out - expected) / np.maximum(1.0, expected)).max() < 2e-6


@pytest.mark.parametrize("nits", [0.01, 1.0, 100.0, 1e4])
def test_auto_key_follows_the_luminance_of_the_scene(run, nits):
    """Krawczyk et al. 2005; a key of 0.161 at 1 cd/m2 and 0.531 at 100 cd/m2."""
    key = 1.03 - 2 / (2 + np.log10(0.4 * nits + 1))
    image = scene(10)
    for operator in ("reinhard", "exponential"):
        auto = run(ToneMap(operator=operator, auto_key=True, nits=nits, average=0.4), {"image": image})
        fixed = run(ToneMap(operator=operator, key=key, average=0.4), {"image": image})
        assert np.abs(auto - fixed).max() < 1e-6
    known = {1.0: 0.161, 100.0: 0.531}
    for average, wanted in known.items():
        light = np.full((1, 1, 4), average, np.float32)
        light[..., 3] = 1.0
        node = ToneMap(operator="reinhard", auto_key=True, nits=1.0, average=average)
        assert run(node, {"image": light})[0, 0, 0] == pytest.approx(wanted / (1 + wanted), abs=5e-4)


@pytest.mark.parametrize("contrast", [0.6, 1.4])
def test_contrast_is_the_published_parameter(run, contrast):
    image = scene(11)
    rgb = image[..., :3].astype(np.float64)
    for operator, expected in (
        ("uchimura", uchimura(rgb, contrast)),
        ("lottes", lottes(rgb, 1.6 * contrast, 8.0)),
    ):
        node = ToneMap(operator=operator, contrast=contrast, maximum=8.0, clip=False)
        assert np.abs(run(node, {"image": image})[..., :3] - expected).max() < 2e-6


def test_uchimura_leaves_the_midtones(run):
    """Its straight section is 40 % of the way from 0.22 to 1."""
    ramp = np.linspace(0.22, 0.22 + 0.4 * 0.78, 50, dtype=np.float32)
    image = np.stack([ramp, ramp, ramp, np.ones_like(ramp)], -1)[None]
    assert np.abs(run(ToneMap(operator="uchimura"), {"image": image}) - image).max() < 1e-6


def test_agx_is_the_published_algorithm(run):
    image = scene(2)
    expected = agx(image[..., :3].astype(np.float64))
    assert np.abs(run(ToneMap(operator="agx"), {"image": image})[..., :3] - expected).max() < 5e-6


BLENDER_AGX = [
    ((0.18, 0.18, 0.18), (0.4613, 0.4613, 0.4613)),
    ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    ((1.0, 1.0, 1.0), (0.7710, 0.7710, 0.7710)),
    ((16.0, 16.0, 16.0), (0.9985, 0.9985, 0.9985)),
    ((0.02, 0.02, 0.02), (0.1250, 0.1250, 0.1250)),
    ((0.8, 0.2, 0.1), (0.7778, 0.4924, 0.3888)),
    ((0.1, 0.6, 0.2), (0.4604, 0.6893, 0.5047)),
    ((4.0, 1.0, 0.5), (0.9476, 0.7757, 0.7229)),
    ((0.5, 2.0, 6.0), (0.7791, 0.8587, 0.9601)),
    ((12.0, 9.0, 2.0), (0.9880, 0.9622, 0.8943)),
    ((0.01, 0.03, 0.02), (0.0731, 0.1593, 0.1253)),
    ((2.0, 0.3, 0.3), (0.8985, 0.6282, 0.6124)),
]
"""Linear Rec.709 and what Blender 5.0.1 shows for it: OpenImageIO's ociodisplay, display sRGB, view AgX."""


def test_agx_looks_like_blenders(run):
    """Blender interpolates a table of 37^3, hence 0.005."""
    image = np.array([[(*rgb, 1.0) for rgb, _ in BLENDER_AGX]], np.float32)
    shown = srgb(run(ToneMap(operator="agx"), {"image": image})[0, :, :3])
    assert np.abs(shown - [seen for _, seen in BLENDER_AGX]).max() < 5e-3


def test_drago_is_opencvs_up_to_its_normalization(run):
    """OpenCV stretches the input and the output of Drago's formula to 0..1; on gray its luminance is ours."""
    gray = 2.0 ** np.random.default_rng(3).uniform(-6, 6, (30, 40)).astype(np.float32)
    gray = (gray - gray.min()) / (gray.max() - gray.min())
    image = np.repeat(gray[..., None], 3, -1)
    reference = cv2.createTonemapDrago(1.0, 1.0, 0.85).process(image)[..., 0]
    average = float(np.exp(np.log(np.maximum(gray, 1e-4).astype(np.float64)).mean()))
    rgba = np.concatenate([image, np.ones_like(image[..., :1])], -1)
    node = ToneMap(operator="drago", average=average, maximum=float(gray.max()), clip=False)
    out = run(node, {"image": rgba})[..., 0]
    lit = np.isfinite(reference) & (gray > 0)  # its black pixel is NaN
    # OpenCV's smallest output is black's, which is 0 in ours too; its largest is the maximum's.
    assert lit.sum() > 1000
    fit = np.polyfit(out[lit], reference[lit], 1)
    assert np.abs(np.polyval(fit, out[lit]) - reference[lit]).max() < 1e-5


@pytest.mark.parametrize(("operator", "mean", "high"), [("aces", 0.006, 0.04), ("aces narkowicz", 0.03, 0.15)])
def test_aces_is_close_to_the_reference_transform(run, operator, mean, high):
    """The fits against the ACES 1.3 SDR output transform of OpenColorIO's built-in config, display-encoded."""
    image = scene(4, -6.0, 5.0)
    config = "ocio://cg-config-v1.0.0_aces-v1.3_ocio-v2.1"
    source = oiio.ImageBuf(oiio.ImageSpec(image.shape[1], image.shape[0], 4, "float"))
    source.set_pixels(oiio.ROI.All, image)
    reference = oiio.ImageBufAlgo.ociodisplay(
        source, "sRGB - Display", "ACES 1.0 - SDR Video", fromspace="Linear Rec.709 (sRGB)", colorconfig=config
    )
    assert not reference.has_error, reference.geterror()
    shown = srgb(run(ToneMap(operator=operator), {"image": image})[..., :3])
    error = np.abs(shown - reference.get_pixels("float")[..., :3])
    assert error.mean() < mean and np.percentile(error, 99) < high


@pytest.mark.parametrize(
    ("operator", "white"),
    [
        ("reinhard extended", 16.0),
        ("logarithmic", 16.0),
        ("drago", 16.0),
        ("hable", 5.6),
        ("lottes", 16.0),
    ],
)
def test_white_becomes_white(run, operator, white):
    image = np.array([[[white, white, white, 1.0]]], np.float32)
    assert run(ToneMap(operator=operator, maximum=16.0, clip=False), {"image": image}) == pytest.approx(1.0, abs=2e-6)


@pytest.mark.parametrize("operator", OPERATORS)
def test_more_light_is_never_darker(run, operator):
    gray = np.geomspace(1e-5, 16.0, 4000, dtype=np.float32)
    image = np.stack([gray, gray, gray, np.ones_like(gray)], -1)[None]
    out = run(ToneMap(operator=operator), {"image": image})[0, :, :3]
    assert np.diff(out, axis=0).min() > -1e-6
    assert out.min() >= 0.0 and out.max() <= 1.0


@pytest.mark.parametrize("operator", OPERATORS)
def test_black_stays_black(run, operator):
    image = np.array([[[0.0, 0.0, 0.0, 1.0]]], np.float32)
    # Hill's fit is -3.8e-4 at black, which the clip takes off.
    assert np.abs(run(ToneMap(operator=operator), {"image": image})[0, 0, :3]).max() < 1e-6


@pytest.mark.parametrize("operator", OPERATORS)
def test_exposure_multiplies_light_first(run, operator):
    image = scene(5)
    brighter = image * np.float32([4, 4, 4, 1])
    one = run(ToneMap(operator=operator, exposure=2.0), {"image": image})
    assert np.abs(one - run(ToneMap(operator=operator), {"image": brighter})).max() < 1e-6


@pytest.mark.parametrize("operator", OPERATORS)
def test_coverage_does_not_change_the_color(run, operator):
    whole = scene(6)
    out = run(ToneMap(operator=operator), {"image": whole * np.float32(0.5)})
    assert np.abs(out - run(ToneMap(operator=operator), {"image": whole}) * 0.5).max() < 1e-6


@pytest.mark.parametrize("operator", LUMINANCE_OPERATORS)
def test_saturation_is_a_power_of_channel_ratios(run, operator):
    image = scene(7)[1:]
    plain = run(ToneMap(operator=operator, clip=False), {"image": image})[..., :3]
    half = run(ToneMap(operator=operator, saturation=0.5, clip=False), {"image": image})[..., :3]
    light, shown = image[..., :3] @ WEIGHTS, plain @ WEIGHTS
    expected = np.sqrt(image[..., :3] / light[..., None]) * shown[..., None]
    assert (np.abs(half - expected) / np.maximum(1.0, expected)).max() < 1e-5
    gray = run(ToneMap(operator=operator, saturation=0.0, clip=False), {"image": image})[..., :3]
    assert np.abs(gray - gray[..., :1]).max() < 1e-6


def test_statistics_may_be_measured_numbers(run):
    image = scene(8)
    measured = statistics(image)
    linked = {"image": image} | {name: np.full((1, 1), value, np.float32) for name, value in measured.items()}
    for operator in LUMINANCE_OPERATORS:
        fixed = run(ToneMap(operator=operator, **measured), {"image": image})
        assert np.array_equal(run(ToneMap(operator=operator), linked), fixed)


def test_every_operator_is_tested():
    hint = get_type_hints(ToneMap)["operator"]
    assert {*FORMULAS, *PER_CHANNEL, "agx"} == set(get_args(hint))


# --- the authors' own programs ---------------------------------------------------------------------------------------

PFSTMO = np.load(Path(__file__).parents[1] / "data" / "pfstmo.npz")
DELTAS = {"reinhard": 1e-5, "drago": 1e-4}
"""What each program adds to luminance before the logarithm."""


@pytest.mark.parametrize(("kind", "wanted"), [("gray", 2e-6), ("color", 5e-4)])
@pytest.mark.parametrize(("program", "operator"), [("reinhard", "reinhard extended"), ("drago", "drago")])
def test_it_is_what_pfstmo_makes(run, program, operator, kind, wanted):
    """See data/make_pfstmo.py. Colors differ in the fourth digit, because pfstmo's luminance weights do."""
    rgb = PFSTMO[kind]
    light = rgb.astype(np.float64) @ WEIGHTS
    average = float(np.exp(np.log(DELTAS[program] + light).mean()))
    node = ToneMap(operator=operator, key=0.18, average=average, maximum=float(light.max()), bias=0.85, clip=False)
    image = np.concatenate([rgb, np.ones_like(rgb[..., :1])], -1)
    np.testing.assert_allclose(run(node, {"image": image})[..., :3], PFSTMO[f"{program}_{kind}"], rtol=0, atol=wanted)
