"""Polar against OpenCV, and positions computed in 64 bits."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.distort.polar import Polar
from warps import sample_bilinear, waves


def test_unwrapping_is_opencvs(run):
    """OpenCV counts from pixel corners and lays angles down the height."""
    picture = waves(64, 64)
    node = Polar(direction="unwrap", rotation=0.0, radius=0.45)
    out = run(node, {"image": picture})
    flags = cv2.WARP_POLAR_LINEAR | cv2.INTER_LINEAR
    reference = cv2.warpPolar(picture, (640, 640), (31.5, 31.5), 0.45 * 64, flags).transpose(1, 0, 2)
    assert np.abs(out - reference[5::10, 5::10])[2:].max() < 0.01


def test_unwrapping_looks_around_the_center(run, hdr, edge):
    picture = hdr(30, 22)
    y, x = np.mgrid[:22, :30] + 0.5
    angle, far = 2 * np.pi * x / 30 + np.radians(40), y / 22 * 0.8 * 22
    expected = sample_bilinear(picture, 12 + far * np.cos(angle), 11 + far * np.sin(angle), edge.scipy_map)
    node = Polar(direction="unwrap", rotation=40.0, radius=0.8, center=(0.4, 0.5), edge=edge.name)
    out = run(node, {"image": picture})
    near = 2 * np.pi / 30 * far < 1  # beyond, a pixel averages several
    assert near.sum() > 50 and np.abs(out - expected)[near].max() < 1e-5 * picture.max()


def test_wrapping_looks_up_angle_and_distance(run, hdr):
    picture = hdr(12, 9)
    picture = np.kron(picture, np.ones((6, 6, 1)))  # coarse, so that no pixel spans several
    out = run(Polar(rotation=0.0, radius=1.0, center=(0.2, 0.1)), {"image": picture})
    y, x = np.mgrid[:54, :72] + 0.5
    dx, dy = x - 0.2 * 72, y - 0.1 * 54
    around, outward = np.arctan2(dy, dx) / (2 * np.pi) % 1.0 * 72, np.hypot(dx, dy)
    expected = sample_bilinear(picture, around, outward.clip(0.5, 53.5), "grid-wrap")
    far = np.hypot(dx, dy) > 72 / (2 * np.pi) + 1
    assert far.sum() > 2000 and np.abs(out - expected)[far].max() < 1e-5 * picture.max()


def test_there_and_back(run):
    picture = waves(96, 64)
    picture = (picture + picture[:, ::-1]) / 2  # its sides meet
    disc = run(Polar(), {"image": picture})
    strip = run(Polar(direction="unwrap"), {"image": disc})
    assert np.abs(strip - picture)[16:-2].max() < 0.05


@pytest.mark.parametrize(("edge", "alpha"), [("black", 0.0), ("clamp", 1.0)])
def test_outside_the_disc(run, edge, alpha):
    out = run(Polar(edge=edge, radius=0.3), {"image": np.ones((40, 60, 4))})
    assert np.all(out[0] == alpha) and np.abs(out[20, 30] - 1.0).max() < 1e-6


def test_an_even_picture_stays_even(run):
    for direction in ("wrap", "unwrap"):
        out = run(Polar(direction=direction), {"image": np.full((21, 33, 4), 0.37)})
        assert np.abs(out - 0.37).max() < 1e-6
