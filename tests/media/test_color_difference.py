"""Color differences against OpenCV's CIELAB, the pairs of Sharma, Wu and Dalal (2005), and CIE94 by its formula."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.media.comparison.color_difference import delta_e_2000, scale_difference, to_lab

SHARMA = """
50 2.6772 -79.7751 50 0 -82.7485 2.0425
50 3.1571 -77.2803 50 0 -82.7485 2.8615
50 2.8361 -74.02 50 0 -82.7485 3.4412
50 -1.3802 -84.2814 50 0 -82.7485 1
50 -1.1848 -84.8006 50 0 -82.7485 1
50 -0.9009 -85.5211 50 0 -82.7485 1
50 0 0 50 -1 2 2.3669
50 -1 2 50 0 0 2.3669
50 2.49 -0.001 50 -2.49 0.0009 7.1792
50 2.49 -0.001 50 -2.49 0.0010 7.1792
50 2.49 -0.001 50 -2.49 0.0011 7.2195
50 2.49 -0.001 50 -2.49 0.0012 7.2195
50 -0.001 2.49 50 0.0009 -2.49 4.8045
50 -0.001 2.49 50 0.0010 -2.49 4.8045
50 -0.001 2.49 50 0.0011 -2.49 4.7461
50 2.5 0 50 0 -2.5 4.3065
50 2.5 0 73 25 -18 27.1492
50 2.5 0 61 -5 29 22.8977
50 2.5 0 56 -27 -3 31.9030
50 2.5 0 58 24 15 19.4535
50 2.5 0 50 3.1736 0.5854 1
50 2.5 0 50 3.2972 0 1
50 2.5 0 50 1.8634 0.5757 1
50 2.5 0 50 3.2592 0.3350 1
60.2574 -34.0099 36.2677 60.4626 -34.1751 39.4387 1.2644
63.0109 -31.0961 -5.8663 62.8187 -29.7946 -4.0864 1.2630
61.2901 3.7196 -5.3901 61.4292 2.2480 -4.9620 1.8731
35.0831 -44.1164 3.7933 35.0232 -40.0716 1.5901 1.8645
22.7233 20.0904 -46.6940 23.0331 14.9730 -42.5619 2.0373
36.4612 47.8580 18.3852 36.2715 50.5065 21.2231 1.4146
90.8027 -2.0831 1.4410 91.1528 -1.6435 0.0447 1.4441
90.9257 -0.5406 -0.9208 88.6381 -0.8985 -0.7239 1.5381
6.7747 -0.2908 -2.4247 5.8714 -0.0985 -2.2286 0.6377
2.0776 0.0795 -1.1350 0.9033 -0.0636 -0.5514 0.9082
"""
"""L, a, b of two colors, and their CIEDE2000 to four digits."""


def test_ciede2000_is_that_of_the_published_pairs():
    pairs = np.array([line.split() for line in SHARMA.strip().splitlines()], float)
    first, second, expected = pairs[:, :3], pairs[:, 3:6], pairs[:, 6]
    np.testing.assert_allclose(delta_e_2000(first, second), expected, atol=5e-5)
    np.testing.assert_allclose(delta_e_2000(second, first), expected, atol=5e-5)


def test_cielab_is_that_of_opencv():
    light = np.random.default_rng(1).random((16, 16, 3)).astype(np.float32) ** 2
    expected = cv2.cvtColor(light, cv2.COLOR_LRGB2Lab)
    np.testing.assert_allclose(to_lab(light), expected, atol=0.05)  # it keeps a table of cube roots


@pytest.mark.parametrize("level", [0.0, 0.004, 0.18, 1.0])
def test_gray_has_no_color(level):
    lightness = 903.2963 * level if level < 0.008856 else 116.0 * np.cbrt(level) - 16.0
    np.testing.assert_allclose(to_lab(np.full((1, 3), level)), [[lightness, 0.0, 0.0]], atol=1e-4)


@pytest.mark.parametrize("most", [80.0, 0.5], ids=["all colors", "nearly gray"])
def test_scaled_differences_of_close_colors_are_those_of_cie94(most):
    random = np.random.default_rng(2)
    reference = random.uniform((0, -most, -most), (100, most, most), (50, 3))
    color = reference + random.uniform(-most, most, (50, 3)) / 800.0
    chroma = np.hypot(reference[:, 1], reference[:, 2])
    outward = np.hypot(color[:, 1], color[:, 2]) - chroma
    around_squared = ((color - reference)[:, 1:] ** 2).sum(axis=1) - outward**2
    expected = np.sqrt(
        (color - reference)[:, 0] ** 2
        + (outward / (1.0 + 0.045 * chroma)) ** 2
        + around_squared / (1.0 + 0.015 * chroma) ** 2
    )
    np.testing.assert_allclose(np.linalg.norm(scale_difference(color, reference), axis=1), expected, rtol=2e-3)
