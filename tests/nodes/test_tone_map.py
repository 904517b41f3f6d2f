"""Tone Map against the papers' formulas in double precision, OpenCV's Drago, OpenColorIO's ACES and Blender's AgX."""

from __future__ import annotations

from pathlib import Path
from typing import get_args, get_type_hints

import cv2
import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.tone.tone_map import ToneMap

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
LUMINANCE_OPERATORS = (
    "reinhard",
    "reinhard extended",
    "reinhard unsquared",
    "exponential",
    "logarithmic",
    "drago",
)
OPERATORS = ToneMap.values["operator"].choices


def scene(seed: int = 0, low: float = -8.0, high: float = 6.0) -> np.ndarray:
    """Opaque light over many stops around middle gray, from muted to saturated, with a black pixel."""
    random = np.random.default_rng(seed)
    rgb = 0.18 * 2 ** random.uniform(low, high, (40, 50, 1)) * (0.2 + 3 * random.dirichlet([1, 1, 1], (40, 50)))
    rgb[0, 0] = 0.0
    return np.concatenate([rgb, np.ones((40, 50, 1))], -1).astype(np.float32)


def srgb(light: np.ndarray) -> np.ndarray:
    light = np.clip(light, 0.0, 1.0)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def statistics(image: np.ndarray) -> dict[str, float]:
    light = image[..., :3].astype(np.float64) @ WEIGHTS
    return {"average": float(np.exp(np.log(1e-5 + light).mean())), "maximum": float(light.max())}


# --- the formulas of the papers ------------------------------------------------------------------------------------


def reinhard(light, average, maximum, key=0.18, bias=0.85):
    scaled = key / average * light
    return scaled / (1 + scaled)


def reinhard_extended(light, average, maximum, key=0.18, bias=0.85):
    scaled, white = key / average * light, key / average * maximum
    return scaled * (1 + scaled / white**2) / (1 + scaled)


def reinhard_unsquared(light, average, maximum, key=0.18, bias=0.85):
    scaled, white = key / average * light, key / average * maximum
    return scaled * (1 + scaled / white) / (1 + scaled)


def exponential(light, average, maximum, key=0.18, bias=0.85):
    return 1 - np.exp(-light / (average / key))


def logarithmic(light, average, maximum, key=0.18, bias=0.85, q=1.0, k=1.0):
    return np.log10(1 + q * light) / np.log10(1 + k * maximum)


def drago(light, average, maximum, key=0.18, bias=0.85):
    """Equation 4 with Ldmax = 100; world luminances are divided by the log-average."""
    world, top = light / average, maximum / average
    slope = np.log(2 + 8 * (world / top) ** (np.log(bias) / np.log(0.5)))
    return 100 * 0.01 / np.log10(top + 1) * np.log(world + 1) / slope


FORMULAS = dict(
    zip(
        LUMINANCE_OPERATORS,
        (reinhard, reinhard_extended, reinhard_unsquared, exponential, logarithmic, drago),
        strict=True,
    )
)


def hill(rgb):
    into = np.array([[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]])
    back = np.array([[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]])
    v = rgb @ into.T
    return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081) @ back.T


def neutral(rgb):
    """The Khronos specification, with its names."""
    start_compression, desaturation = 0.8 - 0.04, 0.15
    x = rgb.min(-1, keepdims=True)
    rgb = rgb - np.where(x < 0.08, x - 6.25 * x * x, 0.04)
    peak = rgb.max(-1, keepdims=True)
    d = 1 - start_compression
    new_peak = 1 - d * d / (np.maximum(peak, start_compression) + d - start_compression)
    g = 1 - 1 / (desaturation * (peak - new_peak) + 1)
    pressed = rgb * new_peak / np.maximum(peak, 1e-9)
    return np.where(peak < start_compression, rgb, pressed * (1 - g) + new_peak * g)


def hable(rgb):
    def curve(x):
        return (x * (0.15 * x + 0.10 * 0.50) + 0.20 * 0.02) / (x * (0.15 * x + 0.50) + 0.20 * 0.30) - 0.02 / 0.30

    return curve(2 * rgb) / curve(11.2)


PRIMARIES = {
    709: [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]],
    2020: [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]],
}


