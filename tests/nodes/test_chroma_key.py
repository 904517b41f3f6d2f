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


def by_distance(picture: np.ndarray, node: ChromaKey) -> tuple[np.ndarray, np.ndarray]:
    """The distance method in 64 bits: the subject and its matte."""
    rgb, alpha = picture[..., :3].astype(np.float64), picture[..., 3].astype(np.float64)
    screen = np.float32(node.screen[:3]).astype(np.float64)
    chromaticity, empty = (np.maximum(c, 0) / np.maximum(c, 0).sum(-1, keepdims=True) for c in (rgb, screen))
    away = np.sqrt(((chromaticity - empty) ** 2).sum(-1)) / node.tolerance
    cover = ((np.minimum(away, 1) - node.black) / (node.white - node.black)).clip(0, 1)
    subject = rgb - (1 - cover)[..., None] * screen
    keyed = int(screen.argmax())
    others = [subject[..., channel] for channel in range(3) if channel != keyed]
    allowed = np.maximum(*others) if node.limit == "maximum" else sum(others) / 2
    subject[..., keyed] -= node.spill * np.maximum(subject[..., keyed] - allowed, 0)
    # What the screen took more of than there was is none, but what was negative before may stay.
    subject = np.where(cover[..., None] > 0, np.maximum(subject, np.minimum(rgb, 0)), 0)
    return np.concatenate([subject, (cover * alpha)[..., None]], -1), cover * alpha


@pytest.mark.parametrize("name", SCREENS)
@pytest.mark.parametrize(
    "values",
    [
        {},
        {"tolerance": 0.2, "limit": "average"},
        {"tolerance": 1.3, "spill": 0.4},
        {"tolerance": 0.8, "black": 0.15, "white": 0.6},
        {"tolerance": 0.5, "black": -0.3, "white": 1.5, "spill": 0.0},
    ],
    ids=str,
)
def test_distance_is_its_formula(run, name, values):
    """Over all colors, also such as no light has, and around the screen's own, where the matte begins."""
    random = np.random.default_rng(21)
    screen = np.array([*SCREENS[name], 1.0])
    picture = np.exp(random.normal(-1.0, 1.5, (24, 31, 4)))
    picture[:6] = screen * np.exp(random.normal(0.0, 0.3, (6, 31, 4)))
    picture[6:9, :, random.integers(3)] *= -0.1
    picture[..., 3] = random.random((24, 31))
    picture = picture.astype(np.float32)
    node = ChromaKey(method="distance", screen=tuple(screen), **values)
    subject, matte = by_distance(picture, node)
    assert np.ptp(matte / picture[..., 3]) > 0.5
    assert np.abs(run(node, {"image": picture}, output="matte")[..., 0] - matte).max() < 3e-6
    error = np.abs(run(node, {"image": picture}) - subject)
    assert (error <= 3e-6 * (1.0 + np.abs(picture[..., :3]).max(-1, keepdims=True))).all()
    # The matte knows no brightness.
    brighter = picture * np.float32([7.5, 7.5, 7.5, 1.0])
    assert np.abs(run(node, {"image": brighter}, output="matte")[..., 0] - matte).max() < 3e-6
