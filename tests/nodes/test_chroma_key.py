"""The chroma key against compositions whose subject and coverage are known."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.color.chroma_key import ChromaKey

SCREENS = {"green": (0.06, 0.5, 0.1), "blue": (0.05, 0.12, 0.6), "red": (0.7, 0.1, 0.1)}
KEYED = {"green": 1, "blue": 2, "red": 0}


def composed(subject: np.ndarray, cover: np.ndarray, screen: tuple[float, ...]) -> np.ndarray:
    rgb = subject * cover[..., None] + np.array(screen) * (1 - cover[..., None])
    return np.concatenate([rgb, np.ones_like(rgb[..., :1])], -1).astype(np.float32)


@pytest.mark.parametrize("name", SCREENS)
@pytest.mark.parametrize("limit", ["maximum", "average"])
def test_gray_subjects_come_back_exactly(run, name, limit):
    """Smith and Blinn's solution for gray: foreground and coverage of every pixel are recovered."""
    random = np.random.default_rng(8)
    cover = random.uniform(0, 1, (13, 17))
    cover[0], cover[1] = 0.0, 1.0
    subject = np.repeat(random.uniform(0, 4, (13, 17, 1)), 3, -1)
    # With `maximum` the screen's smaller channels would show in the larger one's stead, unless they are equal.
    screen = np.array(SCREENS[name])
    if limit == "maximum":
        others = [channel for channel in range(3) if channel != KEYED[name]]
        screen[others] = screen[others].mean()
    picture = composed(subject, cover, tuple(screen))
    node = ChromaKey(screen=(*screen, 1.0), limit=limit)
    assert np.abs(run(node, {"image": picture}, output="matte")[..., 0] - cover).max() < 5e-6
    out = run(node, {"image": picture})
    assert np.abs(out[..., :3] - subject * cover[..., None]).max() < 1e-5
    assert np.abs(out[..., 3] - cover).max() < 5e-6


@pytest.mark.parametrize("method", ["difference", "distance"])
@pytest.mark.parametrize("name", SCREENS)
def test_the_screen_vanishes_and_other_colors_stay(run, method, name):
    """Half as much light on the screen is still screen by distance, and half of it by difference."""
    screen = SCREENS[name]
    others = [SCREENS[other] for other in SCREENS if other != name]
    picture = composed(np.array([[(0.5, 0.5, 0.5), *others]]), np.ones((1, 3)), screen)
    node = ChromaKey(screen=(*screen, 1.0), method=method)
    np.testing.assert_array_equal(run(node, {"image": picture})[0, 1:], picture[0, 1:])
    assert run(node, {"image": picture}, output="matte")[0, 0, 0] > (0.99 if method == "difference" else 0.8)
    for light, left in ((1.0, 0.0), (0.5, 0.5 if method == "difference" else 0.0)):
        empty = composed(np.zeros((2, 2, 3)), np.zeros((2, 2)), tuple(light * part for part in screen))
        assert np.abs(run(node, {"image": empty}, output="matte") - left).max() < 2e-6


@pytest.mark.parametrize("limit", ["maximum", "average"])
def test_no_spill_is_left(run, hdr, limit):
    picture = hdr(23, 17, opaque=True)
    out = run(ChromaKey(limit=limit), {"image": picture})[..., :3].astype(np.float64)
    red, green, blue = np.moveaxis(out, -1, 0)
    allowed = np.maximum(red, blue) if limit == "maximum" else (red + blue) / 2
    assert (green - allowed).max() < 1e-5 * out.max()


def test_black_and_white_stretch_the_matte(run):
    cover = np.linspace(0, 1, 41)[None]
    picture = composed(np.full((1, 41, 3), 0.4), cover, (0.1, 0.6, 0.1))
    node = ChromaKey(screen=(0.1, 0.6, 0.1, 1.0), black=0.2, white=0.7)
    expected = ((cover - 0.2) / 0.5).clip(0, 1)
    assert np.abs(run(node, {"image": picture}, output="matte")[..., 0] - expected).max() < 5e-6


def test_spill_is_taken_off_as_far_as_asked(run):
    lit = np.float32([[[0.3, 0.5, 0.2, 1.0]]])
    node = ChromaKey(screen=(0.0, 1.0, 0.0, 1.0), white=0.5, spill=0.5)
    assert np.abs(run(node, {"image": lit})[0, 0] - [0.3, 0.4, 0.2, 1.0]).max() < 1e-6
