"""Exposure, Grade, Saturation, Vignette, Clip and Luminance against OpenImageIO, OpenColorIO and closed forms."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import PyOpenColorIO as ocio
import pytest
from halation.nodes.color.clip import Clip
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.grade import Grade
from halation.nodes.color.luminance import Luminance
from halation.nodes.color.saturation import Saturation
from halation.nodes.color.vignette import Vignette
from oiio_pictures import make_buffer

ALGO = oiio.ImageBufAlgo


def picture(seed: int = 0, opaque: bool = False, low: float = 0.0, size: tuple[int, int] = (24, 17)) -> np.ndarray:
    """Scene-linear pixels over ten stops, premultiplied."""
    random = np.random.default_rng(seed)
    rgb = 0.18 * 2 ** random.uniform(-5, 5, (size[1], size[0], 3)) + low
    alpha = np.ones((size[1], size[0], 1)) if opaque else random.uniform(0.05, 1.0, (size[1], size[0], 1))
    return np.concatenate([rgb * alpha, alpha], -1).astype(np.float32)


def relative(out: np.ndarray, expected: np.ndarray) -> float:
    return float((np.abs(out - expected) / np.maximum(np.abs(expected), 1.0)).max())


@pytest.mark.parametrize("stops", [-10.0, -1.0, 0.0, 0.5, 10.0])
def test_exposure_doubles_per_stop(run, stops):
    image = picture()
    expected = image.astype(np.float64) * ([2.0**stops] * 3 + [1.0])
    assert relative(run(Exposure(stops=stops), {"image": image}), expected) < 1e-6


def cdl(rgb: np.ndarray, slope, offset, power, saturation: float = 1.0) -> np.ndarray:
    """OpenColorIO's ASC CDL without clamping."""
    transform = ocio.CDLTransform()
    transform.setSlope(list(slope))
    transform.setOffset(list(offset))
    transform.setPower(list(power))
    transform.setSat(saturation)
    transform.setStyle(ocio.CDL_NO_CLAMP)
    processor = ocio.Config.CreateRaw().getProcessor(transform).getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS)
    out = np.ascontiguousarray(rgb, np.float32).copy()
    processor.applyRGB(out.reshape(-1, 3))
    return out


LIFT, GAMMA, GAIN, OFFSET = (
    (0.02, 0.0, -0.01, 0.0),
    (1.2, 0.8, 2.2, 1.0),
    (1.5, 1.0, 0.7, 1.0),
    (0.0, 0.05, 0.01, 0.0),
)


def test_grade_is_a_color_decision_list(run):
    """Slope gain - lift, offset lift + offset, power 1 / gamma; light above the toe, where OpenColorIO's power acts."""
    image = picture(opaque=True, low=0.1)
    lift, gamma, gain, offset = (np.array(value[:3]) for value in (LIFT, GAMMA, GAIN, OFFSET))
    out = run(Grade(lift=LIFT, gamma=GAMMA, gain=GAIN, offset=OFFSET), {"image": image})
    expected = cdl(image[..., :3], gain - lift, lift + offset, 1 / gamma)
    assert relative(out[..., :3], expected) < 1e-6
    assert np.array_equal(out[..., 3], image[..., 3])


def test_grade_moves_black_to_lift_and_white_to_gain(run):
    ends = np.array([[[0, 0, 0, 1], [1, 1, 1, 1]]], np.float32)
    out = run(Grade(lift=LIFT, gain=GAIN), {"image": ends})
    assert np.abs(out[0, 0, :3] - LIFT[:3]).max() < 1e-6
    assert np.abs(out[0, 1, :3] - GAIN[:3]).max() < 1e-6


def test_grade_leaves_empty_pixels_and_negative_light_alone(run):
    image = np.array([[[0, 0, 0, 0], [-0.5, -0.25, 0.25, 1]]], np.float32)
    assert np.all(run(Grade(lift=LIFT, offset=OFFSET), {"image": image})[0, 0] == 0.0)
    bent = run(Grade(gamma=(2.0, 2.0, 2.0, 1.0)), {"image": image})[0, 1]
    assert np.allclose(bent, [-0.5, -0.25, 0.5, 1.0], atol=1e-6)


def test_grade_by_a_mask(run):
    image, mask = picture(1), np.random.default_rng(2).uniform(0, 1, (17, 24)).astype(np.float32)
    full = run(Grade(gamma=GAMMA, gain=GAIN), {"image": image})
    out = run(Grade(gamma=GAMMA, gain=GAIN), {"image": image, "amount": mask})
    assert relative(out, image + (full - image) * mask[..., None]) < 1e-5


@pytest.mark.parametrize("amount", [0.0, 0.4, 1.0, 2.0])
def test_saturation_is_that_of_openimageio(run, amount):
    image = picture()
    expected = ALGO.saturate(make_buffer(image), amount).get_pixels("float")
    assert relative(run(Saturation(saturation=amount), {"image": image}), expected) < 2e-6


