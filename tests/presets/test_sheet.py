"""The contact sheet shows every picture where it belongs, over its name."""

from __future__ import annotations

import numpy as np
import pytest
from halation.app.errors import UsageError
from halation.app.media.sheet import sheet, shown

COLORS = {"red": (0.8, 0.0, 0.0), "green_blue": (0.0, 0.7, 0.6), "white": (1.0, 1.0, 1.0)}
PICTURES = {name: np.full((40, 80, 3), color, np.float32) for name, color in COLORS.items()}
GAP, LABEL = 12, 27


def test_pictures_fill_rows() -> None:
    made = sheet(PICTURES, columns=2)
    assert made.shape == (2 * (40 + GAP + LABEL) + GAP, 2 * (80 + GAP) + GAP, 3)
    for index, color in enumerate(COLORS.values()):
        top, left = GAP + index // 2 * (40 + GAP + LABEL), GAP + index % 2 * (80 + GAP)
        assert np.allclose(made[top : top + 40, left : left + 80], color)
    assert np.ptp(made[-40:, -80:]) == 0.0


def test_names_are_written_below() -> None:
    made = sheet(PICTURES, columns=3)
    below = made[GAP + 40 :]
    for index in range(3):
        left = GAP + index * (80 + GAP)
        assert below[:, left : left + 80].max() > 0.4
    others = sheet({f"other {name}": one for name, one in PICTURES.items()}, columns=3)
    assert np.array_equal(made[: GAP + 40], others[: GAP + 40])
    assert not np.array_equal(made, others)


def test_pictures_shrink_to_the_width() -> None:
    made = sheet(PICTURES, columns=3, width=40)
    assert made.shape[1] == 3 * (40 + GAP) + GAP
    assert np.allclose(made[GAP : GAP + 20, GAP : GAP + 40], COLORS["red"], atol=1e-5)


def test_light_of_the_display_is_what_srgb_says() -> None:
    """Without a tone map, 0..1 comes out as it went in; brighter light ends at 1, premultiplied color is straight."""
    light = np.linspace(0.0, 1.0, 256, dtype=np.float32).repeat(4).reshape(16, 16, 4)
    light[..., 3] = 1.0
    assert np.abs(shown(light, "none") - light[..., :3]).max() < 1e-3
    bright = np.array([[[7.0, 0.25, 0.0, 0.5]]], np.float32)
    assert np.allclose(shown(bright, "none"), (1.0, 0.5, 0.0), atol=1e-3)


def test_unknown_view() -> None:
    with pytest.raises(UsageError, match="there is no view 'sepia'"):
        shown(PICTURES["red"], "sepia")
