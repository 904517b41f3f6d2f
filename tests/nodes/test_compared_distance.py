"""The distance of the pixels that 3x3 operators compare: at n times the size they see what they saw before."""

from __future__ import annotations

import json

import numpy as np
import pytest
from halation import document
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED
from scipy.ndimage import correlate

NODES = catalogue()
PICTURE = np.dstack([np.random.default_rng(8).random((40, 50, 3)), np.ones((40, 50))]).astype(np.float32)
SOBEL = np.array([[-1, 0, 1], [-2, 0, 2], [-1, 0, 1]]) / 4.0


def spread(kernel: np.ndarray, step: int) -> np.ndarray:
    """A kernel whose weights lie `step` pixels apart."""
    wide = np.zeros((2 * step + 1, 2 * step + 1))
    wide[::step, ::step] = kernel
    return wide


@pytest.mark.parametrize("step", [1, 2, 3])
def test_a_kernel_reads_pixels_at_that_distance(run, step: int) -> None:
    node = NODES["convolve3x3"](preset="sobel x", width=float(step))
    expected = correlate(PICTURE[..., 1].astype(np.float64), spread(4.0 * SOBEL, step), mode="nearest")
    np.testing.assert_allclose(run(node, {"image": PICTURE})[..., 1], expected, atol=2e-5)


@pytest.mark.parametrize("step", [1, 2, 4])
def test_edges_are_those_of_the_averaged_picture(run, step: int) -> None:
    """A box of n pixels has the variance n^2 / 12, of which a pixel has 1 / 12 already. The blur is that of the node,
    which has tests of its own; the gradient is that of scipy."""
    picture = PICTURE.copy()
    picture[..., :3] = PICTURE[..., :1]
    blurred = run(NODES["gaussian_blur"](sigma=float(np.sqrt((step**2 - 1) / 12.0))), {"image": picture})[..., 0]
    across, down = (correlate(blurred, spread(kernel, step), mode="nearest") for kernel in (SOBEL, SOBEL.T))
    made = run(NODES["edge_detect"](width=float(step)), {"image": picture}, output="magnitude")[..., 0]
    np.testing.assert_allclose(made, np.hypot(across, down), atol=2e-5)


def test_narrower_than_a_pixel_is_fainter(run) -> None:
    """So a proxy, whose pixels cover more, shows edges as light as the full picture made smaller."""
    whole = run(NODES["edge_detect"](width=1.0), {"image": PICTURE})
    half = run(NODES["edge_detect"](width=0.5), {"image": PICTURE})
    np.testing.assert_allclose(half[..., :3], 0.5 * whole[..., :3], atol=1e-6)


@pytest.mark.parametrize("kind", ["edge_detect", "emboss", "convolve3x3", "canny"])
def test_older_files_compare_neighbors_at_any_size(run, kind: str) -> None:
    text = json.dumps({"halation": document.FORMAT, "nodes": {"a": {"type": kind, "version": 1}}})
    node = document.loads(text, sandbox=UNRESTRICTED).nodes["a"]
    assert node == NODES[kind](width=0.0)
    new = run(NODES[kind](), {"image": PICTURE})
    np.testing.assert_array_equal(run(node, {"image": PICTURE}), new)