def test_saturation_is_that_of_a_color_decision_list(run):
    image = picture(3, opaque=True)
    out = run(Saturation(saturation=1.7), {"image": image})
    assert relative(out[..., :3], cdl(image[..., :3], [1] * 3, [0] * 3, [1] * 3, 1.7)) < 2e-6


def test_luminance_is_a_weighted_sum(run):
    image = picture(4)
    expected = ALGO.channel_sum(make_buffer(image), (0.2126, 0.7152, 0.0722, 0.0)).get_pixels("float")
    out = run(Luminance(), {"image": image})
    assert relative(out[..., 0], expected.reshape(out.shape[:2])) < 1e-6


@pytest.mark.parametrize(("measure", "reduce"), [("average", np.mean), ("maximum", np.max), ("minimum", np.min)])
def test_luminance_measures(run, measure, reduce):
    image = picture(5)
    out = run(Luminance(measure=measure), {"image": image})[..., 0]
    assert relative(out, reduce(image[..., :3].astype(np.float64), -1)) < 1e-6


def test_clip_is_that_of_openimageio(run):
    image = picture(6, opaque=True)
    expected = ALGO.clamp(make_buffer(image), (0.1,) * 4, (0.9, 0.9, 0.9, 1.0), False).get_pixels("float")
    assert np.array_equal(run(Clip(low=0.1, high=0.9), {"image": image}), expected)


def test_vignette_cos4_is_the_law_of_natural_falloff(run):
    """A pixel at distance d from the axis behind a lens of focal length f sees cos(atan(d / f))^4 of the light."""
    image = np.ones((33, 49, 4), np.float32)
    y, x = np.mgrid[:33, :49] + 0.5
    distance = np.hypot((x - 24.5) / 24.5, (y - 16.5) / 16.5)
    out = run(Vignette(falloff="cos4", amount=1.0, radius=0.8), {"image": image})
    assert np.abs(out[..., 0] - np.cos(np.arctan(distance / 0.8)) ** 4).max() < 1e-6
    assert np.all(out[..., 3] == 1.0)


def test_vignette_ring_lies_at_its_radius(run):
    image = np.ones((41, 81, 4), np.float32)
    values = {"amount": 0.8, "radius": 0.7, "softness": 0.4, "center": (0.4, 0.6)}
    y, x = np.mgrid[:41, :81] + 0.5
    for roundness in (0.0, 0.3, 1.0):
        root_mean_square = np.hypot(40.5, 20.5) / np.sqrt(2)
        unit_x = 40.5 + (root_mean_square - 40.5) * roundness
        unit_y = 20.5 + (root_mean_square - 20.5) * roundness
        distance = np.hypot((x - 0.4 * 81) / unit_x, (y - 0.6 * 41) / unit_y)
        t = ((distance - 0.7 * 0.6) / (0.7 * 0.8)).clip(0, 1)
        out = run(Vignette(**values, roundness=roundness), {"image": image})[..., 0]
        assert np.abs(out - (1 - 0.8 * t * t * (3 - 2 * t))).max() < 2e-6


def test_vignette_treats_all_corners_alike(run):
    image = np.ones((20, 36, 4), np.float32)
    for falloff in ("smooth", "cos4"):
        out = run(Vignette(falloff=falloff, roundness=0.5), {"image": image})
        assert np.abs(out - out[::-1]).max() < 1e-6 and np.abs(out - out[:, ::-1]).max() < 1e-6


def test_vignette_is_the_same_in_a_proxy(run):
    image = np.ones((64, 96, 4), np.float32)
    full, half = (run(Vignette(), {"image": image}, scale=scale)[..., 0] for scale in (1.0, 0.5))
    assert np.abs(half - full.reshape(32, 2, 48, 2).mean((1, 3))).max() < 2e-3


@pytest.mark.parametrize("node", [Grade(gamma=GAMMA, gain=GAIN, lift=LIFT), Clip(), Saturation(saturation=0.3)])
def test_color_does_not_depend_on_coverage(run, node):
    """The same color at half coverage comes out as the same color at half coverage."""
    whole = picture(7, opaque=True)
    half = whole * np.float32(0.5)
    assert relative(run(node, {"image": half}), run(node, {"image": whole}) * 0.5) < 2e-6


@pytest.mark.parametrize("node", [Exposure(stops=1.0), Grade(gamma=GAMMA), Saturation(saturation=0.0), Clip(high=0.5)])
def test_light_without_coverage_survives(run, node):
    glow = np.array([[[0.5, 0.25, 0.125, 0.0]]], np.float32)
    out = run(node, {"image": glow})
    assert out[0, 0, 3] == 0.0 and np.all(out[0, 0, :3] > 0.0)


@pytest.mark.parametrize(
    "node", [Exposure(), Grade(), Grade(gain=GAIN, amount=0.0), Saturation(), Vignette(amount=0.0)]
)
def test_neutral_values_change_nothing(run, node):
    image = picture(8)
    assert node.identity() == "image"
    assert np.array_equal(run(node, {"image": image}), image)