def to_xyz(space: int) -> np.ndarray:
    """The matrix that a color space's chromaticities and white D65 imply."""

    def xyz(chromaticity):
        x, y = chromaticity
        return np.array([x / y, 1.0, (1 - x - y) / y])

    columns = np.stack([xyz(primary) for primary in PRIMARIES[space]], -1)
    return columns * np.linalg.solve(columns, xyz((0.3127, 0.3290)))


def agx(rgb):
    """AgXBaseRec2020.py of Eary Chow's AgX_LUT_Gen: inset, log2, sigmoid, power 2.4, 40 % hue shift, outset."""
    inset = np.array(
        [
            [0.856627153315983, 0.0951212405381588, 0.0482516061458583],
            [0.137318972929847, 0.761241990602591, 0.101439036467562],
            [0.11189821299995, 0.0767994186031903, 0.811302368396859],
        ]
    )
    outset = np.linalg.inv(
        [
            [0.899796955911611, 0.0871996192028351, 0.013003424885555],
            [0.11142098895748, 0.875575586156966, 0.0130034248855548],
            [0.11142098895748, 0.0871996192028349, 0.801379391839686],
        ]
    )
    rec2020 = np.linalg.solve(to_xyz(2020), to_xyz(709))
    scene_referred = rgb @ rec2020.T @ inset.T
    stops = np.clip(np.log2(np.maximum(scene_referred, 1e-10) / 0.18), -10, 6.5)
    x, slope, power = (stops + 10) / 16.5, 2.4, 1.5
    pivot_x, pivot_y = 10 / 16.5, 0.18 ** (1 / 2.4)

    def branch(to_end_x, to_end_y):
        scale = ((slope * to_end_x) ** -power * ((slope * to_end_x / to_end_y) ** power - 1)) ** (-1 / power)
        term = slope * np.abs(x - pivot_x) / scale
        return scale * term / (1 + term**power) ** (1 / power)

    curved = np.where(x < pivot_x, pivot_y - branch(pivot_x, pivot_y), pivot_y + branch(1 - pivot_x, 1 - pivot_y))
    formed = np.maximum(curved, 0) ** 2.4
    before = cv2.cvtColor(scene_referred.astype(np.float32), cv2.COLOR_RGB2HSV)[..., 0] / 360.0
    hsv = cv2.cvtColor(formed.astype(np.float32), cv2.COLOR_RGB2HSV)
    turn = hsv[..., 0] / 360.0 - before
    hsv[..., 0] = (before + 0.4 * (turn - np.round(turn))) % 1.0 * 360.0
    formed = cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB).astype(np.float64)
    return np.clip(formed @ outset.T @ np.linalg.inv(rec2020).T, 0, 1)


def narkowicz(rgb):
    """The article's curve, after the 0.6 that its author says undoes its exposure."""
    x = 0.6 * rgb
    return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)


def uchimura(x, contrast=1.0):
    """The slides' equations: a linear section from `start` on, a toe of power 1.33, a shoulder up to 1."""
    top, start, share, toe_power = 1.0, 0.22, 0.4, 1.33
    length = (top - start) * share / contrast
    ends, height = start + length, start + contrast * length
    steepness = contrast * top / (top - height)
    t = np.clip(x / start, 0, 1)
    in_toe, in_shoulder = 1 - t * t * (3 - 2 * t), (x >= ends) * 1.0
    toe, linear = start * (x / start) ** toe_power, start + contrast * (x - start)
    shoulder = top - (top - height) * np.exp(-steepness * (x - ends) / top)
    return toe * in_toe + linear * (1 - in_toe - in_shoulder) + shoulder * in_shoulder


def lottes(x, a=1.6, hdr_max=16.0):
    """The slides' equations: contrast a, shoulder d, middle gray in and out; b and c solved from two points."""
    d, mid_in, mid_out = 0.977, 0.18, 0.267
    # mid_in^a = mid_out (mid_in^(a d) b + c) and hdr_max^a = hdr_max^(a d) b + c
    system = np.array([[mid_out * mid_in ** (a * d), mid_out], [hdr_max ** (a * d), 1.0]])
    b, c = np.linalg.solve(system, [mid_in**a, hdr_max**a])
    return x**a / (x ** (a * d) * b + c)


PER_CHANNEL = {
    "aces": hill,
    "aces narkowicz": narkowicz,
    "khronos neutral": neutral,
    "hable": hable,
    "uchimura": uchimura,
    "lottes": lottes,
}


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
