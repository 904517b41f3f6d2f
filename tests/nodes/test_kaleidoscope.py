"""Kaleidoscope against scipy at positions computed in 64 bits, and its symmetries."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.distort.kaleidoscope import Kaleidoscope
from warps import warp_picture, waves


@pytest.mark.parametrize("size", [(33, 26), (3, 2), (1, 1)])
@pytest.mark.parametrize(("segments", "zoom"), [(1, 1.0), (3, 0.4), (6, 1.5), (17, 1.0)])
def test_it_is_scipys_at_these_positions(run, hdr, edge, size, segments, zoom):
    center = (0.4 * size[0] + 0.01, 0.6 * size[1])

    def source(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        away, wedge = (x - center[0]) + 1j * (y - center[1]), 2 * np.pi / segments
        angle = (np.angle(away) - np.radians(20)) % wedge
        found = np.abs(away) / zoom * np.exp(1j * (np.minimum(angle, wedge - angle) + np.radians(-70)))
        return center[0] + found.real, center[1] + found.imag

    picture = hdr(*size)
    node = Kaleidoscope(
        segments=segments, rotation=20.0, slice=-70.0, zoom=zoom, center=(center[0] / size[0], 0.6), edge=edge.name
    )
    expected, sure = warp_picture(picture, source, edge.scipy_map)
    error = np.abs(run(node, {"image": picture}) - expected).max(-1)
    assert sure.mean() > 0.9 and error[sure].max() < 1e-4 * picture.max()


def test_four_segments_have_the_symmetries_of_a_square(run):
    out = run(Kaleidoscope(segments=4), {"image": waves(49, 49)})
    for same in (out[::-1], out[:, ::-1], np.rot90(out), out.transpose(1, 0, 2)):
        assert np.abs(same - out).max() < 1e-3


def test_the_slice_itself_stays(run):
    """To the right of the center, within half a wedge below the axis."""
    picture = waves(61, 61)
    out = run(Kaleidoscope(segments=3), {"image": picture})
    y, x = np.mgrid[:61, :61] - 30.0
    kept = (np.arctan2(y, x) > 0.05) & (np.arctan2(y, x) < np.pi / 3 - 0.05) & (x > 2)
    assert kept.sum() > 300 and np.abs(out - picture)[kept].max() < 1e-4
