"""Outline against scipy's exact distance transform."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.edge.outline import Outline
from scipy.ndimage import distance_transform_edt, gaussian_filter

SIDES = {"outside": (0.0, 1.0), "inside": (-1.0, 0.0), "center": (-0.5, 0.5)}


def blobs(width: int = 81, height: int = 53) -> np.ndarray:
    return gaussian_filter(np.random.default_rng(6).random((height, width)), 3.0) > 0.51


def away(mask: np.ndarray) -> np.ndarray:
    return np.where(mask, 0.5 - distance_transform_edt(mask), distance_transform_edt(~mask) - 0.5)


def band(contour: np.ndarray, first: float, last: float, softness: float) -> np.ndarray:
    first, last = (np.clip((contour - end) / (1.0 + softness) + 0.5, 0.0, 1.0) for end in (first, last))
    return first - last


@pytest.mark.parametrize("position", SIDES)
@pytest.mark.parametrize(("width", "softness"), [(1.0, 0.0), (4.0, 0.0), (7.5, 3.0), (40.0, 11.0)])
def test_the_line_equals_scipy(run, hdr, position, width, softness):
    mask, picture, color = blobs(), hdr(81, 53), (2.0, 0.5, 0.1, 0.8)
    node = Outline(position=position, width=width, softness=softness, color=color)
    inputs = {"image": picture, "mask": mask.astype(np.float32)}
    expected = band(away(mask), *(width * side for side in SIDES[position]), softness)
    line = run(node, inputs, output="line")[..., 0]
    np.testing.assert_allclose(line, expected, atol=2e-5)
    ink = np.array([1.6, 0.4, 0.08, 0.8]) * expected[..., None]
    np.testing.assert_allclose(run(node, inputs), ink + picture * (1.0 - ink[..., 3:]), rtol=1e-4, atol=1e-4)


def test_without_a_mask_it_outlines_the_alpha(run, hdr):
    mask, picture = blobs(), hdr(81, 53)
    picture[~mask] = 0.0
    picture[mask, 3] = 1.0
    found = run(Outline(width=5.0, color=(1.0, 1.0, 1.0, 1.0)), {"image": picture})
    np.testing.assert_array_equal(found[mask], picture[mask])
    expected = np.clip(5.5 - away(mask), 0.0, 1.0)
    np.testing.assert_allclose(found[~mask], np.repeat(expected[~mask][:, None], 4, axis=1), atol=2e-5)


def test_nothing_to_outline(run, hdr):
    picture = hdr(20, 15)
    for level in (0.0, 1.0):
        inputs = {"image": picture, "mask": np.full((15, 20), level)}
        np.testing.assert_array_equal(run(Outline(), inputs), picture)
    inputs = {"image": picture, "mask": blobs(20, 15)}
    np.testing.assert_allclose(run(Outline(width=0.0), inputs), picture, atol=1e-6)
