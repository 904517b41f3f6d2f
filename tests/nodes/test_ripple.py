"""Ripple against scipy at positions computed in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.distort.ripple import Ripple
from warps import warp_picture, waves


@pytest.mark.parametrize("size", [(33, 26), (3, 2), (1, 1)])
@pytest.mark.parametrize("shape", ["circular", "straight"])
@pytest.mark.parametrize("motion", ["along", "across"])
@pytest.mark.parametrize("degrees", [0.0, 35.0])
def test_it_is_scipys_at_these_positions(run, hdr, size, shape, motion, degrees):
    center, height = (0.4 * size[0], 0.6 * size[1]), size[1]

    def source(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        away = (x - center[0]) + 1j * (y - center[1])
        along = np.exp(1j * np.radians(degrees)) * np.ones_like(away)
        run_ = (away * np.conj(along)).real
        if shape == "circular":
            run_ = np.abs(away)
            along = np.where(run_ > 0, away / np.maximum(run_, 1e-30), 0)
        wave = 0.05 * height * np.sin(2 * np.pi * (run_ / (0.3 * height) - 0.2))
        wave *= np.exp(-np.abs(run_) / (0.7 * height))
        moved = x + 1j * y + wave * (along if motion == "along" else 1j * along)
        return moved.real, moved.imag

    picture = hdr(*size)
    node = Ripple(
        shape=shape,
        motion=motion,
        angle=degrees,
        amplitude=0.05,
        wavelength=0.3,
        phase=0.2,
        reach=0.7,
        center=(0.4, 0.6),
        edge="mirror",
    )
    expected, sure = warp_picture(picture, source, "mirror")
    error = np.abs(run(node, {"image": picture}) - expected).max(-1)
    assert sure.mean() > 0.9 and error[sure].max() < 1e-5 * picture.max()


def test_whole_waves_later_it_is_the_same(run):
    picture = waves(48, 40)
    now, later = (run(Ripple(phase=phase), {"image": picture}) for phase in (0.25, 3.25))
    assert np.abs(now - later).max() < 1e-4
    half = run(Ripple(phase=0.75, amplitude=-0.01), {"image": picture})
    assert np.abs(now - half).max() < 1e-4


def test_no_amplitude_vanishes():
    assert Ripple(amplitude=0.0).identity() == "image" and Ripple().identity() is None
