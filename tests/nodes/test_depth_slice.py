"""Depth slice against numpy's piecewise linear interpolation."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.geometry.depth_slice import DepthSlice


@pytest.mark.parametrize("invert", [False, True])
@pytest.mark.parametrize("ends", [(2.0, 5.0, 1.0, 3.0), (0.0, 4.0, 0.5, 0.25), (3.0, 3.0, 1.0, 1.0)])
def test_it_is_a_trapezoid_of_the_depth(run, ends, invert):
    near, far, rise, fall = ends
    depth = np.random.default_rng(1).uniform(0.01, 10.0, (17, 23)).astype(np.float32)
    node = DepthSlice(near=near, far=far, near_softness=rise, far_softness=fall, invert=invert)
    expected = np.interp(depth.astype(float), [near - rise, near, far, far + fall], [0.0, 1.0, 1.0, 0.0])
    found = run(node, {"depth": depth})[..., 0]
    np.testing.assert_allclose(found, 1.0 - expected if invert else expected, atol=2e-6)


def test_hard_ends_and_both_ends_belong_to_it(run):
    depth = np.array([[1.999, 2.0, 3.0, 5.0, 5.001]], np.float32)
    node = DepthSlice(near=2.0, far=5.0, near_softness=0.0, far_softness=0.0)
    assert run(node, {"depth": depth})[0, :, 0].tolist() == [0.0, 1.0, 1.0, 1.0, 0.0]


def test_what_has_no_depth_is_farthest(run):
    depth = np.array([[0.0, -3.0, 1e10, np.inf, np.nan]], np.float32)
    assert (run(DepthSlice(near=0.0, far=1e6), {"depth": depth}) == 0.0).all()
    assert (run(DepthSlice(near=0.0, far=1e11), {"depth": depth}) == 1.0).all()
    assert (run(DepthSlice(near=0.0, far=1e6, invert=True), {"depth": depth}) == 1.0).all()
