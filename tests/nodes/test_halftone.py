"""Halftone against the screens' definition in 64 bits, and its tones by the area that ink covers."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.stylize.halftone import Halftone

PATTERNS = ("dot", "line", "cross")
ANGLES = np.radians([15.0, 75.0, 0.0, 45.0])
AREAS = {}


def share(pattern: str, q: np.ndarray) -> np.ndarray:
    """How much of the unit cell lies nearer to the middle of the ink than `q`, counted on a fine grid."""
    across, down = np.meshgrid(*[(np.arange(700) + 0.5) / 1400] * 2)
    nearness = {"dot": np.hypot, "line": lambda x, y: y, "cross": np.minimum}[pattern]
    if pattern not in AREAS:
        AREAS[pattern] = np.sort(nearness(across, down).ravel())
    return np.searchsorted(AREAS[pattern], nearness(q[..., 0], q[..., 1])) / AREAS[pattern].size


def printed(picture: np.ndarray, pattern: str, size: float, angle: float) -> np.ndarray:
    absorbed = 1.0 - np.clip(picture[..., :3].astype(np.float64), 0.0, 1.0)
    black = absorbed.min(-1, keepdims=True)
    inks = np.concatenate([(absorbed - black) / np.maximum(1.0 - black, 1e-6), black], axis=-1)
    y, x = np.mgrid[: picture.shape[0], : picture.shape[1]]
    total = np.zeros(absorbed.shape)
    for i in range(9):
        place = (x + (i % 3 + 0.5) / 3 + 1j * (y + (i // 3 + 0.5) / 3)) / size
        free = []
        for ink in range(4):
            turned = place * np.exp(-1j * (angle + ANGLES[ink]))
            q = np.abs(np.stack([turned.real, turned.imag], axis=-1) % 1.0 - 0.5)
            free.append((share(pattern, q) >= inks[..., ink]) | (inks[..., ink] <= 0.0))
        total += np.stack(free[:3], axis=-1) & free[3][..., None]
    return total / 9.0


@pytest.mark.parametrize("pattern", PATTERNS)
def test_it_equals_the_definition(run, pattern):
    """But for samples on the very border of the ink: they count a ninth."""
    picture = np.random.default_rng(3).random((24, 31, 4)).astype(np.float32)
    picture[..., 3] = 1.0
    found = run(Halftone(pattern=pattern, size=7.3, angle=10.0), {"image": picture})[..., :3]
    error = np.abs(found - printed(picture, pattern, 7.3, np.radians(10.0)))
    assert (error > 1e-5).mean() <= 0.01
    assert error.max() <= 2.01 / 9.0


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("color", [(0.1, 0.1, 0.1), (0.5, 0.5, 0.5), (0.85, 0.85, 0.85), (0.7, 0.2, 0.05)])
@pytest.mark.parametrize("inks", ["cmyk", "black"])
def test_tones_are_right_from_afar(run, pattern, color, inks):
    flat = np.ones((240, 240, 4), np.float32)
    flat[..., :3] = color
    mean = run(Halftone(inks=inks, pattern=pattern, size=6.1, angle=7.0), {"image": flat})[..., :3].mean((0, 1))
    expected = color if inks == "cmyk" else np.dot(color, [0.2126, 0.7152, 0.0722])
    np.testing.assert_allclose(mean, np.broadcast_to(expected, 3), atol=0.01)


def test_white_and_black_are_whole(run, hdr):
    for light, expected in ((1.0, 1.0), (9.0, 1.0), (0.0, 0.0), (-1.0, 0.0)):
        flat = np.full((12, 12, 4), light, np.float32)
        flat[..., 3] = 1.0
        np.testing.assert_allclose(run(Halftone(), {"image": flat})[..., :3], expected)


@pytest.mark.parametrize("light", [3e-4, 3e-5])
def test_nearly_black_is_open_at_the_corners_of_cells_only(run, light):
    """There the disc of ink just covers the cell, so what is a little less than black has holes of one sample."""
    flat = np.full((15, 20, 4), light, np.float32)
    flat[..., 3] = 1.0
    found = run(Halftone(inks="black", size=2.5, angle=-45.0), {"image": flat})[..., 0]
    y, x, down, right = np.ix_(*map(np.arange, (15, 20, 3, 3)))
    corner = ((6 * x + 2 * right + 1) % 15 == 0) & ((6 * y + 2 * down + 1) % 15 == 0)
    np.testing.assert_allclose(found, corner.sum((2, 3)) / 9.0, atol=1e-6)


def test_alpha_is_kept(run, hdr):
    picture = hdr(13, 9)
    found = run(Halftone(), {"image": picture})
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])
    assert (found[..., :3] <= picture[..., 3:] + 1e-6).all()
