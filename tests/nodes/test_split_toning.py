"""Split toning against its formula and what it promises."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.color.split_toning import SplitToning

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
TEAL, ORANGE = (0.2, 0.6, 0.9, 1.0), (1.0, 0.6, 0.3, 1.0)


def reference(rgb: np.ndarray, balance: float, span: float, amount: float) -> np.ndarray:
    light = rgb.astype(np.float64) @ WEIGHTS
    t = ((np.log2(light / 0.18) - balance) / span + 0.5).clip(0, 1)[..., None]
    bright = t * t * (3 - 2 * t)
    dark_tint, bright_tint = (np.array(color[:3]) / (color[:3] @ WEIGHTS) for color in (TEAL, ORANGE))
    toned = rgb * (1 + amount * (dark_tint * (1 - bright) + bright_tint * bright - 1))
    return toned * (light / (toned @ WEIGHTS))[..., None]


@pytest.mark.parametrize(("balance", "span", "amount"), [(0.0, 6.0, 1.0), (-1.5, 2.0, 0.4), (2.0, 12.0, 0.7)])
def test_it_is_the_formula_and_keeps_luminance(run, hdr, balance, span, amount):
    picture = hdr(23, 17, opaque=True)
    node = SplitToning(shadows=TEAL, highlights=ORANGE, balance=balance, range=span, amount=amount)
    out = run(node, {"image": picture})[..., :3]
    expected = reference(picture[..., :3], balance, span, amount)
    assert (np.abs(out - expected) / expected.max(-1, keepdims=True)).max() < 1e-5
    light = picture[..., :3] @ WEIGHTS
    assert (np.abs(out @ WEIGHTS - light) / light).max() < 2e-6


def test_the_ends_take_the_tints(run):
    grays = 0.18 * 2.0 ** np.array([-4.0, 0.0, 4.0])
    picture = np.stack([grays, grays, grays, np.ones(3)], -1)[None]
    out = run(SplitToning(shadows=TEAL, highlights=ORANGE, range=6.0, amount=1.0), {"image": picture})[0, :, :3]
    dark, bright = (np.array(color[:3]) / (color[:3] @ WEIGHTS) for color in (TEAL, ORANGE))
    for found, tint in zip(out / grays[:, None], (dark, (dark + bright) / 2, bright), strict=True):
        assert np.abs(found - tint).max() < 3e-6


def test_tints_count_by_hue_and_strength_alone(run, hdr):
    picture = hdr(9, 7, opaque=True)
    out = run(SplitToning(shadows=TEAL, highlights=ORANGE), {"image": picture})
    brighter = SplitToning(shadows=tuple(3 * part for part in TEAL), highlights=tuple(0.2 * part for part in ORANGE))
    assert np.abs(run(brighter, {"image": picture}) / out - 1.0).max() < 1e-5


def test_coverage_does_not_change_the_color(run, hdr):
    picture = hdr(9, 7, opaque=True)
    out = run(SplitToning(), {"image": picture})
    assert np.abs(run(SplitToning(), {"image": picture * np.float32(0.5)}) / out - 0.5).max() < 1e-5
    assert not run(SplitToning(), {"image": np.zeros((1, 1, 4))}).any()


def test_gray_tints_and_no_amount_vanish():
    gray = (0.4, 0.4, 0.4, 1.0)
    assert SplitToning(shadows=gray, highlights=gray).identity() == "image"
    assert SplitToning(amount=0.0).identity() == "image" and SplitToning().identity() is None
