"""Merge against OpenImageIO and against the W3C's text; Mix Images."""

from __future__ import annotations

from typing import get_args

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.merge.merge import Merge, Mode
from halation.nodes.merge.mix_images import MixImages
from oiio_pictures import make_buffer

ALGO = oiio.ImageBufAlgo
WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


def picture(seed: int, high: float = 1.0, opaque: bool = False) -> np.ndarray:
    random = np.random.default_rng(seed)
    straight = random.uniform(0.0, high, (19, 23, 3))
    alpha = random.uniform(0.02, 1.0, (19, 23, 1)) if not opaque else np.ones((19, 23, 1))
    return np.concatenate([straight * alpha, alpha], -1).astype(np.float32)


# --- the W3C's Compositing and Blending Level 1, written as its text: straight colors, B(Cb, Cs) -------------------

FACTORS = {
    "over": lambda s, b: (1, 1 - s),
    "under": lambda s, b: (1 - b, 1),
    "in": lambda s, b: (b, 0),
    "out": lambda s, b: (1 - b, 0),
    "atop": lambda s, b: (b, 1 - s),
    "xor": lambda s, b: (1 - b, 1 - s),
    "clear": lambda s, b: (0, 0),
}
"""Section 9.1: Fa and Fb of every Porter-Duff operator (`under` is destination-over)."""


def multiply(b, s):
    return b * s


def screen(b, s):
    return b + s - b * s


def hard_light(b, s):
    return np.where(s <= 0.5, multiply(b, 2 * s), screen(b, 2 * s - 1))


def color_dodge(b, s):
    return np.where(b == 0, 0, np.where(s == 1, 1, np.minimum(1, b / np.where(s == 1, 1, 1 - s))))


def color_burn(b, s):
    return np.where(b == 1, 1, np.where(s == 0, 0, 1 - np.minimum(1, (1 - b) / np.where(s == 0, 1, s))))


def soft_light(b, s):
    d = np.where(b <= 0.25, ((16 * b - 12) * b + 4) * b, np.sqrt(b))
    return np.where(s <= 0.5, b - (1 - 2 * s) * b * (1 - b), b + (2 * s - 1) * (d - b))


def lum(c):
    return (c @ WEIGHTS)[..., None]


def sat(c):
    return c.max(-1, keepdims=True) - c.min(-1, keepdims=True)


def clip_color(c):
    level, low, high = lum(c), c.min(-1, keepdims=True), c.max(-1, keepdims=True)
    c = np.where(low < 0, level + (c - level) * level / np.where(low < 0, level - low, 1), c)
    return np.where(high > 1, level + (c - level) * (1 - level) / np.where(high > 1, high - level, 1), c)


def set_lum(c, level):
    return clip_color(c + level - lum(c))


def set_sat(c, spread):
    """The middle and the largest channel are scaled, the smallest becomes 0."""
    low, found = c.min(-1, keepdims=True), sat(c)
    return np.where(found > 0, (c - low) * spread / np.where(found > 0, found, 1), 0)


BLENDS = {
    "multiply": multiply,
    "screen": screen,
    "overlay": lambda b, s: hard_light(s, b),
    "soft light": soft_light,
    "hard light": hard_light,
    "color dodge": color_dodge,
    "color burn": color_burn,
    "darken": np.minimum,
    "lighten": np.maximum,
    "difference": lambda b, s: abs(b - s),
    "exclusion": lambda b, s: b + s - 2 * b * s,
    "hue": lambda b, s: set_lum(set_sat(s, sat(b)), lum(b)),
    "saturation": lambda b, s: set_lum(set_sat(b, sat(s)), lum(b)),
    "color": lambda b, s: set_lum(s, lum(b)),
    "luminosity": lambda b, s: set_lum(b, lum(s)),
}
OURS = {
    "subtract": lambda b, s: b - s,
    "divide": lambda b, s: b / s,
    "hypot": np.hypot,
    "average": lambda b, s: (b + s) / 2,
}


