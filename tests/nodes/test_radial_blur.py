"""Zoom and spin blur against scipy and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.blur.radial_blur import RadialBlur
from scipy.ndimage import map_coordinates


def around(picture: np.ndarray, node: RadialBlur, mode: str) -> np.ndarray:
    height, width = picture.shape[:2]
    middle = node.center[0] * width + 1j * node.center[1] * height
    y, x = np.mgrid[:height, :width] + 0.5
    away = x + 1j * y - middle
    spin = node.kind == "spin"
    reach = np.abs(away) * (np.radians(node.angle) if spin else node.zoom)
    counts = np.maximum(np.ceil(np.float32(reach)), 1.0)
    total = np.zeros(picture.shape)
    for i in range(int(counts.max())):
        t = (i + 0.5) / counts - 0.5
        at = middle + away * (np.exp(1j * t * np.radians(node.angle)) if spin else 1.0 + t * node.zoom)
        sample = np.stack(
            [
                map_coordinates(channel, [at.imag - 0.5, at.real - 0.5], order=1, mode=mode)
                for channel in np.moveaxis(picture.astype(np.float64), -1, 0)
            ],
            axis=-1,
        )
        total += np.where(i < counts, 1.0, 0.0)[..., None] * sample
    return total / counts[..., None]


@pytest.mark.parametrize("size", [(33, 22), (1, 7), (1, 1)])
@pytest.mark.parametrize(
    "values",
    [
        {"kind": "zoom", "zoom": 0.37},
        {"kind": "zoom", "zoom": 1.6, "center": (0.21, 0.87)},
        {"kind": "spin", "angle": 27.0},
        {"kind": "spin", "angle": 300.0, "center": (0.21, 0.87)},
    ],
)
def test_it_equals_scipy(run, hdr, edge, size, values):
    picture, node = hdr(*size), RadialBlur(**values, edge=edge.name)
    found = run(node, {"image": picture})
    # A position in 32 bits is known to about 1e-5 pixels.
    assert np.abs(found - around(picture, node, edge.scipy_map)).max() <= 3e-5 * picture.max()


def rings(side: int) -> np.ndarray:
    y, x = np.mgrid[:side, :side] + 0.5 - side / 2
    return np.repeat(np.exp(-np.hypot(x, y) / side * 3.0)[..., None], 4, axis=-1).astype(np.float32)


def test_spinning_rings_stay(run):
    picture = rings(48)
    found = run(RadialBlur(kind="spin", angle=40.0), {"image": picture})
    y, x = np.mgrid[:48, :48] - 23.5
    inside = np.hypot(x, y) < 23.0
    assert np.abs(found - picture)[inside].max() < 0.01  # what bilinear sampling costs


def test_zooming_rays_stay(run):
    y, x = np.mgrid[:48, :48] - 23.5
    picture = np.repeat(1.0 + 0.5 * np.sin(2.0 * np.arctan2(y, x))[..., None], 4, axis=-1).astype(np.float32)
    found = run(RadialBlur(zoom=0.4), {"image": picture})
    away = np.hypot(x, y)
    assert np.abs(found - picture)[(away > 8) & (np.maximum(abs(x), abs(y)) < 19)].max() < 0.01


def test_the_center_stays_sharp(run, hdr):
    picture = hdr(15, 15)
    for kind in ("zoom", "spin"):
        found = run(RadialBlur(kind=kind), {"image": picture})
        np.testing.assert_allclose(found[7, 7], picture[7, 7], rtol=1e-5)


def test_nothing_to_do():
    assert RadialBlur(zoom=0.0).identity() == "image"
    assert RadialBlur(kind="spin", angle=0.0).identity() == "image"
    assert RadialBlur(kind="spin", zoom=0.0).identity() is None
