"""Percentiles and deviations against numpy in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind
from halation.nodes.color.levels import Levels
from halation.nodes.measure.histogram import Histogram

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
CHANNELS = ("red", "green", "blue", "alpha")
PERCENTS = {"low": 2.5, "middle": 50.0, "high": 97.0}


def measured(run, picture: np.ndarray, **values) -> dict[str, float]:
    node = Histogram(**{f"{name}_percentile": percent for name, percent in PERCENTS.items()}, **values)
    return {name: float(run(node, {"image": picture}, output=name).item()) for name in Histogram.outputs}


def expected(light: np.ndarray) -> dict[str, float]:
    light = light.astype(np.float64).ravel()
    levels = np.percentile(light, list(PERCENTS.values()), method="inverted_cdf")
    return dict(zip(PERCENTS, levels, strict=True)) | {"mean": light.mean(), "deviation": light.std()}


@pytest.mark.parametrize("size", [(1, 1), (2, 3), (33, 17), (241, 135)])
def test_luminance_is_that_of_numpy(run, hdr, size):
    picture = hdr(*size, opaque=True)
    truth = expected(picture[..., :3].astype(np.float64) @ WEIGHTS)
    assert measured(run, picture) == pytest.approx(truth, rel=2e-5, abs=1e-7)


@pytest.mark.parametrize("channel", CHANNELS)
def test_each_channel_is_that_of_numpy(run, channel):
    """From values that are negative to such as are a million times as large as others."""
    random = np.random.default_rng(3)
    picture = (random.lognormal(-2.0, 3.0, (61, 83, 4)) - 0.02).astype(np.float32)
    truth = expected(picture[..., CHANNELS.index(channel)])
    assert truth["low"] < 0.0 < truth["middle"] < 1.0 < truth["high"]
    assert measured(run, picture, channel=channel) == pytest.approx(truth, rel=3e-5)


def test_ends_are_minimum_and_maximum(run, hdr):
    picture = hdr(40, 30)
    for percent, end in ((0.0, picture[..., 1].min()), (100.0, picture[..., 1].max())):
        node = Histogram(channel="green", low_percentile=percent)
        assert run(node, {"image": picture}, output="low").item() == pytest.approx(end, rel=1e-5)


def test_few_levels_are_told_apart(run):
    """Three quarters are 0, an eighth each 0.25 and 1: percentiles are levels, not places between them."""
    picture = np.zeros((16, 16, 4), np.float32)
    picture[:2], picture[2:4] = 0.25, 1.0
    node = Histogram(channel="red", low_percentile=75.0, middle_percentile=76.0, high_percentile=87.6)
    found = [run(node, {"image": picture}, output=name).item() for name in ("low", "middle", "high")]
    assert found == pytest.approx([0.0, 0.25, 1.0], abs=1e-6)


def test_holes_are_left_out(run, hdr):
    picture = hdr(71, 53, opaque=True)
    kept = np.ones(picture.shape[:2], bool)
    for place, hole in (((0, 0), np.nan), ((52, 70), np.inf), ((20, 33), -np.inf)):
        picture[place][1], kept[place] = hole, False
    truth = expected(picture[kept][:, 2])
    assert measured(run, picture, channel="blue") == pytest.approx(truth, rel=2e-5)
    nothing = np.full((5, 7, 4), np.nan, np.float32)
    assert measured(run, nothing) == dict.fromkeys(Histogram.outputs, 0.0)


def test_percentiles_stretch_the_contrast(run, hdr):
    """As numbers that other nodes use: the black and white point of levels."""
    picture = hdr(60, 40, opaque=True)
    picture[..., :3] = np.clip(0.2 + 0.1 * picture[..., :3], 0.2, 0.6)
    graph = Graph().add_input("image", Input(Kind.IMAGE)).add_output("out", Output(Kind.IMAGE))
    graph = graph.add("measure", Histogram(channel="red", low_percentile=5.0, high_percentile=90.0))
    graph = graph.add("levels", Levels())
    for source, target in (
        ("inputs.image", "measure.image"),
        ("inputs.image", "levels.image"),
        ("measure.low", "levels.black"),
        ("measure.high", "levels.white"),
        ("levels.out", "outputs.out"),
    ):
        graph = graph.connect(Port.parse(source), Port.parse(target))
    low, high = np.percentile(picture[..., 0], [5.0, 90.0], method="inverted_cdf")
    out = run(graph, {"image": picture})[..., 0]
    inside = (picture[..., 0] > low) & (picture[..., 0] < high)
    np.testing.assert_allclose(out[inside], ((picture[..., 0] - low) / (high - low))[inside], atol=2e-4)