def straight(image: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    image = image.astype(np.float64)
    return image[..., :3] / image[..., 3:], image[..., 3:]


@pytest.mark.parametrize("mode", FACTORS)
def test_porter_duff_as_the_w3c_writes_it(run, mode):
    a, b = picture(0), picture(1)
    (source, alpha_s), (backdrop, alpha_b) = straight(a), straight(b)
    fa, fb = FACTORS[mode](alpha_s, alpha_b)
    rgb = alpha_s * fa * source + alpha_b * fb * backdrop
    expected = np.concatenate([rgb, alpha_s * fa + alpha_b * fb], -1)
    assert np.abs(run(Merge(mode=mode), {"a": a, "b": b}) - expected).max() < 1e-6


@pytest.mark.parametrize("mode", [*BLENDS, *OURS])
def test_blends_as_the_w3c_writes_them(run, mode):
    """Section 5.1: Cs = (1 - ab) Cs + ab B(Cb, Cs); co = as Cs + (1 - as) ab Cb; ao = as + ab (1 - as)."""
    a, b = picture(2), picture(3)
    (source, alpha_s), (backdrop, alpha_b) = straight(a), straight(b)
    blended = (BLENDS | OURS)[mode](backdrop, source)
    mixed = (1 - alpha_b) * source + alpha_b * blended
    rgb = alpha_s * mixed + (1 - alpha_s) * alpha_b * backdrop
    expected = np.concatenate([rgb, alpha_s + alpha_b * (1 - alpha_s)], -1)
    error = np.abs(run(Merge(mode=mode), {"a": a, "b": b}) - expected) / np.maximum(1.0, np.abs(expected))
    assert error.max() < 2e-6


@pytest.mark.parametrize("mode", [*FACTORS, "plus", *BLENDS, *OURS])
def test_clipped_is_what_an_opaque_background_gives_times_its_alpha(run, mode):
    """As a clipping mask, or an isolated group of the W3C whose first element is opaque, masked by the background."""
    a, b = picture(4), picture(5)
    (source, alpha_s), (backdrop, alpha_b) = straight(a), straight(b)
    fa, fb = FACTORS.get(mode, lambda s, b: (1, 1 - s))(alpha_s, np.ones_like(alpha_b))
    blended = BLENDS | OURS
    if mode == "plus":
        rgb, alpha = alpha_s * source + backdrop, np.ones_like(alpha_b)
    elif mode in FACTORS:
        rgb, alpha = alpha_s * fa * source + fb * backdrop, alpha_s * fa + fb
    else:
        rgb, alpha = alpha_s * blended[mode](backdrop, source) + (1 - alpha_s) * backdrop, np.ones_like(alpha_b)
    expected = alpha_b * np.concatenate([rgb, alpha], -1)
    error = np.abs(run(Merge(mode=mode, clipped=True), {"a": a, "b": b}) - expected) / np.maximum(1.0, np.abs(expected))
    assert error.max() < 2e-6


@pytest.mark.parametrize("mode", ["over", "atop", "plus", "multiply", "soft light", "screen"])
def test_clipped_keeps_light_where_alpha_is_0(run, mode):
    a, b = picture(6), picture(7)
    b[4:8, 5:9, 3] = 0.0
    out = run(Merge(mode=mode, clipped=True), {"a": a, "b": b})[4:8, 5:9]
    assert (out[..., 3] == 0.0).all()
    kept = b[4:8, 5:9, :3] * (1.0 if mode == "plus" else 1.0 - a[4:8, 5:9, 3:])
    np.testing.assert_allclose(out[..., :3], kept, atol=1e-6)


def test_every_mode_is_tested():
    assert set(get_args(Mode)) == {*FACTORS, *BLENDS, *OURS, "plus"}


def test_over_is_that_of_openimageio(run):
    a, b = picture(4, 8.0), picture(5, 8.0)
    expected = ALGO.over(make_buffer(a), make_buffer(b)).get_pixels("float")
    assert np.abs(run(Merge(), {"a": a, "b": b}) - expected).max() < 2e-6


@pytest.mark.parametrize(
    ("mode", "reference"),
    [
        ("multiply", ALGO.mul),
        ("darken", ALGO.min),
        ("lighten", ALGO.max),
        ("difference", ALGO.absdiff),
        ("subtract", ALGO.sub),
        ("divide", ALGO.div),
        ("plus", ALGO.add),
    ],
)
def test_opaque_arithmetic_is_that_of_openimageio(run, mode, reference):
    """On opaque pictures a blend is plain arithmetic of light of any strength."""
    a, b = picture(6, 8.0, opaque=True), picture(7, 8.0, opaque=True)
    expected = reference(make_buffer(b), make_buffer(a)).get_pixels("float")[..., :3]
    out = run(Merge(mode=mode), {"a": a, "b": b})
    assert (np.abs(out[..., :3] - expected) / np.maximum(1.0, np.abs(expected))).max() < 1e-6
    assert np.all(out[..., 3] == 1.0)


def test_values_by_hand(run):
    """One pixel of every kind, worked out on paper from the W3C's formulas: backdrop 0.2, source 0.6."""
    a, b = (np.array([[[value] * 3 + [1.0]]], np.float32) for value in (0.6, 0.2))
    by_hand = {
        "multiply": 0.12,
        "screen": 0.68,
        "overlay": 0.24,
        "hard light": 0.36,
        "color dodge": 0.5,
        "color burn": 0.0,
        "soft light": 0.2 + 0.2 * (((16 * 0.2 - 12) * 0.2 + 4) * 0.2 - 0.2),
        "exclusion": 0.56,
        "hypot": 0.4**0.5,
    }
    for mode, expected in by_hand.items():
        assert run(Merge(mode=mode), {"a": a, "b": b})[0, 0, 0] == pytest.approx(expected, abs=1e-6), mode


@pytest.mark.parametrize(
    ("mode", "backdrop", "source", "expected"),
    [
        ("screen", 1.1, 0.5, 1.1),
        ("screen", 0.5, 1.1, 1.1),
        ("overlay", 2.0, 0.5, 3.0),
        ("hard light", 0.5, 2.0, 3.0),
        ("soft light", 2.0, 0.2, 2.0),
        ("soft light", 0.25, 3.0, 0.5),
        ("color dodge", 2.0, 0.25, 2.0),
        ("color dodge", 0.5, 3.0, 1.0),
        ("color burn", 2.0, 0.5, 2.0),
        ("color burn", 0.5, 2.0, 0.75),
    ],
)
def test_light_beyond_the_w3cs_range(run, mode, backdrop, source, expected):
    a, b = (np.array([[[value] * 3 + [1.0]]], np.float32) for value in (source, backdrop))
    assert run(Merge(mode=mode), {"a": a, "b": b})[0, 0, 0] == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("mode", [mode for mode in get_args(Mode) if mode != "divide"])
def test_bright_light_continues_without_a_jump(run, mode):
    """Crossing 1 on either side by a hair changes the result by a hair."""
    random = np.random.default_rng(8)
    other = random.uniform(0.05, 4.0, (64, 3)).astype(np.float32)
    step = 1e-4
    for bright_foreground in (False, True):
        found = []
        for level in (1 - step, 1 + step):
            one, two = np.ones((1, 64, 4), np.float32), np.ones((1, 64, 4), np.float32)
            one[..., :3], two[..., :3] = level, other
            a, b = (one, two) if bright_foreground else (two, one)
            found.append(run(Merge(mode=mode), {"a": a, "b": b}))
        jump = np.abs(found[1] - found[0]).max()
        assert jump < 60 * step, (mode, bright_foreground, jump)


@pytest.mark.parametrize("mode", get_args(Mode))
def test_bright_and_empty_pixels_stay_finite(run, mode):
    random = np.random.default_rng(9)
    a, b = (random.choice([0.0, 1e-8, 0.5, 1.0, 3.0, 1e4, -2.0], (16, 16, 4)).astype(np.float32) for _ in range(2))
    assert np.isfinite(run(Merge(mode=mode), {"a": a, "b": b})).all()


@pytest.mark.parametrize("mode", [mode for mode in get_args(Mode) if mode not in ("in", "out", "clear")])
def test_empty_foreground_changes_nothing(run, mode):
    b = picture(10, 4.0)
    out = run(Merge(mode=mode), {"a": np.zeros_like(b), "b": b})
    assert np.abs(out - b).max() < 1e-6


def test_symmetries(run):
    a, b = picture(11), picture(12)
    for first, second in (("over", "under"), ("overlay", "hard light")):
        one = run(Merge(mode=first), {"a": a, "b": b})
        two = run(Merge(mode=second), {"a": b, "b": a})
        assert np.abs(one - two).max() < 1e-6


def test_whole_color_blends_keep_what_they_promise(run):
    a, b = picture(13, 3.0, opaque=True), picture(14, 3.0, opaque=True)
    for mode, source in (("hue", b), ("saturation", b), ("color", b), ("luminosity", a)):
        out = run(Merge(mode=mode), {"a": a, "b": b})
        assert np.abs(out[..., :3] @ WEIGHTS - source[..., :3] @ WEIGHTS).max() < 1e-5, mode


def test_mask_and_amount_show_the_background(run):
    a, b = picture(15, 4.0), picture(16, 4.0)
    mask = np.random.default_rng(17).uniform(0, 1, b.shape[:2]).astype(np.float32)
    full = run(Merge(mode="screen"), {"a": a, "b": b})
    out = run(Merge(mode="screen", amount=0.5), {"a": a, "b": b, "mask": mask})
    assert np.abs(out - (b + (full - b) * 0.5 * mask[..., None])).max() < 2e-6
    assert Merge(amount=0.0).identity() == "b"
    assert np.array_equal(run(Merge(amount=0.0), {"a": a, "b": b}), b)


@pytest.mark.parametrize("factor", [0.0, 0.25, 1.0, 1.5])
def test_mix_is_a_weighted_sum(run, factor):
    a, b = picture(18, 4.0), picture(19, 4.0)
    expected = a.astype(np.float64) * (1 - factor) + b.astype(np.float64) * factor
    assert np.abs(run(MixImages(factor=factor), {"a": a, "b": b}) - expected).max() < 2e-6


def test_mix_by_a_field(run):
    a, b = picture(20), picture(21)
    factor = np.random.default_rng(22).uniform(0, 1, b.shape[:2]).astype(np.float32)
    out = run(MixImages(), {"a": a, "b": b, "factor": factor})
    assert np.abs(out - (a * (1 - factor[..., None]) + b * factor[..., None])).max() < 1e-6
