"""The tube against its formula in 64 bits and scipy's interpolation."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.distort.crt import Crt
from hashes import hash3
from warps import sample_bilinear

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
FLAT = {"barrel": 0.0, "jitter": 0.0, "chroma_delay": 0.0, "scanlines": 0.0, "mask": "none"}


def averaged_cosine(phase: np.ndarray, width: float) -> np.ndarray:
    """By the integral's ends; from 0.45 to 0.5 turns a pixel it fades out."""
    ends = np.sin(2 * np.pi * (phase + width / 2)) - np.sin(2 * np.pi * (phase - width / 2))
    return np.interp(width, (0.45, 0.5), (1.0, 0.0)) * ends / (2 * np.pi * width)


@pytest.mark.parametrize("size", [(37, 26), (3, 2), (1, 1)])
@pytest.mark.parametrize("mask", Crt.values["mask"].choices)
@pytest.mark.parametrize("lines", [7.0, 12.3, 41.0])
def test_it_is_the_formula(run, hdr, size, mask, lines):
    """On frame 1."""
    picture, (width, height) = hdr(*size), size
    y, x = np.mgrid[:height, :width] + 0.5
    dx, dy = (x - width / 2) / (height / 2), (y - height / 2) / (height / 2)
    bulge = 1 + 0.1 * (dx * dx + dy * dy)
    at_x, at_y = width / 2 + height / 2 * dx * bulge, height / 2 + height / 2 * dy * bulge
    line = at_y / height * lines
    at_x = at_x + 0.02 * height * (2 * hash3((np.floor(line), 1, 0))[0] - 1)
    light, late = (sample_bilinear(picture, at_x - shift, at_y, "grid-constant") for shift in (0.0, 0.03 * height))
    rgb = late[..., :3] + (light[..., :3] @ WEIGHTS - late[..., :3] @ WEIGHTS)[..., None]
    rgb *= ((1 - 0.3 * (1 + averaged_cosine(line, lines / height))) / 0.7)[..., None]
    stripe = x / 4 + (0.5 * (np.floor(y / 4) % 2) if mask == "shadow mask" else 0.0)
    if mask != "none":
        rgb *= 1 + 0.4 * np.stack([averaged_cosine(stripe - (c + 0.5) / 3, 0.25) for c in range(3)], -1)
    node = Crt(
        barrel=0.1, jitter=0.02, chroma_delay=0.03, lines=lines, scanlines=0.6, mask=mask, mask_strength=0.4, triad=4.0
    )
    out = run(node, {"image": picture})
    sure = np.abs(line - np.round(line)) > 1e-4  # at a line's border, the last bit decides which jitter it gets
    assert sure.mean() > 0.8 and np.abs(out[..., :3] - rgb)[sure].max() < 5e-5 * picture.max()
    assert np.abs(out[..., 3] - light[..., 3])[sure].max() < 5e-5


@pytest.mark.parametrize("mask", Crt.values["mask"].choices)
def test_lines_and_stripes_keep_the_light(run, mask):
    even = np.full((48, 60, 4), 0.37)
    node = Crt(**FLAT | {"scanlines": 0.8, "lines": 12.0, "mask": mask, "triad": 6.0, "mask_strength": 1.0})
    out = run(node, {"image": even})
    assert np.ptp(out[..., 0]) > 0.2 and np.abs(out.mean((0, 1)) - 0.37).max() < 1e-5


def test_lines_finer_than_pixels_do_not_beat(run):
    even = np.full((48, 60, 4), 0.37)
    for lines, triad in ((24.0, 2.0), (30.0, 1.5), (47.9, 1.1)):
        node = Crt(**FLAT | {"scanlines": 1.0, "lines": lines, "mask": "aperture grille", "triad": triad})
        assert np.abs(run(node, {"image": even}) - 0.37).max() < 1e-6


def test_a_flat_tube_shows_the_picture(run, hdr):
    picture = hdr(23, 17)
    assert np.abs(run(Crt(**FLAT), {"image": picture}) - picture).max() < 1e-5 * picture.max()
