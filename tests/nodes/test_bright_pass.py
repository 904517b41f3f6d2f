"""The bright pass against its formulas in 64 bits, and what they promise at their ends."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.glow.bloom import Bloom
from halation.nodes.glow.bright_pass import BrightPass

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
MEASURES = {"luminance": lambda rgb: rgb @ WEIGHTS, "maximum": lambda rgb: rgb.max(-1)}


def soft(light, threshold, knee, power):
    width = threshold * knee
    eased = np.clip(light - threshold + width, 0.0, 2.0 * width) ** 2 / (4.0 * width + 1e-5)
    return np.maximum(eased, light - threshold)


KEPT = {
    "hard": lambda light, threshold, knee, power: light * (light > threshold),
    "soft": soft,
    "clamp": lambda light, threshold, knee, power: light,
    "exponential": lambda light, threshold, knee, power: light * -np.expm1(-((light / threshold) ** power)),
    "power": lambda light, threshold, knee, power: light * (light / threshold) ** power,
}


@pytest.mark.parametrize("mode", KEPT)
@pytest.mark.parametrize("measure", MEASURES)
def test_the_formulas(run, hdr, mode, measure):
    picture, mask = hdr(23, 17), np.random.default_rng(1).random((17, 23)).astype(np.float32)
    values = {"threshold": 0.8, "knee": 0.6, "power": 2.0}
    color = picture[..., :3].astype(np.float64)
    light = MEASURES[measure](color)
    share = KEPT[mode](np.minimum(light, 8.0), **values) / light
    node = BrightPass(mode=mode, measure=measure, limit=8.0, **values)
    found = run(node, {"image": picture, "mask": mask})
    expected = color * (share * mask)[..., None]
    # What is just above the threshold is a difference of near numbers.
    assert (np.abs(found[..., :3] - expected) / np.maximum(color, expected)).max() <= 2e-6
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])


@pytest.mark.parametrize("mode", ["hard", "soft", "clamp"])
def test_all_light_passes_without_threshold(run, hdr, mode):
    picture = hdr(19, 13)
    np.testing.assert_allclose(run(BrightPass(mode=mode, threshold=0.0), {"image": picture}), picture, rtol=1e-6)


@pytest.mark.parametrize("mode", KEPT)
def test_the_hue_stays_and_nothing_is_above_the_limit(run, hdr, mode):
    picture = hdr(19, 13)
    found = run(BrightPass(mode=mode, limit=3.0), {"image": picture})[..., :3].astype(np.float64)
    color = picture[..., :3].astype(np.float64)
    cross = np.cross(found, color) / (np.linalg.norm(color, axis=-1) * np.maximum(found.max(-1), 1e-9))[..., None]
    assert np.abs(cross).max() <= 1e-5
    assert (found @ WEIGHTS).max() <= 3.0 * (9.0 if mode == "power" else 1.0) * (1.0 + 1e-6)


@pytest.mark.parametrize("mode", ["soft", "clamp", "exponential", "power"])
def test_it_grows_evenly_with_light(run, mode):
    """Neither a jump nor a fall, which would flicker in motion."""
    light = np.linspace(0.0, 4.0, 4001, dtype=np.float32)
    picture = np.repeat(light[None, :, None], 4, axis=-1)
    found = run(BrightPass(mode=mode), {"image": picture})[0, :, 1].astype(np.float64)
    steps = np.diff(found)
    assert steps.min() >= -1e-6
    assert np.abs(np.diff(steps)).max() <= 1e-4


def test_the_lecture_form_is_a_power_of_light(run):
    gray = np.array([0.25, 0.5, 1.0, 2.0, 4.0], np.float32)
    picture = np.repeat(gray[None, :, None], 4, axis=-1)
    found = run(BrightPass(mode="power", power=3.0), {"image": picture})[0, :, 0]
    np.testing.assert_allclose(found, gray**4, rtol=2e-6)


def test_a_mask_alone_picks_what_glows(run, hdr):
    picture, mask = hdr(9, 7), np.zeros((7, 9), np.float32)
    mask[2:4, 3:6] = 1.0
    found = run(BrightPass(threshold=0.0), {"image": picture, "mask": mask})
    np.testing.assert_allclose(found[..., :3], picture[..., :3] * mask[..., None], rtol=1e-6)


def test_bloom_picks_the_same_light(run, hdr):
    picture = hdr(16, 12)
    values = {"threshold": 0.7, "knee": 0.4, "limit": 9.0}
    found = run(Bloom(radius=0.0, **values), {"image": picture}, output="glow")
    np.testing.assert_allclose(found, run(BrightPass(**values), {"image": picture}), rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize(
    ("values", "passed"),
    [
        # Learn OpenGL, "Bloom": light above the threshold whole, by Rec. 709 luminance, and no other.
        ({"mode": "hard"}, (0.0, 0.0, 0.0, 1.5, 3.0)),
        # Unity's post processing, QuadraticThreshold with a knee of 0.5: a parabola from 0.5 to 1.5, then a line.
        ({"mode": "soft", "knee": 0.5}, (0.0, 0.03125, 0.125, 0.5, 2.0)),
        # 1 - 1/e of the light at the threshold.
        ({"mode": "exponential", "power": 1.0}, (0.19673467, 0.39572508, 0.63212056, 1.16530476, 2.85063879)),
        ({"mode": "power", "power": 2.0}, (0.125, 0.421875, 1.0, 3.375, 27.0)),
    ],
    ids=lambda part: part["mode"] if isinstance(part, dict) else "",
)
def test_grays_by_hand(run, values, passed):
    light = np.array([0.5, 0.75, 1.0, 1.5, 3.0])
    picture = np.stack([light, light, light, np.ones(5)], -1)[None]
    found = run(BrightPass(threshold=1.0, limit=100.0, **values), {"image": picture})[0, :, 1]
    np.testing.assert_allclose(found, passed, rtol=2e-5, atol=1e-6)


def test_colors_pass_by_their_weight_in_rec_709(run):
    """Green of 1.5 has a luminance of 1.07, blue of 10 one of 0.72; the largest channel of both is above 1."""
    picture = np.array([[[0.0, 1.5, 0.0, 1.0], [0.0, 0.0, 10.0, 1.0]]])
    node = BrightPass(mode="hard", threshold=1.0, limit=100.0, measure="luminance")
    np.testing.assert_allclose(run(node, {"image": picture})[0, :, :3], [[0.0, 1.5, 0.0], [0.0, 0.0, 0.0]], rtol=1e-6)
    node = BrightPass(mode="hard", threshold=1.0, limit=100.0, measure="maximum")
    np.testing.assert_allclose(run(node, {"image": picture})[..., :3], picture[..., :3], rtol=1e-6)
