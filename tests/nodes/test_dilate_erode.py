"""Growing and shrinking mattes: against grey morphology of scipy, and against a ramp that moves."""

from __future__ import annotations

import numpy as np
import pytest
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind
from halation.nodes.matte.dilate_erode import DilateErode
from scipy.ndimage import grey_dilation, grey_erosion


def disc(radius: int) -> np.ndarray:
    y, x = np.mgrid[-radius : radius + 1, -radius : radius + 1]
    return x * x + y * y <= radius * radius


def noise(width: int, height: int) -> np.ndarray:
    return np.random.default_rng(4).random((height, width, 4)).astype(np.float32)


@pytest.mark.parametrize("shape", ["circle", "square"])
def test_all_edge_modes_equal_scipy(run, edge, shape):
    compare_with_scipy(run, edge.name, edge.numpy, shape, 5)


@pytest.mark.parametrize("radius", [1, 2, 16, 40])
@pytest.mark.parametrize("shape", ["circle", "square"])
def test_whole_radii_equal_scipy(run, shape, radius):
    compare_with_scipy(run, "clamp", "edge", shape, radius)


def compare_with_scipy(run, edge: str, padding: str, shape: str, radius: int) -> None:
    picture = noise(45, 31)
    footprint = disc(radius) if shape == "circle" else np.ones((2 * radius + 1,) * 2, bool)
    reach = ((radius, radius), (radius, radius), (0, 0))
    padded = np.pad(picture, reach, mode=padding)
    inner = (slice(radius, -radius), slice(radius, -radius))
    for sense, morphology in ((1, grey_dilation), (-1, grey_erosion)):
        expected = np.dstack([morphology(padded[..., channel], footprint=footprint)[inner] for channel in range(4)])
        grown = run(DilateErode(radius=sense * radius, shape=shape, edge=edge), {"image": picture})
        np.testing.assert_array_equal(grown, expected)


@pytest.mark.parametrize("radius", [0.25, 1.5, 6.7])
@pytest.mark.parametrize("shape", ["circle", "square"])
def test_a_soft_edge_moves_by_a_fraction_of_a_pixel(run, shape, radius):
    """A ramp of slope 1/40 that grows by r is the ramp r pixels further on."""
    ramp = np.broadcast_to((np.arange(60) / 40.0 - 0.25)[None, :, None], (9, 60, 4)).astype(np.float32)
    grown = run(DilateErode(radius=radius, shape=shape), {"image": ramp})
    np.testing.assert_allclose(grown[:, :50], ramp[:, :50] + radius / 40.0, atol=2e-6)
    shrunk = run(DilateErode(radius=-radius, shape=shape), {"image": ramp})
    np.testing.assert_allclose(shrunk[:, 10:], ramp[:, 10:] - radius / 40.0, atol=2e-6)


def test_a_fraction_lies_between_the_whole_radii(run):
    picture = noise(30, 20)
    two, three = (run(DilateErode(radius=radius), {"image": picture}) for radius in (2.0, 3.0))
    np.testing.assert_allclose(run(DilateErode(radius=2.25), {"image": picture}), 0.75 * two + 0.25 * three, atol=1e-6)


def test_a_proxy_grows_by_half_as_many_pixels(run):
    picture = noise(40, 30)
    half = run(DilateErode(radius=3.0), {"image": picture})
    np.testing.assert_array_equal(run(DilateErode(radius=6.0), {"image": picture}, scale=0.5, size=(80, 60)), half)


def test_a_matte_stays_a_field(run):
    matte = noise(30, 20)[..., 0]
    graph = Graph().add("grow", DilateErode(radius=4.0)).add_input("matte", Input(Kind.FIELD))
    graph = graph.connect(Port("inputs", "matte"), Port("grow", "image")).add_output("out", Output(Kind.FIELD))
    graph = graph.connect(Port("grow", "out"), Port("outputs", "out"))
    expected = grey_dilation(matte, footprint=disc(4), mode="nearest")
    np.testing.assert_array_equal(run(graph, {"matte": matte})[..., 0], expected)
