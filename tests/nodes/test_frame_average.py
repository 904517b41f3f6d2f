"""Frame average: weights against scipy's windows and closed forms, pictures against numpy's mean."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.time.frame_average import FrameAverage
from scipy.signal import windows
from sequences import node_at, noise_at, noise_graph


@pytest.mark.parametrize("frames", [1, 2, 3, 8, 9])
@pytest.mark.parametrize(
    ("weights", "window"),
    [
        ("box", lambda n: windows.boxcar(n)),
        ("tent", lambda n: windows.triang(n)),
        ("gaussian", lambda n: windows.gaussian(n, (n + 1) / 6)),
        ("exponential", lambda n: windows.exponential(n, tau=(n + 1) / 6)),
    ],
)
def test_the_windows_are_scipy_s(weights, window, frames):
    share = FrameAverage(frames=frames, weights=weights).share()
    assert abs(sum(share.values()) - 1) < 1e-12 and all(share[at] == share[-at] for at in share)
    if frames % 2:
        expected = window(frames) / window(frames).sum()
        np.testing.assert_allclose([share[at] for at in sorted(share)], expected, atol=1e-12)


def test_an_even_box_is_as_wide_as_it_says():
    assert FrameAverage(frames=4).share() == {-2: 0.125, -1: 0.25, 0: 0.25, 1: 0.25, 2: 0.125}


def test_a_trailing_window_sees_nothing_of_the_future():
    assert FrameAverage(frames=4, window="trailing").share() == dict.fromkeys((0, -1, -2, -3), 0.25)
    share = FrameAverage(frames=4, window="trailing", weights="tent").share()
    np.testing.assert_allclose([share[-back] for back in range(4)], [0.4, 0.3, 0.2, 0.1])
    share = FrameAverage(frames=4, window="trailing", weights="exponential").share()
    ratios = [share[-back - 1] / share[-back] for back in range(3)]
    np.testing.assert_allclose(ratios, np.exp(-3 / 4))


@pytest.mark.parametrize(("frames", "window"), [(5, "centered"), (8, "centered"), (16, "trailing")])
def test_it_is_the_mean_of_the_frames(renderer, frames, window):
    node = FrameAverage(frames=frames, window=window)
    graph = noise_graph(node)
    expected = sum(weight * noise_at(renderer, graph, 4 + at) for at, weight in node.share().items())
    assert np.abs(node_at(renderer, graph, 4) - expected).max() < 1e-6


def test_it_does_not_round_on_the_way(renderer):
    """In half floats 64 sums would be off by percents; here the last rounding is the only one."""
    node = FrameAverage(frames=64)
    graph = noise_graph(node)
    expected = sum(weight * noise_at(renderer, graph, 4 + at) for at, weight in node.share().items())
    assert np.abs(node_at(renderer, graph, 4, precision="half") - expected).max() < 2**-11


def test_one_frame_is_the_picture(renderer):
    graph = noise_graph(FrameAverage(frames=1))
    assert np.array_equal(node_at(renderer, graph, 4), noise_at(renderer, graph, 4))
